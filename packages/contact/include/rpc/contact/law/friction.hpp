// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/core/math.hpp"

/// Friction at one contact point, and its smoothing by the modified Lagrangian.                     doc/theory.md, section 12
///
/// q is the traction along the side that the body exerts on the foundation [Pa], e the slip of the step, u_tau less that of the step
/// before and less the foundation's own motion [m]; both are vectors with dim components, normal to nu. With the bound
///
///     s = min(s_0 + mu p, s_max),    p the pressure                                                              (12.1)
///
/// a point sticks, |q| <= s and e = 0, or slips, |q| = s and q along e:    |e| q = s e.                          (12.2)
///
/// mu = 0 is Tresca's law, which has a potential, s |e|; s_0 = 0 and s_max = inf are Coulomb's.
namespace rpc::contact
{

enum class Slip : int { stick = 0, slip = 1 };

/// The law at one point. All numbers are 0 where there is none.
struct Friction {
  double coefficient = 0; ///< mu >= 0
  double bound = 0;       ///< s_0 >= 0 [Pa]
  double limit = 0;       ///< s_max >= 0 [Pa], may be inf
};

/// Whether anything can hold the point.
KOKKOS_INLINE_FUNCTION bool acts(const Friction &f)
{
  return f.coefficient > 0 || f.bound > 0;
}

KOKKOS_INLINE_FUNCTION bool is_limited(const double p, const Friction &f)
{
  return f.bound + f.coefficient * p > f.limit;
}

/// s at a pressure [Pa]. It is linear below the limit: of a pressure that the law of contact does not admit, < 0, it may be < 0.  (12.1)
KOKKOS_INLINE_FUNCTION double friction_bound(const double p, const Friction &f)
{
  return is_limited(p, f) ? f.limit : f.bound + f.coefficient * p;
}
/// ds/dp.
KOKKOS_INLINE_FUNCTION double friction_slope(const double p, const Friction &f)
{
  return is_limited(p, f) ? 0 : f.coefficient;
}

/// A vector along a side, in the mesh's directions; in the plane the third component is 0.
struct Along {
  double x[3] = {0, 0, 0};

  KOKKOS_INLINE_FUNCTION double operator()(const int k) const { return x[k]; }
  KOKKOS_INLINE_FUNCTION Along scaled(const double a) const { return {{a * x[0], a * x[1], a * x[2]}}; }
  /// This + a other.
  KOKKOS_INLINE_FUNCTION Along plus(const double a, const Along &other) const
  {
    return {{x[0] + a * other.x[0], x[1] + a * other.x[1], x[2] + a * other.x[2]}};
  }
  KOKKOS_INLINE_FUNCTION double dot(const Along &other) const
  {
    return x[0] * other.x[0] + x[1] * other.x[1] + x[2] * other.x[2];
  }
  KOKKOS_INLINE_FUNCTION double length() const { return math::sqrt(dot(*this)); }
  /// Of length 1; 0 stays 0.
  KOKKOS_INLINE_FUNCTION Along unit() const
  {
    const double size = length();
    return size > 0 ? scaled(1 / size) : Along{};
  }
};

/// The nearest traction that a bound s admits: a, or s a/|a|. With a = lambda_tau + r e that is Theta'(e), the smoothed traction and
/// after a solve the next multiplier.                                                                              (12.3)
KOKKOS_INLINE_FUNCTION Along admissible_friction(const Along &a, const double s)
{
  const double size = a.length();
  return size <= s ? a : a.scaled(s > 0 ? s / size : 0);
}

KOKKOS_INLINE_FUNCTION Slip slip_state(const Along &a, const double s)
{
  return a.length() <= s ? Slip::stick : Slip::slip;
}

/// Theta(e) with Theta(0) = 0 where |lambda_tau| <= s [J/m^2]: convex, with one continuous derivative.            (12.3)
/// @param a  lambda_tau + r e
KOKKOS_INLINE_FUNCTION double smoothed_friction_energy(const Along &a, const Along &lambda, const double s,
                                                       const double r)
{
  const double size = a.length(), start = lambda.dot(lambda);
  return size <= s ? (size * size - start) / (2 * r) : (2 * s * size - s * s - start) / (2 * r);
}

/// Theta'' = along (I - nu nu^T) + (other - along) h h^T: r I where a point sticks; (r s/|a|) across h = a/|a|, 0 along it, where it
/// slips.                                                                                                           (12.4)
struct FrictionStiffness {
  double across; ///< [Pa/m]
  double along;  ///< [Pa/m]
};
KOKKOS_INLINE_FUNCTION FrictionStiffness friction_stiffness(const Along &a, const double s, const double r)
{
  const double size = a.length();
  return size <= s ? FrictionStiffness{r, r} : FrictionStiffness{s > 0 ? r * s / size : 0, 0};
}

/// How far (e, q) is from the law (12.2), |q - Theta'(e)| with q for the multiplier and rho for r [Pa].          (12.6)
/// @param scaling  E / diameter [Pa/m]
KOKKOS_INLINE_FUNCTION double friction_residual(const Along &e, const Along &q, const double s, const double scaling)
{
  return q.plus(-1, admissible_friction(q.plus(scaling, e), s)).length();
}

/// s |e| - q . e >= 0 for an admissible q, 0 exactly where the law holds [J/m^2].                                  (12.7)
KOKKOS_INLINE_FUNCTION double friction_gap(const Along &e, const Along &q, const double s)
{
  return math::larger(s * e.length() - q.dot(e), 0);
}

} // namespace rpc::contact
