#pragma once

#include "rpc/contact/law/foundation.hpp"

/// What a contact point answers to its motion: a force vector, its derivative, a state and an energy. Assembly, line searches and
/// solvers see the law through these alone.                                                        doc/theory.md, section 3
namespace rpc::contact
{

/// Where a point is, relative to its foundation.
struct Motion {
  double penetration; ///< v = u_nu - g [m]
};

/// A point's multipliers.
struct Multiplier {
  double normal; ///< lambda >= 0 [Pa]
};

/// The answer of a point whose weight is w and whose direction is m, in the directions of the mesh.
struct Response {
  double force[3] = {};    ///< w p m, of the body on the foundation: what the point adds to the gradient [N]
  double block[3][3] = {}; ///< d force/du: what it adds to the Hessian [N/m]; symmetric where the law has a potential
  State state = State::open;
  double energy = 0; ///< w Psi [J]
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

} // namespace rpc::contact
