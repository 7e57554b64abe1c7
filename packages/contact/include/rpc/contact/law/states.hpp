// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/law/foundation.hpp"
#include "rpc/contact/law/response.hpp"
#include "rpc/core/math.hpp"

/// The states of a contact point: how they are chosen, and what a chosen state says of multiplier and place.  doc/theory.md (5.7),
/// (5.8), (5.10)
namespace rpc::contact
{

/// The multiplier that a step starts with: the paper's l = 0, half the yield limit, where the body touches; 0 where there is a gap, or
/// where the load cannot reach the yield limit.
/// @param free_gap        gap to the foundation [m]   @param scaling  E / diameter [Pa/m]
/// @param pressure_bound  yield limits above it count as infinite [Pa]
KOKKOS_INLINE_FUNCTION double first_multiplier(const double free_gap, const double scaling, const double pressure_bound,
                                               const Foundation &f)
{
  const bool apart = scaling * free_gap > 1e-9 * f.yield; // more than rounding
  return apart || f.yield > pressure_bound || f.compliance > 0 ? 0 : 0.5 * f.yield;
}

/// The next state of a point: one that violates the contact law by more than a pressure goes from closed to open or yielding, else
/// to closed. The penetration of an open point, and the new dent v - c p of a yielding one, count times the point's own stiffness.
/// (5.8)
/// @param p      pressure on the branch of its present state [Pa]   @param own  stiffness of the point alone [Pa/m]
/// @param bound  violations that change no state [Pa]
KOKKOS_INLINE_FUNCTION State next_state(const State now, const double v, const double p, const double own,
                                        const double bound, const Foundation &f)
{
  if (now == State::closed) return p < -bound ? State::open : p > f.yield + bound ? State::yielding : State::closed;
  const double dent = now == State::yielding ? f.compliance * p : 0;
  const double kv = own * (v - dent);
  return (now == State::open ? kv : -kv) > bound ? State::closed : now;
}

/// By how much a point violates the law on the branch of its state, as a pressure: what next_state() compares with its bound [Pa].
KOKKOS_INLINE_FUNCTION double violation(const State now, const double v, const double p, const double own,
                                        const Foundation &f)
{
  if (now == State::closed) return math::larger(-p, p - f.yield);
  return now == State::open ? own * v : own * (f.compliance * p - v);
}

/// The multiplier of a point that takes a state, from the pressure that the state was chosen by: as near as the state allows. (5.7)
KOKKOS_INLINE_FUNCTION double multiplier_of(const State s, const double p, const Foundation &f)
{
  if (s == State::open) return 0;
  if (s == State::closed) return clamp(p, 0, f.yield);
  return math::larger(f.yield, admissible(p, f));
}

/// Where a closed point with a pressure stays: v = c p, the compressed spring [m].
KOKKOS_INLINE_FUNCTION double resting_penetration(const double p, const Foundation &f)
{
  return f.compliance * p;
}

/// Elongation of a point's penalty spring, (p - lambda)/r [m]; of a closed point on a rigid foundation v. 0 where the
/// state's pressure does not depend on v.                                                                         (5.10)
KOKKOS_INLINE_FUNCTION double penalty_stretch(const State s, const double v, const double lambda, const double r,
                                              const Foundation &f)
{
  if (s == State::closed) return (v - f.compliance * lambda) / softening(r, f);
  if (s == State::yielding && f.hardening > 0) return (branch_pressure(s, v, lambda, r, f) - lambda) / r;
  return 0;
}

/// Friction's state and direction for a traction a that is to be admitted: it slips along a where |a| > s.
KOKKOS_INLINE_FUNCTION SlipBranch branch_of(const Along &a, const double s)
{
  return a.length() > s ? SlipBranch{Slip::slip, a.unit()} : SlipBranch{};
}

/// The direction of slip in space after a solve: what |a| g = a says to first order, at most of length 1. (12.13)
/// @param g  the direction before   @param before, now  a where the branch was linearized, and after the solve [Pa]
KOKKOS_INLINE_FUNCTION Along turned_direction(const Along &g, const Along &before, const Along &now)
{
  const double size = before.length();
  if (!(size > 0)) return g;
  const double longer = before.dot(now.plus(-1, before)) / size;
  const Along turned = now.plus(-longer, g).scaled(1 / size);
  return turned.length() > 1 ? turned.unit() : turned;
}

/// The next friction state of a point: it slips from sticking where |q| > s, and sticks from slipping where e points against h. One that
/// comes to touch slips if its slip, times the point's own stiffness, is more than friction bears. (12.8)
/// @param now     branch that q belongs to   @param turned  its direction if it slips on   @param before, next  states of contact
/// @param e, q    slip [m], traction on the branch [Pa]   @param v  penetration [m]   @param p  pressure, admissible [Pa]
/// @param own     stiffness of the point alone [Pa/m]     @param bound  violations that change no state [Pa]
KOKKOS_INLINE_FUNCTION SlipBranch next_slip(const SlipBranch &now, const Along &turned, const State before,
                                            const State next, const Along &e, const Along &q, const double v,
                                            const double p, const double own, const double bound, const Friction &f)
{
  if (!acts(f) || (next == State::open && f.bound == 0)) return {Slip::slip, {}}; // nothing holds it
  if (before == State::open && next != State::open && f.bound == 0)
    return branch_of(e.scaled(own), friction_bound(math::larger(own * v, 0), f));
  if (now.state == Slip::stick) return branch_of(q, friction_bound(p, f) + bound);
  return own * e.dot(now.direction) < -bound ? SlipBranch{} : SlipBranch{Slip::slip, turned};
}

/// The part of a closed point's slip that its free unknowns cannot change, since others are prescribed [m]. Where it is not 0, the point
/// cannot stick.
/// @param normal  (dim) nu   @param free  (dim) 0 where the displacement is prescribed
template <class Normal, class Free>
KOKKOS_INLINE_FUNCTION Along prescribed_slip(const Along &e, const Normal &normal, const Free &free, const int dim)
{
  double across = 0, size = 0; // of the free unknowns, those along the normal are held by contact
  int num_free = 0;
  for (int k = 0; k < dim; ++k) {
    if (!free(k)) continue;
    ++num_free;
    across += normal(k) * e(k);
    size += normal(k) * normal(k);
  }
  Along prescribed;
  if (num_free == dim) return prescribed;
  for (int k = 0; k < dim; ++k) prescribed.x[k] = !free(k) ? e(k) : size > 0 ? across / size * normal(k) : 0;
  return prescribed;
}

/// The lever by which a point sticks one of whose unknowns, k, is prescribed: along (I - nu nu^T) e_k, |nu_k| long. What the free unknowns do
/// to the slip along it is their motion along the normal times nu_k, as far as the foundation gives way. 0 where the point cannot stick so.
/// (12.8a)
/// @param next  state of contact   @param normal  (dim) nu   @param free  (dim) 0 where the displacement is prescribed
template <class Normal, class Free>
KOKKOS_INLINE_FUNCTION Along lever(const State next, const Foundation &f, const Normal &normal, const Free &free,
                                   const int dim)
{
  const bool gives = next == State::yielding || (next == State::closed && f.compliance > 0);
  int prescribed = -1, num_free = 0;
  for (int k = 0; k < dim; ++k) {
    if (free(k))
      ++num_free;
    else
      prescribed = k;
  }
  Along along;
  if (!gives || num_free != dim - 1 || normal(prescribed) == 0) return along;
  for (int k = 0; k < dim; ++k) along.x[k] = (k == prescribed ? 1. : 0.) - normal(prescribed) * normal(k);
  return along.unit().scaled(math::magnitude(normal(prescribed)));
}

/// The same of friction on its branch.
KOKKOS_INLINE_FUNCTION double violation(const SlipBranch &now, const Along &e, const Along &q, const double p,
                                        const double own, const Friction &f)
{
  return now.state == Slip::stick ? q.length() - friction_bound(p, f) : -own * e.dot(now.direction);
}

/// The multiplier of a point that takes a friction state: as near as the state allows to the traction that it was chosen by.   (12.8)
KOKKOS_INLINE_FUNCTION Along multiplier_of(const SlipBranch &branch, const Along &q, const double p, const Friction &f)
{
  const double s = math::larger(friction_bound(p, f), 0);
  return branch.state == Slip::slip ? branch.direction.scaled(s) : admissible_friction(q, s);
}

} // namespace rpc::contact
