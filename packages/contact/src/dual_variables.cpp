// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/dual_variables.hpp"

#include "rpc/algebra/along_points.hpp"
#include "rpc/contact/law/states.hpp"
#include "rpc/contact/penalties.hpp"
#include "rpc/contact/rules.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rpc::contact
{

// Kernels are free functions: nvcc takes no device lambda in a constructor or a private member.
namespace
{

void start_multipliers(const ContactNodes &c, const double pressure_bound, const DeviceView<double *> &lambda)
{
  Kokkos::parallel_for(
      "rpc::contact::start", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
        lambda(i) = c.fixed(i) ? 0 : first_multiplier(c.free_gap(i), c.scaling(i), pressure_bound, c.law(i));
      });
  Kokkos::fence();
}

/// Of this rank's points that take part in the solution: sum_i w_i value_i; without values that of the weights.
double weighted_sum(const ContactNodes &c, const DeviceView<double *> &value = {})
{
  double sum = 0;
  const bool has_values = value.extent(0) > 0;
  Kokkos::parallel_reduce(
      "rpc::contact::weighted_sum", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        if (!c.fixed(i)) part += c.weight(i) * (has_values ? value(i) : 1);
      },
      sum);
  return sum;
}

/// to <- the nearest multipliers that the law admits.
void take_admissible(const ContactNodes &c, const DeviceView<double *> &from, const DeviceView<double *> &to)
{
  Kokkos::parallel_for(
      "rpc::contact::start_from", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { to(i) = c.fixed(i) ? 0 : admissible(from(i), c.law(i)); });
  Kokkos::fence();
}

/// (points, dim) The parts of vectors along the side. Normals may be others where the vectors come from: on another mesh, of another
/// place of an obstacle.
DeviceView<double **> all_along_side(const ContactNodes &points, const DeviceView<double **> &q)
{
  const ContactNodes c = points;
  const DeviceView<double **> along("rpc::contact::along_side", c.size(), c.dim);
  Kokkos::parallel_for(
      "rpc::contact::along_side", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { set_row(along, i, along_side(c, i, row(q, i))); });
  Kokkos::fence();
  return along;
}

/// Tangential multipliers <- the nearest to q that friction admits at the pressures p; the bounds of the functional's friction follow p.
/// @return this rank's (|change|^2, |multipliers|^2)
std::pair<double, double> replace_tangential(const SmoothedPoints &points, const DeviceView<double *> &p,
                                             const DeviceView<double **> &q)
{
  const SmoothedPoints s = points;
  const auto lambda = s.multiplier.tangential;
  double changed = 0, whole = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::replace_tangential", device_range(s.size()),
      KOKKOS_LAMBDA(const LO i, double &change, double &size) {
        if (s.points.fixed(i)) return;
        const double bound = friction_bound(admissible(p(i), s.points.law(i)), s.points.friction(i));
        const Along next = admissible_friction(row(q, i), bound), difference = next.plus(-1, row(lambda, i));
        change += difference.dot(difference);
        size += next.dot(next);
        set_row(lambda, i, next);
        s.bound(i) = bound;
      },
      changed, whole);
  return {changed, whole};
}

DeviceView<double *> copied(const DeviceView<double *> &values)
{
  const DeviceView<double *> copy("rpc::contact::copy_of_bounds", values.extent(0));
  Kokkos::deep_copy(copy, values);
  return copy;
}

/// This rank's (|change|^2, |lambda|^2) of lambda <- the nearest admissible p.
std::pair<double, double> replace_normal(const ContactNodes &c, const DeviceView<double *> &p,
                                         const DeviceView<double *> &lambda)
{
  double changed = 0, whole = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::replace_multipliers", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &change, double &size) {
        if (c.fixed(i)) return;
        const double next = admissible(p(i), c.law(i));
        change += (next - lambda(i)) * (next - lambda(i));
        size += next * next;
        lambda(i) = next;
      },
      changed, whole);
  return {changed, whole};
}

} // namespace

DualVariables::DualVariables(const SmoothedFunctional &functional, const ContactNodes &points, DeviceView<double *> own,
                             const Vector &load)
    : functional_(functional), points_(points), own_(std::move(own)),
      weight_(sum_all(functional.comm(), weighted_sum(points))),
      pressure_bound_(weight_ > 0 ? start_rules.beyond_reach * load.norm1() / weight_ : 0), is_loaded_(load.norm2() > 0)
{
  reset();
}

double DualVariables::replace(const DeviceView<double *> &p, const DeviceView<double **> &q)
{
  auto [change, size] = replace_normal(points_, p, multipliers().normal);
  if (functional_.points().has_friction()) {
    const auto [tangential_change, tangential_size] = replace_tangential(functional_.points(), p, q);
    change += tangential_change;
    size += tangential_size;
  }
  const double sums[2] = {change, size};
  double all[2];
  Teuchos::reduceAll(functional_.comm(), Teuchos::REDUCE_SUM, 2, sums, all);
  if (all[0] == 0) return 0;
  return std::sqrt(all[0] / std::max(all[1], all[0])); // all multipliers gone to zero is a change of 1, not of infinity
}

/// paper (11); (5.1)
double DualVariables::update(const Vector &u)
{
  const bool friction = functional_.points().has_friction();
  if (friction) bounds_before_ = copied(functional_.points().bound);
  return replace(functional_.pressures(u), friction ? functional_.tractions(u) : DeviceView<double **>());
}

DualVariables::Values DualVariables::values() const
{
  return {multipliers().copy(), copied(functional_.points().bound)};
}

void DualVariables::take(const Values &values)
{
  const SmoothedPoints &s = functional_.points();
  Kokkos::deep_copy(s.multiplier.normal, values.multiplier.normal);
  if (!s.has_friction()) return;
  Kokkos::deep_copy(s.multiplier.tangential, values.multiplier.tangential);
  Kokkos::deep_copy(s.bound, values.bound);
}

void DualVariables::follow_bounds()
{
  const SmoothedPoints s = functional_.points();
  if (!points_.friction.anywhere) return;
  const auto next = lagged_.next(functional_.comm(), bounds_before_, s.bound, points_.weight);
  Kokkos::parallel_for(
      "rpc::contact::follow_bounds", device_range(static_cast<LO>(next.extent(0))), KOKKOS_LAMBDA(const LO i) {
        s.bound(i) = next(i);
        set_row(s.multiplier.tangential, i, admissible_friction(row(s.multiplier.tangential, i), next(i)));
      });
  Kokkos::fence();
}

double DualVariables::take_active_set_pressures(const ActiveSet &active, const Vector &u)
{
  const SmoothedPoints &s = functional_.points();
  if (s.has_friction()) bounds_before_ = copied(s.bound);
  return replace(functional_.active_set_pressures(active, u),
                 s.has_friction() ? active_set_tractions(s, active, u) : DeviceView<double **>());
}

void DualVariables::reset()
{
  if (is_loaded_) start_multipliers(points_, pressure_bound_, multipliers().normal);
  given_ = false;
  start_pressure_ = 0;
  if (!functional_.points().has_friction()) return;
  Kokkos::deep_copy(multipliers().tangential, 0.);
  replace_tangential(functional_.points(), multipliers().normal, multipliers().tangential);
}

void DualVariables::start_from(const ContactState &state)
{
  given_ = true;
  const bool here = state.multiplier.normal.extent(0) > 0; // there are contact nodes on this rank
  if (here) take_admissible(points_, state.multiplier.normal, multipliers().normal);
  const double force = sum_all(functional_.comm(), here ? weighted_sum(points_, multipliers().normal) : 0);
  start_pressure_ = weight_ > 0 ? force / weight_ : 0;
  if (!here) return;
  if (!functional_.points().has_friction()) return;
  const DeviceView<double **> none("rpc::contact::no_traction", points_.size(), points_.dim);
  replace_tangential(functional_.points(), multipliers().normal,
                     state.multiplier.has_tangential() ? all_along_side(points_, state.multiplier.tangential) : none);
}

bool DualVariables::raise_penalties()
{
  return contact::raise_penalties(functional_.comm(), own_, penalty());
}

GO DualVariables::raise_weak_penalties()
{
  return contact::raise_weak_penalties(points_, own_, penalty(), functional_.comm());
}

void DualVariables::lower_penalties()
{
  contact::lower_penalties(points_, penalty());
}

double DualVariables::expected_pressure() const
{
  return std::max(pressure_bound_ / start_rules.beyond_reach, interior_rules.above_start * start_pressure_);
}

} // namespace rpc::contact
