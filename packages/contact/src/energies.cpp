// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/energies.hpp"

#include "rpc/contact/law/judgement.hpp"
#include "rpc/contact/smoothed_functional.hpp"

#include <algorithm>
#include <limits>

namespace rpc::contact
{
namespace
{

const Comm &comm_of(const ContactState &state)
{
  return *state.displacement->getMap()->getComm();
}

/// This rank's sum_i w_i (lambda_i v_i - psi_i*(lambda_i)); a point that takes no part has psi_i(v_i).
double energy_at_points(const ContactNodes &c, const DeviceView<double *> &lambda, const Vector &u)
{
  const auto x = device_read(u);
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::energy", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        const double v = penetration(c, i, x);
        part += c.weight(i) *
                (c.fixed(i) ? foundation_energy(v, c.law(i)) : lambda(i) * v - conjugate_energy(lambda(i), c.law(i)));
      },
      sum);
  return sum;
}

/// By how much v_i may be off by the rounding of its dim products and its difference [m].                          (12.7a)
template <class U>
KOKKOS_INLINE_FUNCTION double penetration_rounding(const ContactNodes &c, const LO i, const U &u)
{
  constexpr double eps = std::numeric_limits<double>::epsilon();
  double size = math::magnitude(c.free_gap(i));
  for (int k = 0; k < c.dim; ++k) size += math::magnitude(c.direction(i, k) * u(c.dof(i, k)));
  return (c.dim + 1) * eps * size;
}

/// By how much e_i may be off by the rounding of its dim products and its difference [m].                          (12.7)
template <class U>
KOKKOS_INLINE_FUNCTION double slip_rounding(const ContactNodes &c, const LO i, const U &u)
{
  constexpr double eps = std::numeric_limits<double>::epsilon();
  double size = 0;
  for (int k = 0; k < c.dim; ++k) size += math::magnitude(u(c.dof(i, k))) + math::magnitude(c.friction.from(i, k));
  return (c.dim + 1) * eps * size;
}

/// e, shorter by what rounding may have made of it.
KOKKOS_INLINE_FUNCTION Along beyond_rounding(const Along &e, const double rounding)
{
  const double length = e.length();
  return length > rounding ? e.scaled(1 - rounding / length) : Along{};
}

/// This rank's largest |q_i| [Pa].
double largest_traction(const ContactNodes &points, const Multipliers &multiplier)
{
  double largest = 0;
  if (!points.friction.exists() || !multiplier.has_tangential()) return largest;
  const auto q = multiplier.tangential;
  Kokkos::parallel_reduce(
      "rpc::contact::largest_traction", device_range(points.size()),
      KOKKOS_LAMBDA(const LO i, double &most) { most = math::larger(most, row(q, i).length()); },
      Kokkos::Max<double>(largest));
  return std::max(0., largest); // a maximum over no nodes is -DBL_MAX
}

/// This rank's largest violation of friction's law [Pa].                                                    (12.6)
/// @param roundings  of e that count as none
double largest_friction_residual(const ContactNodes &points, const ContactState &state, const double roundings)
{
  const ContactNodes c = points;
  const auto lambda = state.multiplier.normal;
  const auto q = state.multiplier.tangential;
  const auto x = device_read(*state.displacement);
  double violation = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::friction_residual", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &worst) {
        if (c.fixed(i)) return;
        const Friction f = c.friction(i);
        const Along e = beyond_rounding(slip(c, i, x), roundings * slip_rounding(c, i, x));
        worst = math::larger(worst, friction_residual(e, row(q, i), friction_bound(lambda(i), f), c.scaling(i)));
      },
      Kokkos::Max<double>(violation));
  return violation;
}

/// This rank's sum_i w_i psi_i(v_i); infinite where a rigid foundation is penetrated.
double energy_of_the_law(const ContactNodes &c, const Vector &u)
{
  const auto x = device_read(u);
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::energy_of_the_law", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        if (c.weight(i) > 0) part += c.weight(i) * foundation_energy(penetration(c, i, x), c.law(i));
      },
      sum);
  return sum;
}

} // namespace

double energy_at(const double elastic, const ContactNodes &points, const Multipliers &multiplier,
                 const RCP<const Vector> &u)
{
  ContactState there;
  there.displacement = u;
  there.multiplier = multiplier;
  return elastic + sum_all(comm_of(there), energy_of_the_law(points, *u)) + friction_work(points, there);
}

/// paper (6); (5.14)
double energy(const double elastic, const ContactNodes &points, const ContactState &state)
{
  return elastic + sum_all(comm_of(state), energy_at_points(points, state.multiplier.normal, *state.displacement));
}

double contact_law_residual(const ContactNodes &points, const ContactState &state, const double roundings)
{
  const ContactNodes c = points;
  const auto lambda = state.multiplier.normal;
  const auto x = device_read(*state.displacement);
  double violation = 0, largest = 0, deepest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::law_residual", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &worst, double &pressure_scale, double &distance_scale) {
        if (c.fixed(i)) return;
        const double v = penetration(c, i, x), p = lambda(i);
        const double off = roundings * penetration_rounding(c, i, x);
        worst = math::larger(worst, law_residual(v + off, p, c.scaling(i), c.law(i)));
        worst = math::larger(worst, -law_residual(v - off, p, c.scaling(i), c.law(i)));
        pressure_scale = math::larger(pressure_scale, p);
        distance_scale = math::larger(distance_scale, math::magnitude(c.scaling(i) * v));
      },
      Kokkos::Max<double>(violation), Kokkos::Max<double>(largest), Kokkos::Max<double>(deepest));
  if (points.friction.exists()) violation = std::max(violation, largest_friction_residual(points, state, roundings));
  const double mine[3] = {violation, largest, deepest};
  double all[3];
  Teuchos::reduceAll(comm_of(state), Teuchos::REDUCE_MAX, 3, mine, all);
  if (all[0] <= 0) return 0; // a maximum over no nodes is -DBL_MAX
  return all[0] / (all[1] > 0 ? all[1] : all[2]);
}

ContactEnergy contact_energy(const ContactNodes &points, const ContactState &state)
{
  const ContactNodes c = points;
  const auto lambda = state.multiplier.normal;
  const auto q = state.multiplier.tangential;
  const auto x = device_read(*state.displacement);
  double largest = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::largest_multiplier", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &most) { most = math::larger(most, lambda(i)); }, Kokkos::Max<double>(largest));
  const double bound = 2 * max_all(comm_of(state), std::max(0., largest));
  const double bound_of_friction = 2 * max_all(comm_of(state), largest_traction(points, state.multiplier));
  double sums[2] = {0, 0};
  Kokkos::parallel_reduce(
      "rpc::contact::contact_energy", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &dissipated, double &gap) {
        if (c.fixed(i)) return;
        const double v = penetration(c, i, x);
        dissipated += c.weight(i) * taken_up(v, lambda(i), c.law(i));
        gap += c.weight(i) * duality_gap(v, lambda(i), bound, c.law(i));
        if (c.friction.exists())
          gap += c.weight(i) * friction_gap(beyond_rounding(slip(c, i, x), slip_rounding(c, i, x)), row(q, i),
                                            math::fmin(friction_bound(lambda(i), c.friction(i)), bound_of_friction));
      },
      sums[0], sums[1]);
  double all[2];
  Teuchos::reduceAll(comm_of(state), Teuchos::REDUCE_SUM, 2, sums, all);
  return {all[0], all[1]};
}

namespace
{

/// F += sum_i w_i q_i, as far as displacements are free.
void add_friction_force(const ContactNodes &points, const DeviceView<double **> &q, Vector &F)
{
  const ContactNodes c = points;
  const auto to = device_write(F);
  for_each_point_by_group(
      "rpc::contact::friction_force", c, KOKKOS_LAMBDA(const LO i) {
        for (int k = 0; k < c.dim; ++k)
          if (c.friction.free(i, k)) to(c.dof(i, k)) += c.weight(i) * q(i, k);
      });
  Kokkos::fence();
}

} // namespace

Vector multiplier_forces(const ContactNodes &points, const Multipliers &multiplier, const RCP<const Map> &dofs)
{
  Vector force(dofs);
  add_contact_force(points, multiplier.normal, force);
  if (points.friction.exists() && multiplier.has_tangential()) add_friction_force(points, multiplier.tangential, force);
  return force;
}

double friction_work(const ContactNodes &points, const ContactState &state)
{
  double sum = 0;
  if (points.friction.exists()) {
    const ContactNodes c = points;
    const auto lambda = state.multiplier.normal;
    const auto x = device_read(*state.displacement);
    Kokkos::parallel_reduce(
        "rpc::contact::friction_work", device_range(c.size()),
        KOKKOS_LAMBDA(const LO i, double &part) {
          part += c.weight(i) * friction_bound(lambda(i), c.friction(i)) * slip(c, i, x).length();
        },
        sum);
  }
  return sum_all(comm_of(state), sum);
}

} // namespace rpc::contact
