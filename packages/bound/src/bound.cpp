// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/bound/bound.hpp"

#include "boundary.hpp"
#include "descent.hpp"
#include "galerkin.hpp"
#include "rpc/core/timed.hpp"
#include "space_bound.hpp"
#include "star_solves.hpp"

#include <Teuchos_Time.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

namespace rpc::bound
{
namespace
{

constexpr const char *covered =
    "\"Adapt->Error Bound\" = guaranteed covers plane strain and plane stress of straight triangles or parallelograms, "
    "and tetrahedra of order 1, on one rank, in one "
    "step, on foundations that are rigid until they yield at one yield stress a side, without friction";

void require_of_deck(const bool condition, const std::string &what)
{
  RPC_REQUIRE(condition, "deck: " << covered << "; " << what << ". Write \"estimated\"");
}

/// What kernels over cells read of a problem.
CellInput cell_input(const analysis::Problem &problem, const analysis::Model &model)
{
  const fem::Discretization &d = problem.discretization();
  CellInput in;
  in.coords = d.mesh->coords;
  in.cells = d.mesh->cells;
  in.block = d.mesh->block;
  in.lame = fem::lame_table(d, model.materials);
  for (int i = 0; i < 2; ++i) in.force[i] = model.body_force[i].constant;
  in.facets = facets_of(d);
  in.reference = reference_stress(d.mesh->element);
  return in;
}

/// Moves u so that the contact points of a rigid foundation lie nowhere in it.                             doc/theory.md (13.3)
void move_out(const ContactFacets &c, const int first, const contact::ContactNodes &points, const HostView<double *> &u)
{
  const auto node = to_host(points.node);
  const auto direction = to_host(points.direction);
  const auto gap = to_host(points.free_gap);
  const auto depth = [&](const int i) {
    return direction(i, 0) * u(dof(2, node(i), 0)) + direction(i, 1) * u(dof(2, node(i), 1)) - gap(i);
  };
  const auto move = [&](const int i, const double by) {
    const double squared = direction(i, 0) * direction(i, 0) + direction(i, 1) * direction(i, 1);
    for (int d = 0; d < 2 && squared > 0; ++d) u(dof(2, node(i), d)) -= by / squared * direction(i, d);
  };
  for (const auto &of_facet : c.point)
    for (const int a : of_facet)
      if (a >= 0) move(first + a, std::max(0., depth(first + a)));
  if (c.order == 1) return;
  for (const auto &of_facet : c.point) {
    const OfFacet v{depth(first + of_facet[0]), depth(first + of_facet[1]), depth(first + of_facet[2])};
    move(first + of_facet[2], std::max(0., v[2] - lowered_middle(v)));
  }
}

/// Penetrations of a side at the nodes of its facets. What rounding leaves of a point that is held at the surface is 0.
std::vector<OfFacet> depths(const ContactFacets &c, const int first, const contact::ContactNodes &points,
                            const HostView<double *> &u)
{
  const auto node = to_host(points.node);
  const auto normal = to_host(points.normal);
  const auto gap = to_host(points.gap);
  std::vector<OfFacet> all;
  for (const auto &of_facet : c.point) {
    OfFacet v{};
    for (int a = 0; a < 3; ++a) {
      if (of_facet[a] < 0) continue;
      const int i = first + of_facet[a];
      const double x = normal(i, 0) * u(dof(2, node(i), 0)), y = normal(i, 1) * u(dof(2, node(i), 1));
      v[a] = x + y - gap(i);
      if (std::abs(v[a]) <= 1e-14 * (std::abs(x) + std::abs(y) + std::abs(gap(i)))) v[a] = 0;
    }
    all.push_back(v);
  }
  return all;
}

} // namespace

void require_covered(const analysis::Task &task)
{
  require_of_deck(!task.has_steps(), "the deck has \"Steps\"");
  require_of_deck(task.model.kinematics != fem::Kinematics::axisymmetric, "the body is axisymmetric");
  for (int i = 0; i < 3; ++i)
    require_of_deck(task.model.body_force[i].is_constant(), "\"Body Force\" depends on the place");
  for (const auto &condition : task.model.dirichlet) {
    require_of_deck(!condition.is_moved(), "a force moves the side of \"Dirichlet->" + condition.name + "\"");
    for (const auto &u : condition.displacement)
      require_of_deck(!u || u->is_constant(), "\"Dirichlet->" + condition.name + "\" depends on the place");
  }
  for (std::size_t k = 0; k < task.model.contact.size(); ++k) {
    const auto &c = task.model.contact[k];
    const auto field = [&](const int p) { return c.*contact::law_parameters[p].field; };
    require_of_deck(field(0).is_constant(), "\"" + c.path + "->Yield Stress\" depends on the place");
    require_of_deck(field(1).is_zero(), "\"" + c.path + "->Hardening\" is not 0");
    require_of_deck(field(2).is_constant() && std::isinf(field(2).constant),
                    "\"" + c.path + "->Stiffness\" is not inf");
    require_of_deck(!c.has_friction(), "\"" + c.path + "\" has friction");
    for (std::size_t other = 0; other < k; ++other)
      require_of_deck(task.model.contact[other].side != c.side, "side \"" + c.side + "\" has several foundations");
  }
}

void require_covered(const analysis::Problem &problem, const analysis::Step &step)
{
  const fem::Discretization &d = problem.discretization();
  const analysis::Model model = problem.model().seen_at(step.time);
  require_of_deck(d.mesh->comm().getSize() == 1, "there are " + std::to_string(d.mesh->comm().getSize()) +
                                                     " ranks, and stars at their borders would need cells of both");
  require_of_deck(!step.support.by_contact_only, "contact alone holds the body");
  const auto projected = to_host(fem::projected_dilatation_table(d, model.materials));
  for (std::size_t b = 0; b < projected.extent(0); ++b)
    require_of_deck(projected(b) == 0, "the material of \"" + d.mesh->blocks[b] +
                                           "\" has a projected dilatation; where Poisson's ratio allows it, "
                                           "\"Dilatation\" = full is covered");
  if (d.dim() == 3) {
    const std::string reason = not_covered_in_space(problem, step);
    require_of_deck(reason.empty(), reason);
    return;
  }
  const CellInput in = cell_input(problem, model);
  const double distortion = largest_distortion(in, d.mesh->element);
  require_of_deck(distortion <= 1e-9, "cells of " + d.mesh->element.name() +
                                          " are curved, or quadrilaterals whose opposite sides are not parallel (by " +
                                          shown(distortion) + " of a cell)");
  boundary_of(problem, step, in.facets, HostView<double *>("rpc::bound::none", step.contact.size()));
}

namespace
{

EnergyBound bound_of(const analysis::Problem &problem, const analysis::StepSolution &s,
                     const solver::LinearSolverOptions &options, const int steps)
{
  const fem::Discretization &d = problem.discretization();
  const analysis::Model model = problem.model().seen_at(s.step.time);
  const CellInput in = cell_input(problem, model);
  const auto pressure = to_host(s.contact.pressure);
  HostView<double *> on_host("rpc::bound::pressure", pressure.extent(0));
  Kokkos::deep_copy(on_host, pressure);
  const Boundary boundary = boundary_of(problem, s.step, in.facets, on_host);

  EnergyBound bound;
  const HostView<double *> moved = host_copy(*s.u);
  for (std::size_t k = 0; k < boundary.sides.size(); ++k)
    if (contact::is_rigid(boundary.sides[k].limit))
      move_out(boundary.sides[k], s.step.contact.first(k), s.step.contact, moved);
  const RCP<const Vector> u = vector_of(moved, d.owned_dofs);
  Vector way(*u, Teuchos::Copy);
  way.update(-1, *s.u, 1);
  bound.moved = std::sqrt(std::max(0., fem::internal_work(d, model.materials, way).energy_norm_squared));

  std::vector<std::vector<OfFacet>> pressures;
  double yielding = 0, gap = 0;
  for (std::size_t k = 0; k < boundary.sides.size(); ++k) {
    const ContactFacets &c = boundary.sides[k];
    const auto v = depths(c, s.step.contact.first(k), s.step.contact, moved);
    pressures.push_back(fitted_pressure(c, v));
    for (std::size_t e = 0; e < v.size(); ++e) {
      if (contact::is_rigid(c.limit) && *std::max_element(v[e].begin(), v[e].end()) > 0)
        bound.missing = "the body lies in a rigid foundation";
      const ContactIntegrals of_facet = contact_integrals(c.order, v[e], pressures.back()[e], c.limit);
      yielding += c.length[e] * of_facet.yielding;
      gap += c.length[e] * of_facet.gap;
    }
  }
  const double strain = fem::internal_work(d, model.materials, *u).energy_norm_squared;
  const double work = work_of(d, known_moments(in, boundary.tractions), in, *u);
  bound.upper = strain / 2 - work + yielding;

  const BoundaryTractions all = with_pressure(boundary.tractions, boundary.sides, pressures);
  const double start = Teuchos::Time::wallTime();
  const Solved galerkin = galerkin_solution(problem, s, options, in, all);
  bound.solve_seconds = Teuchos::Time::wallTime() - start;
  bound.linear_iterations = galerkin.iterations;
  if (!galerkin.failure.empty()) bound.missing = galerkin.failure;
  if (!bound.missing.empty()) return bound;

  const Tractions t = equilibrated(in, all, galerkin.Q, mean_moments(in, *galerkin.u));
  const double lift = norm_of_lifted_loads(in, lifted_loads(d.mesh->element), boundary.tractions.load);
  const DeviceView<double *> of_cell("rpc::bound::of_cell", in.num_cells());
  const CellForms forms = cell_forms(in, *u);
  const StarSolves stars(in, all, forms);
  const DeviceView<double **> scratch("rpc::bound::scratch", in.num_cells(), in.reference.tractions);
  Descent descent(
      [&](const Tractions &x, const bool linear, const Tractions &y) { add_up(in, forms, x, linear, scratch, y); },
      [&](const Tractions &g, const Tractions &z) { stars.apply(g, z); }, t);
  std::vector<double> falls;
  for (int step = 0; step < steps; ++step) falls.push_back(descent.step());
  const StressDifference left = stress_difference(in, t, *u, of_cell);
  bound.imbalance = left.force > 0 ? left.imbalance / left.force : 0;
  double energy = left.energy;
  for (int step = steps; step >= 0; --step) {
    const double norm = std::sqrt(2 * energy) + lift;
    bound.steps.insert(bound.steps.begin(), norm * norm / 2 + gap);
    if (step > 0) energy += falls[step - 1];
  }
  const double best = bound.steps.back();
  bound.lower = bound.upper - best;
  bound.energy_norm = std::sqrt(2 * best) + bound.moved;
  if (!(bound.imbalance <= 1e-8))
    bound.missing = "cells are out of balance by " + shown(bound.imbalance) + " of their forces";
  return bound;
}

} // namespace

EnergyBound energy_bound(const analysis::Problem &problem, const analysis::StepSolution &solution,
                         const solver::LinearSolverOptions &options, const int steps)
{
  EnergyBound bound;
  double seconds = 0;
  {
    const Timed phase("bound", seconds);
    bound = problem.discretization().dim() == 3 ? bound_in_space(problem, solution, options, 2 * steps)
                                                : bound_of(problem, solution, options, steps);
  }
  bound.seconds = seconds;
  return bound;
}

} // namespace rpc::bound
