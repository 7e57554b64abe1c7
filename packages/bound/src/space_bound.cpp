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

SpaceInput space_input(const fem::Discretization &d, const analysis::Model &model, const SpaceFacets &facets)
{
  SpaceInput in;
  in.coords = d.mesh->coords;
  in.block = d.mesh->block;
  in.lame = fem::lame_table(d, model.materials);
  for (int i = 0; i < 3; ++i) in.force[i] = value_everywhere(model.body_force[i]).value();
  in.facets = facets;
  in.cells = in.facets.nodes_of_cell;
  in.tables = facet_tables(d.mesh->element.order);
  in.reference.degree = d.mesh->element.order;
  in.stress = d.reference.cell;
  in.load = d.reference.cell_load;
  in.num_owned_cells = d.mesh->num_owned_cells;
  return in;
}

std::string not_covered_in_space(const analysis::Problem &problem, const analysis::Step &step, FacetsOfMesh &facets)
{
  const fem::Discretization &d = problem.discretization();
  const analysis::Model model = problem.model().seen_at(step.time);
  const mesh::Element &element = d.mesh->element;
  if (element.shape != mesh::Shape::simplex && element.order != 1)
    return "in space it covers tetrahedra and hexahedra of order 1, and the cells are " + element.name() +
           "; \"Mesh->Element\" = P1, P2 or Q1 is covered";
  if (element.shape != mesh::Shape::simplex) return not_covered_of_hexahedra(problem, step, facets);
  facets = std::make_shared<SpaceFacets>(space_facets_of(d));
  return_freed_memory();
  const SpaceInput in = space_input(d, model, *facets);
  const double distortion = max_all(d.mesh->comm(), largest_distortion(in, element));
  if (!(distortion <= 1e-9)) return "cells are curved (by " + shown(distortion) + " of an edge)";
  boundary_of(d, model, step, in, {HostView<double *>("rpc::bound::none", step.contact.size()), {}});
  return "";
}

Bounded<SpaceContact> bounded_in_space(const analysis::Problem &problem, const analysis::StepSolution &s,
                                       const solver::LinearSolverOptions &options, const int steps,
                                       const SpaceFacets &facets, const std::vector<std::string> &flat)
{
  const fem::Discretization &d = problem.discretization();
  if (d.mesh->element.shape != mesh::Shape::simplex)
    return bounded_hexahedra(problem, s, options, 4 * steps, facets, flat);
  const Comm &comm = d.mesh->comm();
  const analysis::Model model = problem.model().seen_at(s.step.time);
  SpaceInput in = space_input(d, model, facets);
  in.reference = reference_stress(d.mesh->element);
  find_kinds(in, d.mesh->comm());
  const SpaceBoundary boundary = boundary_of(d, model, s.step, in, tractions_of(s.contact));

  Bounded<SpaceContact> bounded;
  bounded.sides = boundary.sides;
  EnergyBound &bound = bounded.bound;
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
  bounded.u = u;
  bounded.squared = strain;
  bounded.works = works_of(problem, in, boundary.tractions, all, squared_by_elements(problem));
  Solved galerkin = timed_galerkin_solution(problem, s, options, in, all, bound);
  if (!bound.missing.empty()) return bounded;

  return_freed_memory();
  const RCP<const Vector> on_overlap = fem::on_overlap(d, *u);
  const SpaceForms forms = cell_forms(in, *on_overlap);
  const Descended after = descended(in, *d.mesh, d.node_to_cells, all, forms, galerkin.Q,
                                    mean_moments(in, *fem::on_overlap(d, *galerkin.u)), 2 * steps);
  const DeviceView<double *> of_cell("rpc::bound::of_cell", in.num_owned_cells);
  const StressDifference left = stress_difference(in, comm, forms, after.t, *on_overlap, of_cell);
  bounded.rho = take_descent(comm, in, boundary.sides, contact, left, after.falls, lift, of_cell, bound);
  return bounded;
}

} // namespace rpc::bound
