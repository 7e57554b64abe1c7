// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Kokkos_Core.hpp>

#include <cstddef>
#include <vector>

/// The foundation at one contact point, and its smoothing by the modified Lagrangian.      doc/theory.md, section 3
///
/// v = u_nu - g is penetration [m]; p >= 0 is the contact pressure on the body [Pa]. The foundation is a spring of stiffness
/// k <= inf in series with a plastic element, which gives way by the dent w >= 0 once p reaches its yield limit:
///
///     p = clamp(k (v - w), 0, xi + H w),    w > 0 only where p = xi + H w                                     (3.8)
///
/// Three laws are members of this family: perfectly plastic, paper (4), (1.1), with k = inf and H = 0; linear hardening with
/// H > 0; an elastic foundation with k < inf.
///
/// The multiplier is kept as a pressure, lambda = l + xi/2 with l the paper's: that shift alone makes xi = inf a value like any
/// other.
namespace rpc::contact
{

enum class State : int { open = 0, closed = 1, yielding = 2 };

/// The law at one point. With k = inf and H = 0 all functions below are the paper's to the last bit.
struct Foundation {
  double yield;          ///< xi > 0 [Pa], at the dents that are there already; may be inf
  double hardening = 0;  ///< H >= 0 [Pa/m]
  double compliance = 0; ///< c = 1/k >= 0 [m/Pa]
};

/// The law as numbers, one point after the other, for messages between ranks.
constexpr int numbers_of_law = 3;
inline void append(const Foundation &f, std::vector<double> &numbers)
{
  numbers.insert(numbers.end(), {f.yield, f.hardening, f.compliance});
}
inline Foundation foundation_of(const std::vector<double> &numbers, const std::size_t point)
{
  const double *const at = numbers.data() + numbers_of_law * point;
  return {at[0], at[1], at[2]};
}

/// The foundation never gives way. Numbers that would overflow in products count as infinite.
KOKKOS_INLINE_FUNCTION bool is_rigid(const double xi)
{
  return xi > 1e100;
}

KOKKOS_INLINE_FUNCTION double clamp(const double x, const double low, const double high)
{
  return x < low ? low : (x > high ? high : x);
}

/// p, or the nearest pressure that the law admits [Pa]. Perfectly plastic: 0 <= p <= xi.                        paper (4)
KOKKOS_INLINE_FUNCTION double admissible(const double p, const Foundation &f)
{
  return p < 0 ? 0 : (p > f.yield && f.hardening == 0 ? f.yield : p);
}

/// 1 + r c: a closed point has the penalty and the foundation's spring in series.
KOKKOS_INLINE_FUNCTION double softening(const double r, const Foundation &f)
{
  return 1 + r * f.compliance;
}

/// State of lambda + r v. Both kinks count as closed, so that at v = 0, lambda = 0 a point is closed.
KOKKOS_INLINE_FUNCTION State state(const double v, const double lambda, const double r, const Foundation &f)
{
  const double z = lambda + r * v;
  return z < 0 ? State::open : (z > softening(r, f) * f.yield ? State::yielding : State::closed);
}

/// d/dv of the pressure on the branch of a state: 0, r/(1 + r c), r H/((1 + r c) H + r) [Pa/m].             (3.10)
KOKKOS_INLINE_FUNCTION double branch_stiffness(const State s, const double r, const Foundation &f)
{
  if (s == State::open) return 0;
  const double softer = softening(r, f);
  return s == State::closed ? r / softer : r * (f.hardening / (softer * f.hardening + r));
}

/// The pressure on the branch of a state, wherever lambda + r v lies.                                         (3.9)
KOKKOS_INLINE_FUNCTION double branch_pressure(const State s, const double v, const double lambda, const double r,
                                              const Foundation &f)
{
  if (s == State::open) return 0;
  const double z = lambda + r * v, softer = softening(r, f);
  if (s == State::closed) return z / softer;
  return f.hardening == 0 ? f.yield : f.yield + f.hardening * ((z - softer * f.yield) / (softer * f.hardening + r));
}

/// Psi'(v): the smoothed pressure, and after a solve the next multiplier. Perfectly plastic: clamp(lambda + r v, 0, xi).
/// paper, the derivative of Xi after theorem 5, plus xi/2; (3.1), (3.9)
KOKKOS_INLINE_FUNCTION double pressure(const double v, const double lambda, const double r, const Foundation &f)
{
  return branch_pressure(state(v, lambda, r, f), v, lambda, r, f);
}

/// Psi(v) with Psi(0) = 0 for c = 0 [J/m^2]; of the paper's law Xi(v) + xi v / 2.
/// paper, Xi after theorem 5; (3.2), (3.3)
KOKKOS_INLINE_FUNCTION double smoothed_energy(const double v, const double lambda, const double r, const Foundation &f)
{
  const double z = lambda + r * v, softer = softening(r, f), xi = f.yield;
  if (z < 0) return -lambda * lambda / (2 * r);
  if (z <= softer * xi) return v * (lambda + 0.5 * r * v) - 0.5 * f.compliance * z * z / softer;
  const double beyond = z - softer * xi;
  return xi * v - (xi - lambda) * (xi - lambda) / (2 * r) - 0.5 * f.compliance * xi * xi +
         0.5 * beyond * beyond * (f.hardening / (softer * f.hardening + r)) / r;
}

/// The s that minimizes slope s + stiffness s^2/2 + w (Psi(v + s) - Psi(v)): how far one point moves if all others stay where
/// they are. (4.5)
/// @param stiffness  > 0
KOKKOS_INLINE_FUNCTION double best_move(const double slope, const double stiffness, const double w, const double v,
                                        const double lambda, const double r, const Foundation &f)
{
  const double open = -slope / stiffness;
  if (lambda + r * (v + open) < 0) return open;
  const auto on_branch = [&](const State s) {
    return -(slope + w * branch_pressure(s, v, lambda, r, f)) / (stiffness + w * branch_stiffness(s, r, f));
  };
  if (!is_rigid(f.yield)) {
    const double yielding = on_branch(State::yielding);
    if (lambda + r * (v + yielding) > softening(r, f) * f.yield) return yielding;
  }
  return on_branch(State::closed);
}

/// The most that the foundation's spring is compressed, c xi [m].
KOKKOS_INLINE_FUNCTION double elastic_limit(const Foundation &f)
{
  return f.compliance > 0 ? f.compliance * f.yield : 0;
}

/// psi(v): what pressing the point in by v takes [J/m^2]; 0, not NaN, for a rigid one that is not pressed. Perfectly plastic: xi v+.
/// paper, j before (5); (1.3), (3.11)
KOKKOS_INLINE_FUNCTION double foundation_energy(const double v, const Foundation &f)
{
  if (!(v > 0)) return 0;
  const double most = elastic_limit(f);
  if (v <= most) return 0.5 * v * (v / f.compliance);
  const double beyond = v - most;
  return f.yield * (v - 0.5 * most) + 0.5 * beyond * beyond * (f.hardening / (1 + f.compliance * f.hardening));
}

/// psi*(p) = sup over v of p v - psi(v), for an admissible p [J/m^2]. Perfectly plastic: 0.                       (3.12)
KOKKOS_INLINE_FUNCTION double conjugate_energy(const double p, const Foundation &f)
{
  const double beyond = f.hardening > 0 && p > f.yield ? p - f.yield : 0;
  return 0.5 * f.compliance * p * p + (beyond > 0 ? 0.5 * beyond * (beyond / f.hardening) : 0);
}

/// The pressure at a penetration v that is given; at a kink of a rigid foundation, v = 0, it is 0 [Pa].         paper (4)
KOKKOS_INLINE_FUNCTION double pressure_at(const double v, const Foundation &f)
{
  if (!(v > 0)) return 0;
  const double most = elastic_limit(f);
  if (v <= most) return v / f.compliance;
  return f.yield + (v - most) * (f.hardening / (1 + f.compliance * f.hardening));
}

/// What a pair (v, p) that obeys the law adds to the dent: (v - c p)+ where p has reached the yield limit [m].       (3.13)
KOKKOS_INLINE_FUNCTION double new_dent(const double v, const double p, const Foundation &f)
{
  const double dent = v - f.compliance * p;
  return p >= f.yield && dent > 0 ? dent : 0;
}

/// int (xi + H w) dw of a new dent, which ended at the pressure p [J/m^2].                                          (3.14)
KOKKOS_INLINE_FUNCTION double dissipation(const double dent, const double p, const Foundation &f)
{
  return (p - 0.5 * f.hardening * dent) * dent;
}

} // namespace rpc::contact
