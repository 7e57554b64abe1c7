// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/law/foundation.hpp"
#include "rpc/contact/law/friction.hpp"

/// What a contact point answers to its motion: a force vector, its derivative, a state and an energy. Assembly, line searches and
/// solvers see the law through these alone.                                                        doc/theory.md, section 3
namespace rpc::contact
{

/// Where a point is, relative to its foundation.
struct Motion {
  double penetration; ///< v = u_nu - g [m]
  Along slip = {};    ///< e [m]; not looked at where the law has no friction
};

/// A point's multipliers.
struct Multiplier {
  double normal;         ///< lambda >= 0 [Pa]
  Along tangential = {}; ///< lambda_tau, |lambda_tau| <= s [Pa]
};

/// The answer of a point whose weight is w and whose direction is m, in the directions of the mesh.
struct Response {
  double force[3] = {};    ///< w (p m + q), of the body on the foundation: what the point adds to the gradient [N]
  double block[3][3] = {}; ///< d force/du, as far as it is symmetric: what it adds to the Hessian [N/m]
  /// The rest of d force/du: friction's force follows the pressure, and its direction the slip [N/m].      (12.5), (12.13)
  double coupling[3][3] = {};
  State state = State::open;
  double energy = 0; ///< w (Psi + Theta) [J]
};

/// The friction state of a point, and where it slips the direction of its traction: in the plane h, of length 1; in space the direction g
/// that the linear equations gave, |g| <= 1, which lags behind h = a/|a|. (12.13)
struct SlipBranch {
  Slip state = Slip::stick;
  Along direction = {};
  bool cannot_stick = false; ///< it slips, since a part of its slip is prescribed
  Along lever = {};          ///< by which a point sticks one of whose unknowns is prescribed; else 0. (12.8a)
};

/// w a m m^T, the block of a stiffness a along m [Pa/m].
/// @param m  (dim)
template <class Direction>
KOKKOS_INLINE_FUNCTION void add_stiffness(const double w, const double a, const Direction &m, const int dim,
                                          Response &response)
{
  if (a == 0) return;
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < dim; ++l) response.block[k][l] += a * w * m(k) * m(l);
}

/// The response on the branch of a state, whether the law admits its pressure or not: p, p' of (3.9), (3.10).
/// @param at  where the point is   @param multiplier, r  of the modified Lagrangian [Pa], [Pa/m]
/// @param m   (dim) direction      @param w  weight
template <class Direction>
KOKKOS_INLINE_FUNCTION Response respond_on_branch(const State s, const Motion &at, const Multiplier &multiplier,
                                                  const double r, const Foundation &f, const Direction &m,
                                                  const double w, const int dim)
{
  Response response;
  response.state = s;
  const double p = branch_pressure(s, at.penetration, multiplier.normal, r, f);
  for (int k = 0; k < dim; ++k) response.force[k] = w * p * m(k);
  add_stiffness(w, branch_stiffness(s, r, f), m, dim, response);
  return response;
}

/// The response of the smoothed law: force w Psi'(v) m, block w Psi''(v) m m^T, energy w Psi(v).          (3.1), (3.2), (3.9)
template <class Direction>
KOKKOS_INLINE_FUNCTION Response respond(const Motion &at, const Multiplier &multiplier, const double r,
                                        const Foundation &f, const Direction &m, const double w, const int dim)
{
  const State s = state(at.penetration, multiplier.normal, r, f);
  Response response = respond_on_branch(s, at, multiplier, r, f, m, w, dim);
  response.energy = w * smoothed_energy(at.penetration, multiplier.normal, r, f);
  return response;
}

/// Adds the traction q and across (I - nu nu^T) + (along - across) h h^T, as far as the displacement is free.
/// @param normal  (dim) nu   @param free  (dim) 0 where the displacement is prescribed
template <class Normal, class Free>
KOKKOS_INLINE_FUNCTION void add_traction(const double w, const Along &q, const FrictionStiffness &stiffness,
                                         const Along &h, const Normal &normal, const Free &free, const int dim,
                                         Response &response)
{
  for (int k = 0; k < dim; ++k) {
    if (!free(k)) continue;
    response.force[k] += w * q(k);
    for (int l = 0; l < dim; ++l) {
      if (!free(l)) continue;
      const double across = (k == l ? 1 : 0) - normal(k) * normal(l);
      response.block[k][l] += w * (stiffness.across * across + (stiffness.along - stiffness.across) * h(k) * h(l));
    }
  }
}

/// Adds the response of friction with a bound s that is given: w Theta'(e), w Theta''(e), w Theta(e).      (12.3), (12.4)
template <class Normal, class Free>
KOKKOS_INLINE_FUNCTION void add_friction(const Motion &at, const Multiplier &multiplier, const double r, const double s,
                                         const Normal &normal, const Free &free, const double w, const int dim,
                                         Response &response)
{
  const Along a = multiplier.tangential.plus(r, at.slip);
  add_traction(w, admissible_friction(a, s), friction_stiffness(a, s, r), a.unit(), normal, free, dim, response);
  response.energy += w * smoothed_friction_energy(a, multiplier.tangential, s, r);
}

/// The penalty of a branch along its lever l: r/|l|^2, so that what it adds along the free unknowns is r. (12.8a)
KOKKOS_INLINE_FUNCTION double penalty_along_lever(const SlipBranch &branch, const double r)
{
  const double square = branch.lever.dot(branch.lever);
  return square > 0 ? r / square : r;
}

/// lambda_tau + r e, what states and directions in space are chosen by; of a point that cannot stick r e: the multiplier would lag behind a
/// direction that a small prescribed slip holds. (12.13) Of one that sticks by a lever with more than r along it. (12.8a)
KOKKOS_INLINE_FUNCTION Along trial_traction(const SlipBranch &branch, const Along &multiplier, const double r,
                                            const Along &e)
{
  if (branch.cannot_stick) return e.scaled(r);
  const Along d = branch.lever.unit();
  return multiplier.plus(r, e).plus((penalty_along_lever(branch, r) - r) * e.dot(d), d);
}

/// Traction on the branch of a friction state, whether the law admits it or not: lambda_tau + r e, or s h with s at the pressure p. In the
/// plane h is the branch's; in space it follows lambda_tau + r e.                                              (12.5)
KOKKOS_INLINE_FUNCTION Along traction_on_branch(const SlipBranch &branch, const Along &a, const double p,
                                                const Friction &f, const int dim)
{
  if (branch.state == Slip::stick) return a;
  return (dim == 2 ? branch.direction : a.unit()).scaled(friction_bound(p, f));
}

/// Adds across (h - g) h^T, the part of the stiffness of a slipping point that vanishes where g has become h: its symmetric part to the
/// block, the rest to the coupling. (12.13)
template <class Free>
KOKKOS_INLINE_FUNCTION void add_lag(const double w, const double across, const Along &h, const Along &g,
                                    const Free &free, const int dim, Response &response)
{
  const Along lag = h.plus(-1, g);
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < dim && free(k); ++l) {
      if (!free(l)) continue;
      response.block[k][l] += 0.5 * w * across * (lag(k) * h(l) + lag(l) * h(k));
      response.coupling[k][l] += 0.5 * w * across * (lag(k) * h(l) - lag(l) * h(k));
    }
}

/// Adds the response on the branches of contact's state and friction's, coupled: where a point slips, its traction follows the pressure,
/// and in space its direction the slip. (12.5), (12.13)
/// @param m  (dim) direction of contact
template <class Direction, class Normal, class Free>
KOKKOS_INLINE_FUNCTION void
add_friction_on_branch(const State state, const SlipBranch &branch, const Motion &at, const Multiplier &multiplier,
                       const double r, const Foundation &foundation, const Friction &f, const Direction &m,
                       const Normal &normal, const Free &free, const double w, const int dim, Response &response)
{
  const double p = branch_pressure(state, at.penetration, multiplier.normal, r, foundation);
  const Along a = trial_traction(branch, multiplier.tangential, r, at.slip),
              q = traction_on_branch(branch, a, p, f, dim);
  if (branch.state == Slip::stick)
    return add_traction(w, q, {r, penalty_along_lever(branch, r)}, branch.lever.unit(), normal, free, dim, response);
  const Along h = dim == 2 ? branch.direction : a.unit();
  const double size = a.length(), s = friction_bound(p, f);
  const double across = dim == 2 || !(s > 0) ? 0 : (s < size || branch.cannot_stick ? r * s / size : r);
  add_traction(w, q, {across, 0}, h, normal, free, dim, response);
  if (dim == 3) add_lag(w, across, h, branch.direction, free, dim, response);
  const double slope = friction_slope(p, f) * branch_stiffness(state, r, foundation);
  if (slope == 0) return;
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < dim && free(k); ++l) response.coupling[k][l] += w * slope * h(k) * m(l);
}

} // namespace rpc::contact
