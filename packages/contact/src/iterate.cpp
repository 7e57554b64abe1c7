// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/iterate.hpp"

#include "rpc/algebra/along_points.hpp"
#include "rpc/contact/energies.hpp"
#include "rpc/contact/penalties.hpp"
#include "rpc/contact/rounding.hpp"
#include "rpc/contact/rules.hpp"
#include "rpc/core/fingerprint.hpp"

#include <algorithm>
#include <utility>

namespace rpc::contact
{

// Kernels are free functions: nvcc takes no device lambda in a constructor or a private member.
namespace
{

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

/// The forces on the free unknowns.
Vector on_free(const fem::DirichletDofs &dirichlet, const Vector &forces)
{
  Vector free(forces, Teuchos::Copy);
  fem::clear_prescribed(dirichlet, free);
  return free;
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

} // namespace

Iterate::Iterate(const fem::ElasticProblem &elastic, ContactNodes points, RCP<UpdatedOperator> hessian)
    : dirichlet_(elastic.dirichlet), points_(std::move(points)), hessian_(std::move(hessian)),
      own_(rpc::own_stiffness(hessian_->base(), points_)), coupled_(coupled_stiffness(hessian_->base(), points_)),
      functional_(stiffness_of(elastic, *hessian_), elastic.load, elastic.energy_offset,
                  smoothed_points(points_, own_)),
      duals_(functional_, points_, own_, on_free(dirichlet_, *elastic.load)),
      applied_force_(on_free(dirichlet_, *elastic.applied_load).norm2()),
      prescribed_force_(on_free(dirichlet_, *elastic.load).norm2()), tied_(elastic.stiffness_of_tied),
      active_(no_active_set(points_))
{
}

std::uint64_t Iterate::piece(const Vector &u) const
{
  const StateCounts counts = functional_.count_states(u);
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
  if (length > start_rules.long_step && spring_ > 0) spring_ = start_rules.least_spring;
}

ActiveSetChoice Iterate::choose_active_set(const Vector &u, const double negligible) const
{
  if (active_.chosen) return next_choice(functional_, active_, u, own_, negligible);
  return first_choice(functional_, active_, u, spring_ > 0 && !duals_.given());
}

void Iterate::take_active_set(const ActiveSetChoice &choice, Vector &u)
{
  take_choice(choice, functional_, own_, active_, u);
  update_stiffness(u);
}

void Iterate::turn_slip(const Vector &u)
{
  contact::turn_slip(functional_.points(), active_, u);
  update_stiffness(u);
}

InteriorPath Iterate::interior_path(const Vector &u) const
{
  return {functional_, hessian_, u, duals_.expected_pressure()};
}

bool Iterate::raise_penalty(const Vector &u)
{
  const bool raised = duals_.raise_penalties();
  update_stiffness(u);
  return raised;
}

void Iterate::start_from(const ContactState &state, Vector &u)
{
  take_free(dirichlet_, *state.displacement, u);
  duals_.start_from(state);
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
  if (dirichlet_.has_springs()) fem::subtract_spring_forces(dirichlet_, *from_rest(u), G);
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
  ContactState state{from_0, duals_.multipliers().copy(),
                     DeviceView<State *>("rpc::contact::active_set", active_.state.extent(0))};
  Kokkos::deep_copy(state.active_set, active_.state);
  if (!origin_.is_null()) state.rest = rest_of_sum(*origin_, u, *from_0);
  return state;
}

double Iterate::force_scale() const
{
  if (applied_force_ > 0) return applied_force_;
  const double contact_force = multiplier_forces(points_, duals_.multipliers(), hessian_->getDomainMap()).norm2();
  if (contact_force > Rounding::sum * prescribed_force_) return contact_force;
  return prescribed_force_ > 0 ? prescribed_force_ : 1;
}

double Iterate::out_of_balance(const Vector &u) const
{
  Vector F(u.getMap());
  functional_.elastic_gradient(u, F);
  F.update(1., multiplier_forces(points_, duals_.multipliers(), u.getMap()), 1.);
  fem::clear_prescribed(dirichlet_, F);
  return F.norm2();
}

} // namespace rpc::contact
