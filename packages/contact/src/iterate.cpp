// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/iterate.hpp"

#include "rpc/algebra/along_points.hpp"
#include "rpc/contact/energies.hpp"
#include "rpc/contact/law/states.hpp"
#include "rpc/contact/penalties.hpp"
#include "rpc/contact/rules.hpp"
#include "rpc/core/fingerprint.hpp"

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

/// Room for friction's multipliers and bounds; none where there is no friction.
SmoothedPoints smoothed_points(const ContactNodes &points, const DeviceView<double *> &own)
{
  const LO n = points.size();
  SmoothedPoints s{points, chosen_penalties(points, own),
                   Multipliers(DeviceView<double *>("rpc::contact::multiplier", n))};
  if (!points.friction.exists()) return s;
  s.multiplier.tangential = DeviceView<double **>("rpc::contact::tangential_multiplier", n, points.dim);
  s.bound = DeviceView<double *>("rpc::contact::friction_bound", n);
  return s;
}

ActiveSet no_active_set(const ContactNodes &points)
{
  ActiveSet active{DeviceView<State *>("rpc::contact::active_set", points.size())};
  if (!points.friction.exists()) return active;
  active.slip = DeviceView<Slip *>("rpc::contact::active_slip", points.size());
  active.direction = DeviceView<double **>("rpc::contact::active_slip_direction", points.size(), points.dim);
  active.cannot_stick = DeviceView<bool *>("rpc::contact::active_cannot_stick", points.size());
  active.lever = DeviceView<double **>("rpc::contact::active_lever", points.size(), points.dim);
  active.linearized_at = DeviceView<double **>("rpc::contact::linearized_at", points.size(), points.dim);
  return active;
}

/// The stiffness of all unknowns that are not prescribed, the tied ones too.
RCP<const Operator> stiffness_of(const fem::ElasticProblem &elastic, const UpdatedOperator &hessian)
{
  if (elastic.stiffness_of_tied.is_null()) return hessian.shared_base();
  return elastic.stiffness_of_tied;
}

/// u <- from at free unknowns, and what tied ones have of it at their members, beside what is prescribed there.
void take_free(const fem::DirichletDofs &dirichlet, const Vector &from, Vector &u)
{
  const auto fixed = dirichlet.fixed;
  const auto source = device_read(from);
  const auto to = device_write(u);
  Kokkos::parallel_for(
      "rpc::contact::take_free", device_range(static_cast<LO>(u.getLocalLength())), KOKKOS_LAMBDA(const LO dof) {
        if (!fixed(dof)) to(dof) = source(dof);
      });
  Kokkos::fence();
  if (!dirichlet.tied) return;
  Vector moved(u.getMap());
  set_members(*dirichlet.tied, means(*dirichlet.tied, from), moved);
  const auto group = dirichlet.tied->group;
  const auto prescribed = device_read(*dirichlet.value), by_groups = device_read(moved);
  Kokkos::parallel_for(
      "rpc::contact::take_tied", device_range(static_cast<LO>(u.getLocalLength())), KOKKOS_LAMBDA(const LO dof) {
        if (group(dof) >= 0) to(dof) = prescribed(dof) + by_groups(dof);
      });
  Kokkos::fence();
}

/// The rounding error of the sum a + b, exactly: D. Knuth's two-sum.
RCP<const Vector> rest_of_sum(const Vector &a, const Vector &b, const Vector &sum)
{
  const auto rest = rcp(new Vector(sum.getMap()));
  const auto x = device_read(a), y = device_read(b), s = device_read(sum);
  const auto to = device_write(*rest);
  Kokkos::parallel_for(
      "rpc::contact::rest_of_sum", device_range(static_cast<LO>(sum.getLocalLength())), KOKKOS_LAMBDA(const LO dof) {
        const double of_y = s(dof) - x(dof), of_x = s(dof) - of_y;
        to(dof) = (x(dof) - of_x) + (y(dof) - of_y);
      });
  Kokkos::fence();
  return rest;
}

/// This rank's (|change|^2, |lambda|^2) of lambda <- the nearest admissible p.
std::pair<double, double> replace(const ContactNodes &c, const DeviceView<double *> &p,
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

Iterate::Iterate(const fem::ElasticProblem &elastic, ContactNodes points, RCP<UpdatedOperator> hessian)
    : dirichlet_(elastic.dirichlet), points_(std::move(points)), hessian_(std::move(hessian)),
      own_(rpc::own_stiffness(hessian_->base(), points_)), coupled_(coupled_stiffness(hessian_->base(), points_)),
      functional_(stiffness_of(elastic, *hessian_), elastic.load, elastic.energy_offset,
                  smoothed_points(points_, own_)),
      tied_(elastic.stiffness_of_tied), active_(no_active_set(points_))
{
  Vector applied(*elastic.applied_load, Teuchos::Copy), lifted(*elastic.load, Teuchos::Copy);
  fem::clear_prescribed(dirichlet_, applied);
  fem::clear_prescribed(dirichlet_, lifted);
  applied_force_ = applied.norm2();
  prescribed_force_ = lifted.norm2();
  weight_ = sum_all(*lifted.getMap()->getComm(), weighted_sum(points_));
  pressure_bound_ = weight_ > 0 ? start_rules.beyond_reach * lifted.norm1() / weight_ : 0;
  reset_multipliers();
}

std::uint64_t Iterate::piece(const Vector &u) const
{
  const StateCounts counts = count_states(u);
  const std::uint64_t piece =
      scrambled(scrambled(static_cast<std::uint64_t>(counts.open)) + static_cast<std::uint64_t>(counts.closed));
  return points_.friction.anywhere ? scrambled(piece + static_cast<std::uint64_t>(functional_.count_sticking(u)))
                                   : piece;
}

double Iterate::size(const Vector &u) const
{
  if (origin_.is_null()) return u.norm2();
  return from_rest(u)->norm2();
}

GO Iterate::update_hessian(const Vector &u)
{
  functional_.take_states(u, active_);
  active_.chosen = true;
  if (points_.friction.anywhere) // which follows no pressure in the functional
    return hessian_->set(points_, functional_blocks(functional_.points(), u, spring_).block);
  return update_stiffness(u);
}

GO Iterate::update_stiffness(const Vector &u)
{
  const AddedBlocks added = added_blocks(functional_.points(), active_, u, spring_);
  return hessian_->set(points_, added.block, added.coupling);
}

void Iterate::apply_hessian(const Vector &d, Vector &Hd) const
{
  hessian_->apply(d, Hd);
  if (!tied_.is_null())
    tied_->couple(d, Hd); // contact adds nothing at members: prescribed unknowns are no direction to push in
}

void Iterate::hold_by_contact()
{
  spring_ = start_rules.spring;
}

void Iterate::step_taken(const double length)
{
  if (length > start_rules.long_step && spring_ > 0)
    spring_ = std::max<double>(start_rules.weaken * spring_, start_rules.least_spring);
}

ActiveSetChoice Iterate::choose_active_set(const Vector &u, const double negligible) const
{
  if (active_.chosen) return next_choice(functional_, active_, u, own_, negligible);
  return first_choice(functional_, active_, u, spring_ > 0 && !multipliers_given_);
}

void Iterate::take_active_set(const ActiveSetChoice &choice, Vector &u)
{
  take_choice(choice, functional_, active_, u);
  update_stiffness(u);
}

InteriorPath Iterate::interior_path(const Vector &u) const
{
  return {functional_, hessian_, u,
          std::max(pressure_bound_ / start_rules.beyond_reach, interior_rules.above_start * start_pressure_)};
}

double Iterate::replace_multipliers(const DeviceView<double *> &p, const DeviceView<double **> &q)
{
  auto [change, size] = replace(points_, p, multipliers().normal);
  if (functional_.points().has_friction()) {
    const auto [tangential_change, tangential_size] = replace_tangential(functional_.points(), p, q);
    change += tangential_change;
    size += tangential_size;
  }
  const double sums[2] = {change, size};
  double all[2];
  Teuchos::reduceAll(*hessian_->getDomainMap()->getComm(), Teuchos::REDUCE_SUM, 2, sums, all);
  if (all[0] == 0) return 0;
  return std::sqrt(all[0] / std::max(all[1], all[0])); // all multipliers gone to zero is a change of 1, not of infinity
}

/// paper (11); (5.1)
double Iterate::update_multipliers(const Vector &u)
{
  const bool friction = functional_.points().has_friction();
  if (friction) bounds_before_ = copied(functional_.points().bound);
  return replace_multipliers(functional_.pressures(u), friction ? functional_.tractions(u) : DeviceView<double **>());
}

Iterate::Dual Iterate::dual() const
{
  return {multipliers().copy(), copied(functional_.points().bound)};
}

void Iterate::take_dual(const Dual &dual)
{
  const SmoothedPoints &s = functional_.points();
  Kokkos::deep_copy(s.multiplier.normal, dual.multiplier.normal);
  if (!s.has_friction()) return;
  Kokkos::deep_copy(s.multiplier.tangential, dual.multiplier.tangential);
  Kokkos::deep_copy(s.bound, dual.bound);
}

void Iterate::follow_bounds()
{
  const SmoothedPoints s = functional_.points();
  if (!points_.friction.anywhere) return;
  const auto next = lagged_.next(*hessian_->getDomainMap()->getComm(), bounds_before_, s.bound, points_.weight);
  Kokkos::parallel_for(
      "rpc::contact::follow_bounds", device_range(static_cast<LO>(next.extent(0))), KOKKOS_LAMBDA(const LO i) {
        s.bound(i) = next(i);
        set_row(s.multiplier.tangential, i, admissible_friction(row(s.multiplier.tangential, i), next(i)));
      });
  Kokkos::fence();
}

double Iterate::take_active_set_pressures(const Vector &u)
{
  const SmoothedPoints &s = functional_.points();
  if (s.has_friction()) bounds_before_ = copied(s.bound);
  return replace_multipliers(functional_.active_set_pressures(active_, u),
                             s.has_friction() ? active_set_tractions(s, active_, u) : DeviceView<double **>());
}

void Iterate::reset_multipliers()
{
  if (prescribed_force_ > 0) // else nothing acts, and lambda = 0 is the solution
    start_multipliers(points_, pressure_bound_, multipliers().normal);
  multipliers_given_ = false;
  start_pressure_ = 0;
  if (!functional_.points().has_friction()) return;
  Kokkos::deep_copy(multipliers().tangential, 0.);
  replace_tangential(functional_.points(), multipliers().normal, multipliers().tangential);
}

bool Iterate::raise_penalty(const Vector &u)
{
  const bool raised = raise_penalties(*hessian_->getDomainMap()->getComm(), own_, penalty());
  update_stiffness(u);
  return raised;
}

GO Iterate::raise_weak_penalty()
{
  return raise_weak_penalties(points_, own_, penalty(), *hessian_->getDomainMap()->getComm());
}

void Iterate::lower_penalty()
{
  lower_penalties(points_, penalty());
}

void Iterate::start_from(const ContactState &state, Vector &u)
{
  multipliers_given_ = true;
  take_free(dirichlet_, *state.displacement, u);
  const bool here = state.multiplier.normal.extent(0) > 0; // there are contact nodes on this rank
  if (here) take_admissible(points_, state.multiplier.normal, multipliers().normal);
  const double force = sum_all(*u.getMap()->getComm(), here ? weighted_sum(points_, multipliers().normal) : 0);
  start_pressure_ = weight_ > 0 ? force / weight_ : 0;
  if (!here) return;
  if (!functional_.points().has_friction()) return;
  const DeviceView<double **> none("rpc::contact::no_traction", points_.size(), points_.dim);
  replace_tangential(functional_.points(), multipliers().normal,
                     state.multiplier.has_tangential() ? all_along_side(points_, state.multiplier.tangential) : none);
}

void Iterate::move_origin(Vector &u)
{
  Vector G(u.getMap());
  functional_.elastic_gradient(u, G);
  take_origin(u, G);
}

void Iterate::move_origin(Vector &u, const Vector &internal, const Vector &applied)
{
  Vector G(internal, Teuchos::Copy);
  G.update(-1., applied, 1.);
  if (!dirichlet_.rigid.empty()) fem::subtract_spring_forces(dirichlet_.rigid, *from_rest(u), G);
  fem::clear_prescribed(dirichlet_, G);
  take_origin(u, G);
}

void Iterate::take_origin(Vector &u, const Vector &out_of_balance)
{
  functional_ = functional_.from(u, out_of_balance);
  if (origin_.is_null())
    origin_ = rcp(new Vector(u, Teuchos::Copy));
  else
    origin_->update(1., u, 1.);
  u.putScalar(0);
}

RCP<Vector> Iterate::from_rest(const Vector &u) const
{
  const auto from_0 = rcp(new Vector(u, Teuchos::Copy));
  if (!origin_.is_null()) from_0->update(1., *origin_, 1.);
  return from_0;
}

ContactState Iterate::state(const Vector &u) const
{
  const auto from_0 = from_rest(u);
  ContactState state{from_0, multipliers().copy(),
                     DeviceView<State *>("rpc::contact::active_set", active_.state.extent(0))};
  Kokkos::deep_copy(state.active_set, active_.state);
  if (!origin_.is_null()) state.rest = rest_of_sum(*origin_, u, *from_0);
  return state;
}

double Iterate::force_scale() const
{
  if (applied_force_ > 0) return applied_force_;
  const double contact_force = multiplier_forces(points_, multipliers(), hessian_->getDomainMap()).norm2();
  if (contact_force > 0) return contact_force;
  return prescribed_force_ > 0 ? prescribed_force_ : 1;
}

double Iterate::out_of_balance(const Vector &u) const
{
  Vector F(u.getMap());
  functional_.elastic_gradient(u, F);
  F.update(1., multiplier_forces(points_, multipliers(), u.getMap()), 1.);
  fem::clear_prescribed(dirichlet_, F);
  return F.norm2();
}

} // namespace rpc::contact
