// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bounded.hpp"
#include "goal_estimate.hpp"
#include "pressed_body.hpp"
#include "side_press.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

/// Intervals of contact forces and goals from what is certain of the solution.                            doc/bounds.md (13.14) - (13.18)
namespace rpc::bound
{

/// What the error of a solution was bounded by.
struct SolvedStep {
  const analysis::Problem &problem;
  const analysis::StepSolution &solution;
  const solver::LinearSolverOptions &options;
  int steps;                 // of conjugate gradients
  const SpaceFacets *facets; // in the plane null
};

/// On which displacements of hexahedra are linear on halves of faces.
inline std::vector<std::string> contact_sides(const analysis::Problem &problem)
{
  std::vector<std::string> sides;
  for (const auto &contact : problem.model().contact) sides.push_back(contact.side);
  return sides;
}

inline double energy_norm(const Works &works, const Vector &w)
{
  return std::sqrt(std::max(0., works.squared(w).upper));
}

/// A displacement w beside u^.
struct Beside {
  Squared product; // bounds of a(u^, w)
  double norm;     // |w| [J^(1/2)]
};
/// By norms of sums of alike size.
template <class Side>
Beside beside_solution(const Bounded<Side> &b, const Vector &w)
{
  const double of_w = b.works.squared(w).upper;
  const Beside found{{}, std::sqrt(std::max(0., of_w))};
  if (b.squared == 0 || of_w == 0) return found;
  const double scale = std::sqrt(b.squared / of_w);
  Vector sum(*b.u, Teuchos::Copy), difference(*b.u, Teuchos::Copy);
  sum.update(scale, w, 1);
  difference.update(-scale, w, 1);
  const Squared more = b.works.squared(sum), less = b.works.squared(difference);
  return {{(more.lower - less.upper) / (4 * scale), (more.upper - less.lower) / (4 * scale)}, found.norm};
}

/// What the integral is, of the exact pressure over a part of a contact side.                                                   doc/bounds.md (13.14), (13.15)
template <class Side>
ForceBound force_bound(const Bounded<Side> &b, const SidePress &press)
{
  ForceBound force;
  force.missing = press.missing;
  if (!press.missing.empty()) return force;
  const auto work_of_pressure = [&](const Vector &w) {
    const Beside of = beside_solution(b, w);
    const double of_work = b.works.of_loads(w) - b.works.of_all(w) / 2, room = b.rho * of.norm;
    return Squared(of_work - of.product.upper / 2 - room, of_work - of.product.lower / 2 + room);
  };
  const Squared above = work_of_pressure(*press.above);
  if (!press.below.is_null()) {
    const Squared below = press.below == press.above ? above : work_of_pressure(*press.below);
    force.lower = std::max(0., below.lower - press.counted_twice);
  }
  force.upper = std::min(press.most, above.upper + press.missed);
  return force;
}

inline GoalBound pressure_goal(const Goal &goal, const SidePress &press, const ForceBound &force)
{
  const double size = goal.type == Goal::Type::mean_pressure ? press.size : 1;
  GoalBound bound;
  bound.goal = goal;
  bound.missing = force.missing;
  if (press.size > 0) bound.value = press.force / size;
  if (!force.missing.empty()) return bound;
  bound.lower = force.lower / size;
  bound.upper = force.upper / size;
  return bound;
}

/// The bounds of a problem without contact.
inline Bounded<ContactFacets> bounded_as(const Bounded<ContactFacets> &, const SolvedStep &s,
                                         const std::vector<std::string> &)
{
  return bounded_in_plane(s.problem, s.solution, s.options, s.steps);
}
inline Bounded<SpaceContact> bounded_as(const Bounded<SpaceContact> &, const SolvedStep &s,
                                        const std::vector<std::string> &flat)
{
  return bounded_in_space(s.problem, s.solution, s.options, s.steps, *s.facets, flat);
}

/// What it is, with displacements z that the load Q brings to the body without contact, and w to the body that the foundation holds.
///                                                                                                      doc/bounds.md (13.16) - (13.18)
template <class Side>
GoalBound displacement_goal(const SolvedStep &in, const Bounded<Side> &b, const Goal &goal)
{
  const double time = in.solution.step.time;
  const auto &mesh = in.problem.discretization().mesh;
  const analysis::Model model = in.problem.model().seen_at(time);
  fem::TractionLoad load{goal.name, goal.side, {}, {}};
  load.force[goal.component] = ScalarField(1.);
  analysis::Model free = without_loads(model), held = held_at_contact(model, mesh->dim(), b.sides, -1, NearPlaces(0));
  free.tractions = held.tractions = {load};

  GoalBound bound;
  bound.goal = goal;
  const analysis::Problem dual(mesh, free, time);
  analysis::SolverState state(dual, in.options);
  analysis::StepOptions exactly;
  exactly.looks_between_nodes = false;
  const analysis::StepSolution z = analysis::solve_step(dual, dual.step(time), state, exactly);
  if (!z.uzawa.converged) bound.missing = "the elastic solve for it failed: " + z.uzawa.reason;
  if (!bound.missing.empty()) return bound;
  const Bounded<Side> of_dual = bounded_as(b, {dual, z, in.options, in.steps, in.facets}, contact_sides(in.problem));
  const double of_moved = of_dual.works.of_loads(*b.u);
  bound.value = of_dual.works.of_loads(*in.solution.u);
  if (mesh->element.order == 1)
    bound.estimated_error = estimated_error(in.problem, in.solution, in.options, *z.step.elastic.applied_load);
  bound.lower = bound.upper = of_moved;
  if (energy_norm(b.works, *z.u) == 0) return bound; // prescribed
  bound.missing = of_dual.bound.missing;
  if (!bound.missing.empty()) return bound;
  const RoughSolution w = rough_solution(analysis::Problem(mesh, held, time), time, in.options);
  bound.missing = w.missing;
  if (!bound.missing.empty()) return bound;
  Vector rest(*z.u, Teuchos::Copy);
  rest.update(-1, *w.u, 1);
  const Squared of_w = beside_solution(b, *w.u).product;
  const Beside of_rest = beside_solution(b, rest);
  const double of_work = b.works.of_loads(*w.u) + b.works.of_all(rest) / 2,
               room = b.rho * of_rest.norm + 2 * std::sqrt(b.bound.steps.back() * of_dual.bound.steps.back());
  bound.lower += of_work - of_w.upper - of_rest.product.upper / 2 - room;
  bound.upper += of_work - of_w.lower - of_rest.product.lower / 2 + room;
  return bound;
}

/// The bound with the intervals of all contact forces and goals. Collective.
template <class Side>
EnergyBound with_functionals(const SolvedStep &in, const Bounded<Side> &b, const std::vector<Goal> &goals)
{
  EnergyBound bound = b.bound;
  if (!bound.missing.empty()) {
    for (const Goal &goal : goals)
      bound.goals.push_back({goal, std::nan(""), std::nan(""), 0, 0, "there is no bound of the error"});
    return bound;
  }
  const double time = in.solution.step.time;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Box everything{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  std::vector<SidePress> whole;
  for (std::size_t k = 0; k < b.sides.size(); ++k) {
    whole.push_back(side_press(in.problem, time, b.sides, static_cast<int>(k), everything, in.options));
    bound.contact_force.push_back(force_bound(b, whole.back()));
  }
  for (const Goal &goal : goals) {
    if (goal.type == Goal::Type::mean_displacement) {
      bound.goals.push_back(displacement_goal(in, b, goal));
      continue;
    }
    const auto &contact = in.problem.model().contact;
    const auto k = std::find_if(contact.begin(), contact.end(), [&](const auto &c) { return c.side == goal.side; }) -
                   contact.begin();
    const SidePress press =
        goal.part ? side_press(in.problem, time, b.sides, static_cast<int>(k), *goal.part, in.options) : whole[k];
    bound.goals.push_back(pressure_goal(goal, press, goal.part ? force_bound(b, press) : bound.contact_force[k]));
  }
  return bound;
}

} // namespace rpc::bound
