// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/bound/bound.hpp"

#include "bound_parts.hpp"
#include "boundary.hpp"
#include "cell_kinds.hpp"
#include "contact_terms.hpp"
#include "descent.hpp"
#include "functionals.hpp"
#include "revolution_cells.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/timed.hpp"
#include "rpc/fem/measure.hpp"
#include "space_bound.hpp"
#include "star_solves.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::bound
{
namespace
{

constexpr const char *covered =
    "\"Adapt->Error Bound\" = guaranteed covers plane strain, plane stress and bodies of revolution of straight "
    "triangles or parallelograms, "
    "straight tetrahedra, and hexahedra of order 1, on foundations whose law is the same all along a side";

void require_of_deck(const bool condition, const std::string &what)
{
  RPC_REQUIRE(condition, "deck: " << covered << "; " << what << ". Write \"estimated\"");
}

/// @param model  seen at one time
void require_same_everywhere(const analysis::Model &model)
{
  for (int i = 0; i < 3; ++i)
    require_of_deck(value_everywhere(model.body_force[i]).has_value(), "\"Body Force\" depends on the place");
  for (const auto &c : model.contact)
    for (const auto &number : contact::law_parameters)
      require_of_deck(value_everywhere(c.*number.field).has_value(),
                      "\"" + c.path + "->" + number.name + "\" depends on the place");
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
  for (int i = 0; i < 2; ++i) in.force[i] = value_everywhere(model.body_force[i]).value();
  in.num_owned_cells = d.mesh->num_owned_cells;
  in.facets = facets_of(d);
  in.reference = reference_stress(d.mesh->element);
  if (d.axisymmetric()) {
    in.revolution = revolution_tables(d.mesh->element);
    in.on_axis = d.on_axis;
  }
  return in;
}

/// The inner product, each facet counted by one rank.
double product_over_ranks(const CellInput &in, const Comm &comm, const Tractions &x, const Tractions &y)
{
  const int per_facet = 2 * (in.reference.degree + 1);
  const auto counts = in.facets.counts;
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::bound::product_over_ranks", device_range(in.facets.size()),
      KOKKOS_LAMBDA(const LO f, double &part) {
        for (int q = 0; q < per_facet && counts(f); ++q) part += x(f * per_facet + q) * y(f * per_facet + q);
      },
      sum);
  return sum_all(comm, sum);
}

} // namespace

void require_covered(const analysis::Task &task, const std::vector<Goal> &goals)
{
  for (const auto &condition : task.model.dirichlet)
    require_of_deck(!condition.is_moved() && !condition.rigid,
                    "\"" + condition.path() + "\" " +
                        (condition.rigid ? "holds its side rigid" : "is moved by a force") +
                        ", whose resultant the stresses in equilibrium would have to have");
  for (const auto &side : task.model.contact)
    require_of_deck(!side.obstacle.is_moved(),
                    "a force or a spring moves the obstacle of \"" + side.path +
                        "\", whose resultant the stresses in equilibrium would have to have");
  for (std::size_t k = 0; k < task.model.contact.size(); ++k)
    for (std::size_t other = 0; other < k; ++other)
      require_of_deck(task.model.contact[other].side != task.model.contact[k].side,
                      "side \"" + task.model.contact[k].side + "\" has several foundations");
  for (const Goal &goal : goals) {
    const bool of_displacement = goal.type == Goal::Type::mean_displacement;
    std::vector<std::string> sides;
    for (const auto &side : task.model.contact) sides.push_back(side.side);
    RPC_REQUIRE(of_displacement || std::find(sides.begin(), sides.end(), goal.side) != sides.end(),
                "deck: \"" << goal.path() << "\" is a " << name_of(goal.type) << ", and side \"" << goal.side
                           << "\" has no contact. "
                           << (sides.empty() ? "There is no contact side" : "Contact sides are " + join(sides)));
    RPC_REQUIRE(!of_displacement || task.model.kinematics != fem::Kinematics::axisymmetric,
                "deck: \"" << goal.path()
                           << "\" is a mean displacement of a body of revolution, of which pressures and contact "
                              "forces alone have intervals. Leave it out");
  }
  require_same_everywhere(task.model.seen_at(task.has_steps() ? task.steps.times.front() : task.time));
}

FacetsOfMesh require_covered(const analysis::Problem &problem, const analysis::Step &step,
                             const std::vector<Goal> &goals)
{
  const fem::Discretization &d = problem.discretization();
  for (const Goal &goal : goals)
    RPC_REQUIRE(fem::side_measure(d, d.mesh->side(goal.side, goal.path())).area > 0,
                "deck: \"" << goal.path() << "\": side \"" << goal.side << "\" has no facets");
  const analysis::Model model = problem.model().seen_at(step.time);
  require_same_everywhere(model);
  require_of_deck(!step.support.by_contact_only, "contact alone holds the body");
  const auto projected = to_host(fem::projected_dilatation_table(d, model.materials));
  for (std::size_t b = 0; b < projected.extent(0); ++b)
    require_of_deck(projected(b) == 0, "the material of \"" + d.mesh->blocks[b] +
                                           "\" has a projected dilatation; where Poisson's ratio allows it, "
                                           "\"Dilatation\" = full is covered");
  if (d.dim() == 3) {
    FacetsOfMesh facets;
    const std::string reason = not_covered_in_space(problem, step, facets);
    require_of_deck(reason.empty(), reason);
    return facets;
  }
  const CellInput in = cell_input(problem, model);
  const double distortion = max_all(d.mesh->comm(), largest_distortion(in, d.mesh->element));
  require_of_deck(distortion <= 1e-9, "cells of " + d.mesh->element.name() +
                                          " are curved, or quadrilaterals whose opposite sides are not parallel (by " +
                                          shown(distortion) + " of a cell)");
  const Boundary b =
      boundary_of(problem, step, in.facets, {HostView<double *>("rpc::bound::none", step.contact.size()), {}});
  if (!in.of_revolution()) return {};
  const std::string reason = loads_not_covered(in, d.mesh->comm(), b.tractions, d.mesh->num_owned_nodes());
  require_of_deck(reason.empty(), reason);
  return {};
}

Bounded<ContactFacets> bounded_in_plane(const analysis::Problem &problem, const analysis::StepSolution &s,
                                        const solver::LinearSolverOptions &options, const int steps)
{
  const fem::Discretization &d = problem.discretization();
  const analysis::Model model = problem.model().seen_at(s.step.time);
  CellInput in = cell_input(problem, model);
  const Kinds kinds = in.of_revolution()
                          ? all_different(in.num_cells())
                          : kinds_of_cells(d.mesh->comm(), in.coords, in.cells, in.block, in.reference.sides);
  in.kind = kinds.kind;
  in.example = kinds.example;
  const Boundary boundary = boundary_of(problem, s.step, in.facets, tractions_of(s.contact));

  Bounded<ContactFacets> bounded;
  bounded.sides = boundary.sides;
  EnergyBound &bound = bounded.bound;
  auto squared = squared_by_elements(problem);
  if (in.of_revolution())
    squared = [&d, in](const Vector &x) { return squared_of_revolution(in, d.mesh->comm(), *fem::on_overlap(d, x)); };
  const HostView<double *> moved = moved_out(problem, model, s, boundary.sides, bound);
  const RCP<const Vector> u = vector_of(moved, d.owned_dofs);
  const ContactTerms contact = contact_terms(boundary.sides, *d.mesh, moved);
  bound.missing = contact.missing;
  if (in.of_revolution()) {
    Vector way(*u, Teuchos::Copy);
    way.update(-1, *s.u, 1);
    bound.moved = std::sqrt(std::max(0., squared(way).upper));
  }
  const Squared strain = squared(*u);
  const double work = work_of(d, known_moments(in, boundary.tractions), in, *u);
  bound.upper = strain.upper / 2 - work + contact.energy;

  const BoundaryTractions all = with_contact(boundary.tractions, boundary.sides, contact.tractions);
  bounded.u = u;
  bounded.squared = strain.upper;
  bounded.works = works_of(problem, in, boundary.tractions, all, squared);
  const Solved galerkin = timed_galerkin_solution(problem, s, options, in, all, bound);
  if (!bound.missing.empty()) return bounded;

  const FacetExchange exchange(d, in.facets);
  const Comm &comm = d.mesh->comm();
  const Tractions t = equilibrated(in, all, galerkin.Q, mean_moments(in, *fem::on_overlap(d, *galerkin.u)), exchange);
  if (in.of_revolution()) admit_on_axis(in, t);
  const double lift = norm_of_lifted_loads(in, comm, lifted_loads(d.mesh->element), boundary.tractions.load);
  const DeviceView<double *> of_cell("rpc::bound::of_cell", in.num_owned_cells);
  const RCP<const Vector> on_overlap = fem::on_overlap(d, *u);
  const CellForms forms = cell_forms(in, *on_overlap);
  const StarSolves stars(in, all, forms, exchange);
  Descent descent([&](const Tractions &x, const bool linear, const Tractions &y) { add_up(in, forms, x, linear, y); },
                  [&](const Tractions &g, const Tractions &z) { stars.apply(g, z); },
                  [&](const Tractions &x, const Tractions &y) { return product_over_ranks(in, comm, x, y); }, t);
  std::vector<double> falls;
  for (int step = 0; step < steps; ++step) falls.push_back(descent.step());
  const StressDifference left = stress_difference(in, comm, t, *on_overlap, of_cell);
  bounded.rho = take_descent(comm, in, boundary.sides, contact, left, falls, lift, of_cell, bound);
  bound.lower -= (strain.upper - strain.lower) / 2;
  return bounded;
}

const char *name_of(const EnergyBound::Of of)
{
  switch (of) {
  case EnergyBound::Of::energy:
    return "J";
  case EnergyBound::Of::energy_and_friction:
    return "J and friction's work";
  default:
    return "J and friction's work, its limits kept at those of this solution";
  }
}

EnergyBound energy_bound(const analysis::Problem &problem, const analysis::StepSolution &solution,
                         const solver::LinearSolverOptions &options, const int steps, const FacetsOfMesh &facets,
                         const std::vector<Goal> &goals)
{
  EnergyBound bound;
  double seconds = 0;
  {
    const Timed phase("bound", seconds);
    const bool in_space = problem.discretization().dim() == 3;
    const FacetsOfMesh found = in_space && !facets ? require_covered(problem, solution.step, goals) : facets;
    const SolvedStep in{problem, solution, options, steps, found.get()};
    bound = in_space
                ? with_functionals(
                      in, bounded_in_space(problem, solution, options, steps, *found, contact_sides(problem)), goals)
                : with_functionals(in, bounded_in_plane(problem, solution, options, steps), goals);
  }
  bound.seconds = seconds;
  return bound;
}

} // namespace rpc::bound
