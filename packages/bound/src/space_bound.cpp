// SPDX-License-Identifier: BSD-3-Clause
#include "space_bound.hpp"

#include "boundary.hpp"
#include "constant_field.hpp"
#include "descent.hpp"
#include "galerkin.hpp"
#include "local_terms.hpp"
#include "ring_solves.hpp"
#include "space_boundary.hpp"

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
  return in;
}

/// Penetrations of a side at the corners of its facets, out of a rigid foundation: there u is moved.      doc/theory.md (13.3)
std::vector<OfTriangle> depths_in_space(const SpaceContact &c, const int first, const contact::ContactNodes &points,
                                        const HostView<double *> &u)
{
  const auto node = to_host(points.node);
  const auto normal = to_host(points.normal), direction = to_host(points.direction);
  const auto gap = to_host(points.gap), free_gap = to_host(points.free_gap);
  const int count = static_cast<int>(c.place.size());
  std::vector<double> depth(count, 0.);
  for (int k = 0; k < count; ++k) {
    const int i = first + k;
    if (contact::is_rigid(c.limit)) {
      double deep = -free_gap(i), squared = 0;
      for (int d = 0; d < 3; ++d) {
        deep += direction(i, d) * u(dof(3, node(i), d));
        squared += direction(i, d) * direction(i, d);
      }
      for (int d = 0; d < 3 && deep > 0 && squared > 0; ++d) u(dof(3, node(i), d)) -= deep / squared * direction(i, d);
    }
    double size = std::abs(gap(i));
    depth[k] = -gap(i);
    for (int d = 0; d < 3; ++d) {
      const double part = normal(i, d) * u(dof(3, node(i), d));
      depth[k] += part;
      size += std::abs(part);
    }
    if (std::abs(depth[k]) <= 1e-14 * size) depth[k] = 0; // what rounding leaves of a point that is held at the surface
  }
  std::vector<OfTriangle> all;
  for (const auto &of_facet : c.point) all.push_back({depth[of_facet[0]], depth[of_facet[1]], depth[of_facet[2]]});
  return all;
}

HostView<double *> on_host(const DeviceView<double *> &values)
{
  HostView<double *> host("rpc::bound::pressure", values.extent(0));
  Kokkos::deep_copy(host, values);
  return host;
}

} // namespace

std::string not_covered_in_space(const analysis::Problem &problem, const analysis::Step &step)
{
  const fem::Discretization &d = problem.discretization();
  const analysis::Model model = problem.model().seen_at(step.time);
  if (d.mesh->element.shape != mesh::Shape::simplex || d.mesh->element.order != 1)
    return "in space it covers tetrahedra of order 1, and the cells are " + d.mesh->element.name() +
           "; \"Mesh->Element\" = P1 is covered";
  for (const auto &condition : model.dirichlet)
    for (const auto &u : condition.displacement)
      if (u && !value_everywhere(*u))
        return "in space it covers prescribed displacements that are the same everywhere, and \"Dirichlet->" +
               condition.name + "\" depends on the place";
  for (const auto &c : model.contact) {
    std::string other;
    const auto number = [&](const int p) { return value_everywhere(c.*contact::law_parameters[p].field); };
    if (c.has_friction()) other = "\"" + c.path + "\" has friction";
    if (!number(2) || !std::isinf(*number(2))) other = "\"" + c.path + "->Stiffness\" is not inf";
    if (number(1) != 0.) other = "\"" + c.path + "->Hardening\" is not 0";
    if (!other.empty())
      return "in space it covers foundations that are rigid until they yield at one yield stress a side, without "
             "friction, and " +
             other;
  }
  const auto dent = to_host(step.contact.dent);
  for (std::size_t i = 0; i < dent.extent(0); ++i)
    if (dent(i) != 0) return "in space it covers foundations without dents of earlier steps";
  boundary_of(problem, step, space_input(problem, model), HostView<double *>("rpc::bound::none", step.contact.size()));
  return "";
}

EnergyBound bound_in_space(const analysis::Problem &problem, const analysis::StepSolution &s,
                           const solver::LinearSolverOptions &options, const int steps)
{
  const fem::Discretization &d = problem.discretization();
  const analysis::Model model = problem.model().seen_at(s.step.time);
  SpaceInput in = space_input(problem, model);
  in.reference = reference_stress(d.mesh->element);
  find_kinds(in);
  const SpaceBoundary boundary = boundary_of(problem, s.step, in, on_host(s.contact.pressure));

  EnergyBound bound;
  const HostView<double *> moved = host_copy(*s.u);
  std::vector<std::vector<OfTriangle>> depth, pressure;
  for (std::size_t k = 0; k < boundary.sides.size(); ++k)
    depth.push_back(depths_in_space(boundary.sides[k], s.step.contact.first(k), s.step.contact, moved));
  const RCP<const Vector> u = vector_of(moved, d.owned_dofs);
  Vector way(*u, Teuchos::Copy);
  way.update(-1, *s.u, 1);
  bound.moved = std::sqrt(std::max(0., fem::internal_work(d, model.materials, way).energy_norm_squared));

  double yielding = 0, gap = 0;
  std::vector<std::pair<LO, double>> gaps;
  const auto cell = to_host(in.facets.cell);
  for (std::size_t k = 0; k < boundary.sides.size(); ++k) {
    const SpaceContact &c = boundary.sides[k];
    pressure.push_back(fitted_pressure(c, depth[k]));
    for (std::size_t e = 0; e < c.facet.size(); ++e) {
      const OfTriangle &v = depth[k][e];
      if (contact::is_rigid(c.limit) && *std::max_element(v.begin(), v.end()) > 0)
        bound.missing = "the body lies in a rigid foundation";
      const TriangleIntegrals of_facet = contact_integrals(v, pressure[k][e], c.limit);
      yielding += c.area[e] * of_facet.yielding;
      gap += c.area[e] * of_facet.gap;
      gaps.push_back({cell(c.facet[e], 0), c.area[e] * of_facet.gap});
    }
  }
  const double strain = fem::internal_work(d, model.materials, *u).energy_norm_squared;
  const double work = work_of(d, known_moments(in, boundary.tractions), in, *u);
  const double lift =
      boundary.beyond ? norm_of_lifted_loads(in, lifted_loads(d.mesh->element), boundary.tractions.load) : 0;
  bound.upper = strain / 2 - work + yielding;

  const BoundaryTractions all = with_pressure(in, boundary, pressure);
  const double start = Teuchos::Time::wallTime();
  const Solved galerkin = galerkin_solution(problem, s, options, in, all);
  bound.solve_seconds = Teuchos::Time::wallTime() - start;
  bound.linear_iterations = galerkin.iterations;
  if (!galerkin.failure.empty()) bound.missing = galerkin.failure;
  if (!bound.missing.empty()) return bound;

  const Tractions t = equilibrated(in, all, galerkin.Q, mean_moments(in, *galerkin.u), d.node_to_cells);
  const DeviceView<double *> of_cell("rpc::bound::of_cell", in.num_cells());
  const SpaceForms forms = cell_forms(in, *u);
  const RingSolves rings(in, all, forms);
  const DeviceView<double **> scratch("rpc::bound::scratch", in.num_cells(), in.reference.tractions);
  Descent descent(
      [&](const Tractions &x, const bool linear, const Tractions &y) { add_up(in, forms, x, linear, scratch, y); },
      [&](const Tractions &g, const Tractions &z) { rings.apply(g, z); }, inner_product, t);
  std::vector<double> falls;
  for (int step = 0; step < steps; ++step) falls.push_back(descent.step());
  const StressDifference left = stress_difference(in, forms, t, *u, of_cell);
  bound.imbalance = left.force > 0 ? left.imbalance / left.force : 0;
  double energy = left.energy;
  const double stress_norm = std::sqrt(2 * energy) + lift;
  for (int step = steps; step >= 0; --step) {
    const double norm = std::sqrt(2 * energy) + lift;
    bound.steps.insert(bound.steps.begin(), norm * norm / 2 + gap);
    if (step > 0) energy += falls[step - 1];
  }
  const double best = bound.steps.back();
  bound.lower = bound.upper - best;
  bound.energy_norm = std::sqrt(2 * best) + bound.moved;
  bound.squared =
      local_terms(d.mesh->comm(), of_cell, left.energy > 0 ? stress_norm * stress_norm / (2 * left.energy) : 0, gaps,
                  bound.energy_norm * bound.energy_norm);
  bound.contact_force.assign(boundary.sides.size(), {0, 0, "forces of bodies in space have no bound"});
  if (!(bound.imbalance <= 1e-8))
    bound.missing = "cells are out of balance by " + shown(bound.imbalance) + " of their forces";
  return bound;
}

} // namespace rpc::bound
