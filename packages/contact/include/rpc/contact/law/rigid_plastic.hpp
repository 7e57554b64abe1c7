#pragma once

#include <Kokkos_Core.hpp>

/// The rigid-plastic foundation at one contact node, and its smoothing by the modified Lagrangian.      doc/theory.md
/// section 3
///
/// v = u_nu - g > 0 is penetration [m]; p >= 0 is the contact pressure on the body [Pa]; xi > 0, or inf for a rigid
/// foundation.
///
///     p = 0 if v < 0,   0 <= p <= xi if v = 0,   p = xi if v > 0                                         (1.1)
///
/// The multiplier is kept as a pressure, lambda = l + xi/2 in [0, xi], with l the paper's: that shift alone makes xi =
/// inf a value like any other.
namespace rpc::contact
{

enum class State : int { open = 0, closed = 1, yielding = 2 };

/// The foundation never gives way. Numbers that would overflow in products count as infinite.
KOKKOS_INLINE_FUNCTION bool is_rigid(const double xi)
{
  return xi > 1e100;
}

KOKKOS_INLINE_FUNCTION double clamp(const double x, const double low, const double high)
{
  return x < low ? low : (x > high ? high : x);
}

/// Psi'(v) = clamp(lambda + r v, 0, xi): the smoothed pressure, and after a solve the next multiplier.   (3.1)
KOKKOS_INLINE_FUNCTION double pressure(const double v, const double lambda, const double r, const double xi)
{
  return clamp(lambda + r * v, 0, xi);
}

/// Psi(v) with Psi(0) = 0 [J/m^2]; the paper's Xi(v) + xi v / 2 up to a constant.                        (3.2), (3.3)
KOKKOS_INLINE_FUNCTION double smoothed_energy(const double v, const double lambda, const double r, const double xi)
{
  const double z = lambda + r * v;
  if (z < 0) return -lambda * lambda / (2 * r);
  if (z <= xi) return v * (lambda + 0.5 * r * v);
  return xi * v - (xi - lambda) * (xi - lambda) / (2 * r);
}

/// State of lambda + r v. Both kinks count as closed, so that a start from rest sees a stiff foundation.
KOKKOS_INLINE_FUNCTION State state(const double v, const double lambda, const double r, const double xi)
{
  const double z = lambda + r * v;
  return z < 0 ? State::open : (z > xi ? State::yielding : State::closed);
}

/// The s that minimizes slope s + stiffness s^2/2 + w (Psi(v + s) - Psi(v)): how far one point moves if all others stay where
/// they are. (4.5)
/// @param stiffness  > 0
KOKKOS_INLINE_FUNCTION double best_move(const double slope, const double stiffness, const double w, const double v,
                                        const double lambda, const double r, const double xi)
{
  const double open = -slope / stiffness;
  if (lambda + r * (v + open) < 0) return open;
  if (!is_rigid(xi)) {
    const double yielding = -(slope + w * xi) / stiffness;
    if (lambda + r * (v + yielding) > xi) return yielding;
  }
  return -(slope + w * (lambda + r * v)) / (stiffness + w * r);
}

/// Energy that the foundation has taken up, xi v+ [J/m^2]; 0, not NaN, for a rigid one that is not pressed.   (1.3)
KOKKOS_INLINE_FUNCTION double plastic_energy(const double v, const double xi)
{
  return v > 0 ? xi * v : 0;
}

} // namespace rpc::contact
