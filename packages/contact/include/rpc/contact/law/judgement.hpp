// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/law/foundation.hpp"
#include "rpc/core/math.hpp"

/// What a pair of penetration and pressure means under the law: how far it is off, its state, its energies.
namespace rpc::contact
{

/// How far a pair (v, p) is from the law, p - Psi'(v) with p for the multiplier and rho for r [Pa]: 0 exactly where the law holds. It is
/// -rho w, and w = 0 the constraint of paper (7).                                                                  (5.3)
/// @param scaling  E / diameter [Pa/m]
KOKKOS_INLINE_FUNCTION double law_residual(const double v, const double p, const double scaling, const Foundation &f)
{
  const double rho = scaling + f.hardening; // a softer one would see less of what a stiff foundation misses
  return p - pressure(v, p, rho, f);
}

/// psi(v) + psi*(p) - p v >= 0, 0 exactly where the law holds [J/m^2]. Of the paper's law: what paper (9) has on Gamma_c for w = 0,
/// (xi - p) v where v > 0 and -p v where v < 0.                                                                    (5.5)
/// @param most  takes the place of a yield stress above it: one that is infinite would make an infinite gap of rounding [Pa]
KOKKOS_INLINE_FUNCTION double duality_gap(const double v, const double p, const double most, Foundation f)
{
  if (f.yield > most) f.yield = most;
  const bool in_spring = f.compliance > 0 && v >= 0 && v <= elastic_limit(f) && p >= 0 && p <= f.yield;
  if (in_spring) { // the same: rounding of the spring's energy would be seen beside a body that hardly strains
    const double off = v - f.compliance * p;
    return 0.5 * off * (off / f.compliance);
  }
  return foundation_energy(v, f) + conjugate_energy(p, f) - p * v;
}

/// What the new dent of a pair (v, p) takes up where the law holds, (p - H d/2) d with d = (v - c p)+ [J/m^2].      (3.14)
KOKKOS_INLINE_FUNCTION double taken_up(const double v, const double p, const Foundation &f)
{
  const double dent = v - f.compliance * p;
  if (!(dent > 0)) return 0;
  return math::larger(dissipation(dent, p, f), 0);
}

/// What a pressure stores in the foundation's spring, c p^2/2 [J/m^2].
KOKKOS_INLINE_FUNCTION double stored_energy(const double p, const Foundation &f)
{
  return 0.5 * f.compliance * p * p;
}

/// The state of an admissible pressure: open where 0, yielding at the yield limit and above.
KOKKOS_INLINE_FUNCTION State state_of_pressure(const double p, const Foundation &f)
{
  return p >= f.yield ? State::yielding : (p > 0 ? State::closed : State::open);
}

KOKKOS_INLINE_FUNCTION bool hardens(const Foundation &f)
{
  return f.hardening > 0;
}

/// Whether the law leaves the pressure open where a point just touches, v = 0: a foundation without a spring does. (1.1)
KOKKOS_INLINE_FUNCTION bool leaves_pressure_open(const Foundation &f)
{
  return f.compliance == 0;
}
/// The nearest pressure that a point that just touches may have there.
KOKKOS_INLINE_FUNCTION double admissible_at_touch(const double p, const Foundation &f)
{
  return clamp(p, 0, f.yield);
}

/// The nearest pressure to a mean of others: that of pressures at the yield limit is the limit, but for rounding.
KOKKOS_INLINE_FUNCTION double admissible_mean(const double p, const Foundation &f)
{
  constexpr double rounding = 1e-12;
  return p < f.yield && p >= (1 - rounding) * f.yield ? f.yield : admissible(p, f);
}

/// Whether a point can be pressed in at all.
KOKKOS_INLINE_FUNCTION bool gives_way(const Foundation &f)
{
  return f.yield < math::infinity<double> || f.compliance > 0;
}

/// The largest pressure that the foundation can bear, however deep a point is pressed in [Pa]; inf where it is rigid or hardens. (9.4)
KOKKOS_INLINE_FUNCTION double largest_bearable(const Foundation &f)
{
  return is_rigid(f.yield) || f.hardening > 0 ? math::infinity<double> : f.yield;
}

/// The pressure from which the foundation gives way [Pa]: on a spring 0; inf where it never does.
KOKKOS_INLINE_FUNCTION double gives_way_from(const Foundation &f)
{
  if (f.compliance > 0) return 0;
  return is_rigid(f.yield) ? math::infinity<double> : f.yield;
}

} // namespace rpc::contact
