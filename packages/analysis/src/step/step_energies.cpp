// SPDX-License-Identifier: BSD-3-Clause
#include "step/step_energies.hpp"

#include "rpc/contact/node_columns.hpp"

#include <algorithm>

namespace rpc::analysis
{
namespace
{

/// See other_forces(), of a state that is remembered, on the mesh as it is.
Vector other_forces_before(const Problem &problem, const contact::ContactNodes &points, const Memory &memory)
{
  const fem::Discretization &d = problem.discretization();
  Vector force(*fem::internal_work(d, problem.model().materials, *memory.displacement).forces, Teuchos::Copy);
  contact::ContactResult before;
  before.pressure = contact::at_points(points, *memory.pressure);
  if (!memory.tangential.is_null()) before.traction = contact::vectors_at_points(points, *memory.tangential);
  force.update(-1., contact::contact_forces(d, points, before), 1.);
  return force;
}

/// Work that the foundation's own motion does on body and foundation, -sum of w p dg by the trapezoidal rule [J]; collective.
/// @param gap, before_pressure, before_gap  (points)
double work_of_motion(const Comm &comm, const contact::ContactNodes &contact, const contact::ContactResult &result,
                      const DeviceView<double *> &gap, const DeviceView<double *> &before_pressure,
                      const DeviceView<double *> &before_gap)
{
  const contact::ContactNodes c = contact;
  const auto p = result.pressure;
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::analysis::work_of_motion", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        // (11.3)
        part -= 0.5 * c.weight(i) * (p(i) + before_pressure(i)) * (gap(i) - before_gap(i));
      },
      sum);
  return sum_all(comm, sum);
}

/// Whether an obstacle is elsewhere than before.
bool has_moved(const Model &model, const Memory &before, const double t, const Point &obstacle)
{
  const auto motion = foundations_moved(model, before.time, t, before.obstacle, obstacle);
  return std::any_of(motion.begin(), motion.end(), [](const Point &each) { return each != Point{}; });
}

/// The contact points of a step that is remembered, without dents; collective.
contact::ContactNodes points_of(const Problem &problem, const Memory &before)
{
  const Model model = problem.model().seen_at(before.time, before.obstacle);
  const fem::Discretization &d = problem.discretization();
  return contact::contact_nodes(d, model.contact, fem::dirichlet_dofs(d, model.dirichlet), model.materials);
}

/// (points, dim) The normals that the points had before; their own where they were no points. Collective.
DeviceView<double **> normals_before(const contact::ContactNodes &contact, const contact::ContactNodes &before,
                                     const RCP<const Map> &owned_nodes)
{
  const contact::ContactNodes c = contact, b = before;
  const DeviceView<double **> normal("rpc::analysis::normals_before", c.size(), c.dim);
  Kokkos::deep_copy(normal, c.normal);
  const DeviceView<double *> ones("rpc::analysis::ones", b.size());
  Kokkos::deep_copy(ones, 1.);
  const auto was_point = contact::at_points(c, *contact::node_columns(b, ones, owned_nodes));
  const DeviceView<double *> component("rpc::analysis::normal_component", b.size());
  for (int k = 0; k < c.dim; ++k) {
    Kokkos::parallel_for(
        "rpc::analysis::normal_component", device_range(b.size()),
        KOKKOS_LAMBDA(const LO i) { component(i) = b.normal(i, k); });
    Kokkos::fence();
    const auto at = contact::at_points(c, *contact::node_columns(b, component, owned_nodes));
    Kokkos::parallel_for(
        "rpc::analysis::normals_before", device_range(c.size()), KOKKOS_LAMBDA(const LO i) {
          if (was_point(i) > 0) normal(i, k) = at(i);
        });
    Kokkos::fence();
  }
  return normal;
}

/// Work that the foundation does where its motion turns the normals, sum of w p u . d nu by the trapezoidal rule [J]; collective.
/// @param u, before_u      (owned dofs) [m]
/// @param before_pressure  (points)
/// @param before_normal    (points, dim)
double work_of_turning(const Comm &comm, const contact::ContactNodes &contact, const contact::ContactResult &result,
                       const Vector &u, const Vector &before_u, const DeviceView<double *> &before_pressure,
                       const DeviceView<double **> &before_normal)
{
  const contact::ContactNodes c = contact;
  const auto p = result.pressure;
  const auto x = device_read(u), y = device_read(before_u);
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::analysis::work_of_turning", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i, double &part) {
        double along = 0;
        for (int k = 0; k < c.dim; ++k)
          along += (x(c.dof(i, k)) + y(c.dof(i, k))) * (c.normal(i, k) - before_normal(i, k));
        part += 0.25 * c.weight(i) * (p(i) + before_pressure(i)) * along;
      },
      sum);
  return sum_all(comm, sum);
}

/// What friction dissipates in a step, sum of w (q + q before)/2 . e, and the work of the foundation's motion along itself, sum of
/// -w (q + q before)/2 . motion [J].                                                                             (12.9)
struct FrictionEnergy {
  double dissipated, work_of_motion;
};
FrictionEnergy friction_energy(const Comm &comm, const contact::ContactNodes &contact,
                               const contact::ContactResult &result, const Vector &now, const Memory *const before)
{
  if (!contact.friction.anywhere) return {0, 0};
  const contact::ContactNodes c = contact;
  const auto q = result.traction;
  DeviceView<double **> q_before("rpc::analysis::no_traction", c.size(), c.dim);
  if (before && !before->tangential.is_null()) q_before = contact::vectors_at_points(c, *before->tangential);
  double dissipated = 0, motion = 0;
  if (c.size() > 0) {
    const auto e = result.slip;
    const bool has_before = before != nullptr;
    const auto x = device_read(before ? *before->displacement : now);
    Kokkos::parallel_reduce(
        "rpc::analysis::friction_energy", device_range(c.size()),
        KOKKOS_LAMBDA(const LO i, double &lost, double &done) {
          double normal = 0;
          for (int k = 0; has_before && k < c.dim; ++k) normal += c.normal(i, k) * x(c.dof(i, k));
          for (int k = 0; k < c.dim; ++k) {
            const double mean = 0.5 * c.weight(i) * (q(i, k) + q_before(i, k));
            const double was = has_before ? x(c.dof(i, k)) - normal * c.normal(i, k) : 0;
            lost += mean * e(i, k);
            done -= mean * (c.friction.from(i, k) - was);
          }
        },
        dissipated, motion);
  }
  return {sum_all(comm, dissipated), sum_all(comm, motion)};
}

/// Before the first step the body is at rest, and a foundation that overlaps it has moved in. Larger gaps did no work.
DeviceView<double *> gaps_at_rest(const contact::ContactNodes &contact)
{
  const contact::ContactNodes c = contact;
  const DeviceView<double *> gap("rpc::analysis::gaps_at_rest", c.size());
  Kokkos::parallel_for(
      "rpc::analysis::gaps_at_rest", device_range(c.size()),
      KOKKOS_LAMBDA(const LO i) { gap(i) = c.gap(i) > 0 ? c.gap(i) : 0; });
  Kokkos::fence();
  return gap;
}

} // namespace

Vector other_forces(const Problem &problem, const StepSolution &s)
{
  Vector force(*s.uzawa.residuals.internal.forces, Teuchos::Copy);
  force.update(-1., contact::contact_forces(problem.discretization(), s.step.contact, s.contact), 1.);
  return force;
}

DeviceView<double *> moving_gap(const Problem &problem, const contact::ContactNodes &points,
                                const DeviceView<double *> &dent)
{
  const contact::ContactNodes c = points;
  const DeviceView<double *> gap("rpc::analysis::moving_gap", c.size());
  Kokkos::deep_copy(gap, c.gap);
  for (int side = 0; side < c.num_sides(); ++side)
    if (problem.model().contact[side].dents_move_with == contact::DentsMoveWith::foundation)
      Kokkos::parallel_for(
          "rpc::analysis::moving_gap", Kokkos::RangePolicy<ExecutionSpace, LO>(c.first(side), c.first(side + 1)),
          KOKKOS_LAMBDA(const LO i) { gap(i) += dent(i); });
  Kokkos::fence();
  return gap;
}

Energies energies_after(const Problem &problem, const double t, const StepSolution &s, const Memory *const before,
                        const Vector *const force_before, const Vector &force)
{
  const contact::ContactNodes &points = s.step.contact;
  const Comm &comm = problem.discretization().mesh->comm();
  Energies energies = before ? before->energies : Energies{};
  energies.strain = 0.5 * s.energy_norm_squared;
  energies.foundation = s.contact.total.foundation_energy;
  const auto &sides = problem.model().contact;
  for (std::size_t k = 0; k < sides.size(); ++k) // where dents do not stay, their energy is given back
    (sides[k].remembers ? energies.dissipated : energies.foundation) += s.contact.sides[k].dissipated;
  Vector mean(force, Teuchos::Copy), moved(*s.u, Teuchos::Copy);
  mean.scale(0.5);
  DeviceView<double *> pressure("rpc::analysis::no_pressure", points.size()), before_gap;
  if (before) {
    const bool moves = has_moved(problem.model(), *before, t, s.step.obstacle);
    const contact::ContactNodes points_before = moves ? points_of(problem, *before) : points;
    mean.update(0.5, force_before ? *force_before : other_forces_before(problem, points_before, *before), 1.);
    moved.update(-1., *before->displacement, 1.);
    pressure = contact::at_points(points, *before->pressure);
    before_gap = contact::at_points(points, *before->gap);
    if (moves)
      energies.work +=
          work_of_turning(comm, points, s.contact, *s.u, *before->displacement, pressure,
                          normals_before(points, points_before, problem.discretization().mesh->owned_nodes));
  } else {
    before_gap = gaps_at_rest(points);
  }
  energies.work += mean.dot(moved) + work_of_motion(comm, points, s.contact, moving_gap(problem, points, points.dent),
                                                    pressure, before_gap);
  const FrictionEnergy friction = friction_energy(comm, points, s.contact, *s.u, before);
  energies.friction += friction.dissipated;
  energies.work += friction.work_of_motion;
  energies.imbalance = energies.work - energies.strain - energies.foundation - energies.dissipated - energies.friction;
  return energies;
}

} // namespace rpc::analysis
