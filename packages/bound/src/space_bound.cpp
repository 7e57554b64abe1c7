// SPDX-License-Identifier: BSD-3-Clause
#include "space_bound.hpp"

#include "constant_field.hpp"
#include "descent.hpp"
#include "galerkin.hpp"
#include "local_terms.hpp"
#include "ring_solves.hpp"
#include "space_boundary.hpp"
#include "space_contact_terms.hpp"

#include <Teuchos_Time.hpp>
#include <algorithm>
#include <cmath>

namespace rpc::bound
{
namespace
{

/// What the boundary is judged by: the stresses are not needed.
SpaceInput space_input(const analysis::Problem &problem, const analysis::Model &model)
{
  const fem::Discretization &d = problem.discretization();
  SpaceInput in;
  in.coords = d.mesh->coords;
  in.block = d.mesh->block;
  in.lame = fem::lame_table(d, model.materials);
  for (int i = 0; i < 3; ++i) in.force[i] = value_everywhere(model.body_force[i]).value();
  in.facets = space_facets_of(d);
  in.cells = in.facets.nodes_of_cell;
  in.tables = facet_tables(d.mesh->element.order);
  in.reference.degree = d.mesh->element.order;
  in.stress = d.reference.cell;
  in.load = d.reference.cell_load;
  in.num_owned_cells = d.mesh->num_owned_cells;
  return in;
}

/// Of a solution, on the host.
PointTractions point_tractions(const contact::ContactResult &contact)
{
  const auto along = to_host(contact.traction);
  PointTractions on_host{HostView<double *>("rpc::bound::pressure", contact.pressure.extent(0)),
                         HostView<double **>("rpc::bound::friction", along.extent(0), 3)};
  Kokkos::deep_copy(on_host.pressure, contact.pressure);
  for (std::size_t i = 0; i < along.extent(0); ++i)
    for (int d = 0; d < 3; ++d) on_host.along(i, d) = along(i, d);
  return on_host;
}

/// What contact misses in each owned cell of contact facets.
std::vector<std::pair<LO, double>> gaps_in_space(const SpaceInput &in, const std::vector<SpaceContact> &sides,
                                                 const SpaceContactTerms &contact)
{
  const auto cell = to_host(in.facets.cell);
  std::vector<std::pair<LO, double>> gaps;
  for (std::size_t k = 0; k < sides.size(); ++k)
    for (std::size_t f = 0; f < sides[k].facet.size(); ++f) {
      const LO facet = sides[k].facet[f], at = facet < 0 ? -1 : cell(facet, 0);
      if (at >= 0 && at < in.num_owned_cells) gaps.push_back({at, contact.gap_of[k][f]});
    }
  return gaps;
}

} // namespace

std::string not_covered_in_space(const analysis::Problem &problem, const analysis::Step &step)
{
  const fem::Discretization &d = problem.discretization();
  const analysis::Model model = problem.model().seen_at(step.time);
  if (d.mesh->element.shape != mesh::Shape::simplex || d.mesh->element.order != 1)
    return "in space it covers tetrahedra of order 1, and the cells are " + d.mesh->element.name() +
           "; \"Mesh->Element\" = P1 is covered";
  boundary_of(problem, step, space_input(problem, model),
              {HostView<double *>("rpc::bound::none", step.contact.size()), {}});
  return "";
}

EnergyBound bound_in_space(const analysis::Problem &problem, const analysis::StepSolution &s,
                           const solver::LinearSolverOptions &options, const int steps)
{
  const fem::Discretization &d = problem.discretization();
  const Comm &comm = d.mesh->comm();
  const analysis::Model model = problem.model().seen_at(s.step.time);
  SpaceInput in = space_input(problem, model);
  in.reference = reference_stress(d.mesh->element);
  find_kinds(in, d.mesh->comm());
  const SpaceBoundary boundary = boundary_of(problem, s.step, in, point_tractions(s.contact));

  EnergyBound bound;
  for (std::size_t k = 0; k < boundary.sides.size(); ++k)
    if (boundary.sides[k].friction.acts) bound.of = std::max(bound.of, kind_of_friction(model.contact[k]));
  const HostView<double *> moved = host_copy(*s.u);
  for (const SpaceContact &c : boundary.sides) move_out(c, *d.mesh, moved);
  const RCP<const Vector> u = vector_of(moved, d.owned_dofs);
  Vector way(*u, Teuchos::Copy);
  way.update(-1, *s.u, 1);
  bound.moved = std::sqrt(std::max(0., fem::internal_work(d, model.materials, way).energy_norm_squared));

  const SpaceContactTerms contact = contact_terms(boundary.sides, *d.mesh, moved);
  bound.missing = contact.missing;
  const double strain = fem::internal_work(d, model.materials, *u).energy_norm_squared;
  const double work = work_of(d, known_moments(in, boundary.tractions), in, *u);
  const double lift =
      boundary.beyond ? norm_of_lifted_loads(in, comm, lifted_loads(d.mesh->element), boundary.tractions.load) : 0;
  bound.upper = strain / 2 - work + contact.energy;

  const BoundaryTractions all = with_contact(in, boundary, contact.tractions);
  const double start = Teuchos::Time::wallTime();
  Solved galerkin = galerkin_solution(problem, s, options, in, all);
  bound.solve_seconds = Teuchos::Time::wallTime() - start;
  bound.linear_iterations = galerkin.iterations;
  if (!galerkin.failure.empty()) bound.missing = galerkin.failure;
  if (!bound.missing.empty()) return bound;

  const SpaceExchanges exchanges = space_exchanges(*d.mesh, in.facets);
  const Tractions t =
      equilibrated(in, all, galerkin.Q, mean_moments(in, *fem::on_overlap(d, *galerkin.u)), d.node_to_cells, exchanges);
  galerkin.Q = {}; // memory
  const DeviceView<double *> of_cell("rpc::bound::of_cell", in.num_owned_cells);
  const RCP<const Vector> on_overlap = fem::on_overlap(d, *u);
  const SpaceForms forms = cell_forms(in, *on_overlap);
  const RingSolves rings(in, all, forms, exchanges);
  const DeviceView<float **> scratch("rpc::bound::scratch", in.num_cells(), in.reference.tractions);
  Descent descent(
      [&](const Tractions &x, const bool linear, const Tractions &y) { add_up(in, forms, x, linear, scratch, y); },
      [&](const Tractions &g, const Tractions &z) { rings.apply(g, z); },
      [&](const Tractions &x, const Tractions &y) { return product_over_ranks(in, comm, x, y); }, t);
  std::vector<double> falls;
  for (int step = 0; step < steps; ++step) falls.push_back(descent.step());
  const StressDifference left = stress_difference(in, comm, forms, t, *on_overlap, of_cell);
  bound.imbalance = left.force > 0 ? left.imbalance / left.force : 0;
  double energy = left.energy;
  const double stress_norm = std::sqrt(2 * energy) + lift;
  for (int step = steps; step >= 0; --step) {
    const double norm = std::sqrt(2 * energy) + lift;
    bound.steps.insert(bound.steps.begin(), norm * norm / 2 + contact.gap);
    if (step > 0) energy += falls[step - 1];
  }
  const double best = bound.steps.back();
  bound.lower = bound.upper - best;
  bound.energy_norm = std::sqrt(2 * best) + bound.moved;
  bound.squared = local_terms(comm, of_cell, left.energy > 0 ? stress_norm * stress_norm / (2 * left.energy) : 0,
                              gaps_in_space(in, boundary.sides, contact), bound.energy_norm * bound.energy_norm);
  bound.contact_force.assign(boundary.sides.size(), {0, 0, "forces of bodies in space have no bound"});
  if (!(bound.imbalance <= 1e-8))
    bound.missing = "cells are out of balance by " + shown(bound.imbalance) + " of their forces";
  return bound;
}

} // namespace rpc::bound
