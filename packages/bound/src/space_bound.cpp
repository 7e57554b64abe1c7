// SPDX-License-Identifier: BSD-3-Clause
#include "space_bound.hpp"

#include "bound_parts.hpp"
#include "hexahedra_bound.hpp"
#include "rpc/core/memory.hpp"
#include "space_boundary.hpp"
#include "space_contact_terms.hpp"
#include "space_descent.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rpc::bound
{

SpaceInput space_input(const fem::Discretization &d, const analysis::Model &model)
{
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

std::string not_covered_in_space(const analysis::Problem &problem, const analysis::Step &step)
{
  const fem::Discretization &d = problem.discretization();
  const analysis::Model model = problem.model().seen_at(step.time);
  if (d.mesh->element.order != 1)
    return "in space it covers elements of order 1, and the cells are " + d.mesh->element.name() +
           "; \"Mesh->Element\" = P1 or Q1 is covered";
  if (d.mesh->element.shape != mesh::Shape::simplex) return not_covered_of_hexahedra(problem, step);
  boundary_of(d, model, step, space_input(d, model), {HostView<double *>("rpc::bound::none", step.contact.size()), {}});
  return "";
}

EnergyBound bound_in_space(const analysis::Problem &problem, const analysis::StepSolution &s,
                           const solver::LinearSolverOptions &options, const int steps)
{
  const fem::Discretization &d = problem.discretization();
  if (d.mesh->element.shape != mesh::Shape::simplex) return bound_of_hexahedra(problem, s, options, 2 * steps);
  const Comm &comm = d.mesh->comm();
  const analysis::Model model = problem.model().seen_at(s.step.time);
  return_freed_memory();
  SpaceInput in = space_input(d, model);
  return_freed_memory();
  in.reference = reference_stress(d.mesh->element);
  find_kinds(in, d.mesh->comm());
  const SpaceBoundary boundary = boundary_of(d, model, s.step, in, tractions_of(s.contact));

  EnergyBound bound;
  const HostView<double *> moved = moved_out(problem, model, s, boundary.sides, bound);
  const RCP<const Vector> u = vector_of(moved, d.owned_dofs);
  const SpaceContactTerms contact = contact_terms(boundary.sides, *d.mesh, moved);
  bound.missing = contact.missing;
  const double strain = fem::internal_work(d, model.materials, *u).energy_norm_squared;
  const double work = work_of(d, known_moments(in, boundary.tractions), in, *u);
  const double lift =
      boundary.beyond ? norm_of_lifted_loads(in, comm, lifted_loads(d.mesh->element), boundary.tractions.load) : 0;
  bound.upper = strain / 2 - work + contact.energy;

  const BoundaryTractions all = with_contact(in, boundary, contact.tractions);
  Solved galerkin = timed_galerkin_solution(problem, s, options, in, all, bound);
  if (!bound.missing.empty()) return bound;

  const SpaceExchanges exchanges = space_exchanges(*d.mesh, in.facets);
  const Tractions t =
      equilibrated(in, all, galerkin.Q, mean_moments(in, *fem::on_overlap(d, *galerkin.u)), d.node_to_cells, exchanges);
  galerkin = {}; // memory
  return_freed_memory();
  const DeviceView<double *> of_cell("rpc::bound::of_cell", in.num_owned_cells);
  const RCP<const Vector> on_overlap = fem::on_overlap(d, *u);
  const SpaceForms forms = cell_forms(in, *on_overlap);
  std::optional<RingSolves> rings(std::in_place, in, all, forms, exchanges);
  std::optional<SpaceDescent> descent(std::in_place, in, forms, *rings, comm, t);
  std::vector<double> falls;
  for (int step = 0; step < steps; ++step) falls.push_back(descent->step());
  descent.reset(); // memory
  rings.reset();
  const StressDifference left = stress_difference(in, comm, forms, t, *on_overlap, of_cell);
  const double stress_norm = take_descent(comm, in, boundary.sides, contact, left, falls, lift, of_cell, bound);
  if (!bound.missing.empty()) return bound;
  const double rho = std::sqrt(stress_norm * stress_norm / 4 + contact.gap); // (13.13)
  const auto work_with = [&](const BoundaryTractions &tractions, const Vector &w) {
    return work_of(d, known_moments(in, tractions), in, w);
  };
  add_forces(
      problem, s, options, boundary.sides, rho, *u, [&](const Vector &w) { return work_with(boundary.tractions, w); },
      [&](const Vector &w) { return work_with(all, w); },
      [&](const Vector &x) { return fem::internal_work(d, model.materials, x).energy_norm_squared; }, bound);
  return bound;
}

} // namespace rpc::bound
