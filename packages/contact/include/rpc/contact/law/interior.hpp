// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/law/foundation.hpp"
#include "rpc/contact/rules.hpp"
#include "rpc/core/math.hpp"

/// The law of a contact point with its corners rounded off: the central path of an interior-point method.
///
///     v = c p + d - s,    p s = mu,    q d = mu,    q = xi + H d - p,    p, s, d, q > 0                doc/theory.md (5.15)
///
/// s is how far the point is open, d its dent and q what it can bear beyond p. For mu -> 0 it is the law (3.8): s = 0 or p = 0, d = 0
/// or q = 0. A foundation that does not yield has no d and q.
namespace rpc::contact
{

struct InteriorPoint {
  double pressure; ///< p [Pa]
  double opening;  ///< s [m]
  double dent;     ///< d [m]
};

/// Target values of the complementarity products in a step [J/m^2].
struct InteriorTarget {
  double opening; ///< p s
  double dent;    ///< q d
};

KOKKOS_INLINE_FUNCTION bool can_yield(const Foundation &f)
{
  return !is_rigid(f.yield);
}

/// q [Pa]; of no meaning where the foundation does not yield.
KOKKOS_INLINE_FUNCTION double spare_strength(const InteriorPoint &x, const Foundation &f)
{
  return f.yield + f.hardening * x.dent - x.pressure;
}

/// p s + q d [J/m^2]: 0 where the law holds.
KOKKOS_INLINE_FUNCTION double complementarity(const InteriorPoint &x, const Foundation &f)
{
  return x.pressure * x.opening + (can_yield(f) ? spare_strength(x, f) * x.dent : 0);
}

/// d for p on the path.
KOKKOS_INLINE_FUNCTION double path_dent(const double p, const double mu, const Foundation &f)
{
  if (!can_yield(f)) return 0;
  const double left = f.yield - p;
  const double root = math::sqrt(left * left + 4 * f.hardening * mu);
  return left > 0 ? 2 * mu / (left + root) : (root - left) / (2 * f.hardening);
}

/// The point of the path with p + kappa v = z.                                                                     (5.16)
/// @param mu     > 0 [J/m^2]   @param kappa  > 0 [Pa/m]
KOKKOS_INLINE_FUNCTION InteriorPoint on_path(const double z, const double mu, const double kappa, const Foundation &f)
{
  const auto excess = [&](const double p) { return p + kappa * (f.compliance * p + path_dent(p, mu, f) - mu / p) - z; };
  const double root = math::sqrt(z * z + 4 * kappa * mu);
  const double most = z > 0 ? (z + root) / 2 : 2 * kappa * mu / (root - z); // as if c = d = 0
  double low = 0, high = can_yield(f) && f.hardening == 0 ? math::fmin(most, f.yield) : most;
  for (int halving = 0; halving < 60; ++halving) {
    const double p = (low + high) / 2;
    (excess(p) < 0 ? low : high) = p;
  }
  const double p = (low + high) / 2;
  return {p, mu / p, path_dent(p, mu, f)};
}

/// The point of the path on the line through v and a pressure, at most half of the yield stress.                     (5.16)
KOKKOS_INLINE_FUNCTION InteriorPoint join_path(const double pressure, const double v, const double mu,
                                               const double kappa, const Foundation &f)
{
  return on_path(math::fmin(pressure, 0.5 * f.yield) + kappa * v, mu, kappa, f);
}

/// dv/dp of the linearized equations [m/Pa].                                                                       (5.17)
KOKKOS_INLINE_FUNCTION double linear_compliance(const InteriorPoint &x, const Foundation &f)
{
  double compliance = f.compliance + x.opening / x.pressure;
  if (can_yield(f)) compliance += x.dent / (spare_strength(x, f) + f.hardening * x.dent);
  return compliance;
}

/// What a target adds to e of the linearized equations [m].                                                        (5.17)
KOKKOS_INLINE_FUNCTION double excess_of(const InteriorTarget &target, const InteriorPoint &x, const Foundation &f)
{
  double excess = target.opening / x.pressure;
  if (can_yield(f)) excess -= target.dent / (spare_strength(x, f) + f.hardening * x.dent);
  return excess;
}

/// By how much v is larger than what the linearized equations for the target have at the present p [m].            (5.17)
KOKKOS_INLINE_FUNCTION double linear_excess(const InteriorPoint &x, const double v, const InteriorTarget &target,
                                            const Foundation &f)
{
  double excess = v - f.compliance * x.pressure - x.dent + excess_of(target, x, f);
  if (can_yield(f)) {
    const double q = spare_strength(x, f);
    excess += q * x.dent / (q + f.hardening * x.dent);
  }
  return excess;
}

/// The changes of s and d that go with one of p.                                                                   (5.17)
KOKKOS_INLINE_FUNCTION InteriorPoint linear_change(const InteriorPoint &x, const double dp,
                                                   const InteriorTarget &target, const Foundation &f)
{
  InteriorPoint change{dp, (target.opening - x.opening * dp) / x.pressure - x.opening, 0};
  if (can_yield(f)) {
    const double q = spare_strength(x, f);
    change.dent = (target.dent - q * x.dent + x.dent * dp) / (q + f.hardening * x.dent);
  }
  return change;
}

/// The target that makes the products mu, of the linearized equations, after a change whose products they leave out. (5.19)
/// @param part  of these products that is taken off
KOKKOS_INLINE_FUNCTION InteriorTarget corrected_target(const InteriorPoint &change, const double mu, const double part,
                                                       const Foundation &f)
{
  return {mu - part * change.pressure * change.opening,
          mu - part * (f.hardening * change.dent - change.pressure) * change.dent};
}

/// The mu to aim at after a step that mu = 0 would allow a part t of.                                               (5.19)
inline double aimed_mu(const double mu, const double t)
{
  const double left = 1 - interior_rules.to_boundary * t;
  return left * left * mu;
}

/// The point after a part of a change.
KOKKOS_INLINE_FUNCTION InteriorPoint moved(const InteriorPoint &x, const double part, const InteriorPoint &change)
{
  return {x.pressure + part * change.pressure, x.opening + part * change.opening, x.dent + part * change.dent};
}

/// The largest step along a change that keeps p, s, d and q >= 0; infinite if every step does.
KOKKOS_INLINE_FUNCTION double longest_step(const InteriorPoint &x, const InteriorPoint &change, const Foundation &f)
{
  constexpr double inf = 1e300;
  const auto until_0 = [&](const double value, const double slope) { return slope < 0 ? -value / slope : inf; };
  double t = math::fmin(until_0(x.pressure, change.pressure), until_0(x.opening, change.opening));
  if (!can_yield(f)) return t;
  t = math::fmin(t, until_0(x.dent, change.dent));
  return math::fmin(t, until_0(spare_strength(x, f), f.hardening * change.dent - change.pressure));
}

/// The state that a point tends to, by which factor of a pair the last step has made smaller.                        (5.20)
KOKKOS_INLINE_FUNCTION State tends_to(const InteriorPoint &before, const InteriorPoint &now, const Foundation &f)
{
  if (now.pressure * before.opening < now.opening * before.pressure) return State::open;
  if (!can_yield(f)) return State::closed;
  const bool gives_way = spare_strength(now, f) * before.dent < now.dent * spare_strength(before, f);
  return gives_way ? State::yielding : State::closed;
}

} // namespace rpc::contact
