// SPDX-License-Identifier: BSD-3-Clause
/// The algorithm: solve_step() is the loop, with the number of each line's equation beside it, in the paper or in doc/theory.md; the
/// functions that it calls follow.
#include "rpc/analysis/solve_step.hpp"

#include "body/obstacle_force.hpp"
#include "rpc/analysis/active_set.hpp"
#include "rpc/analysis/mesh_levels.hpp"
#include "rpc/analysis/rules.hpp"
#include "rpc/analysis/same_active_set.hpp"
#include "rpc/analysis/side_displacements.hpp"
#include "rpc/contact/between_nodes.hpp"
#include "rpc/contact/clearance.hpp"
#include "rpc/contact/energies.hpp"
#include "rpc/contact/tied_points.hpp"
#include "rpc/core/causes.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/timed.hpp"
#include "rpc/solver/rules.hpp"
#include "step/softness.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

namespace rpc::analysis
{

using contact::DualVariables;
using contact::Iterate;

namespace
{

/// How the minimization before has ended.
struct LastMinimum {
  bool confirmed = false;     ///< its active set was
  DualVariables::Values dual; ///< with friction: what it had, before pressures became multipliers
};

Prediction predict(const Problem &, const Step &, Iterate &, Vector &u, const Starts &, double near);
Minimization minimize(const Problem &problem, Iterate &iterate, const RCP<Vector> &u, SolverState &state,
                      const StepOptions &options, int iteration, const LastMinimum &last,
                      const std::optional<PredictedBy> &predicted, const Progress &progress);
double residual_before(const std::vector<double> &worst, bool bounds_follow);
contact::OptimalityResiduals judge(const Problem &problem, const Step &step, const Iterate &iterate,
                                   const contact::ContactState &now, SolverState &state, double tolerance);
void tell_want_of_friction(UzawaResult &uzawa, const Problem &problem, const Vector &u);
void read_results(const Problem &problem, const StepOptions &options, SolverState &state, StepSolution &s);
solver::LinearSolverCounts counts_since(const solver::LinearSolverCounts &before, solver::LinearSolverCounts now);

StepSolution solve_with(const Problem &problem, const Step &step, SolverState &state, const StepOptions &options,
                        const bool low_penalties, const Starts &starts, const Progress &progress)
{
  StepSolution s;
  s.step = step;
  const auto u = rcp(new Vector(*step.elastic.dirichlet.value, Teuchos::Copy)); // seen from the iterate's origin
  Iterate iterate(step.elastic, step.contact, state.hessian());
  if (step.support.by_contact_only) iterate.hold_by_contact();                                     // (9.8)
  if (step.contact.friction.anywhere) s.raised_penalties = iterate.duals().raise_weak_penalties(); // (12.12b)
  if (low_penalties) iterate.duals().lower_penalties();                                            // (12.12a)
  std::optional<PredictedBy> predicted; // nothing: no coarser mesh predicts the start
  const auto counts_before = state.linear().counts();
  solver::check_nox_parameters(iterate, state.linear(), u, options.newton);
  if (progress.start) progress.start(problem, step);
  {
    const Timed timer("prediction", s.prediction_seconds);
    Prediction prediction =
        predict(problem, step, iterate, *u, starts, step_rules.of_rounding * options.uzawa.tolerance); // (5.11), (11.5)
    s.not_predicted = std::move(prediction.reason);
    s.levels = std::move(prediction.work);
    s.start = prediction.nearest;
    if (prediction.start) predicted = std::move(prediction.by);
    if (iterate.duals().given() && closes_under_force(problem, step)) // springs are not needed to hold the body
      iterate.step_taken(std::numeric_limits<double>::infinity());    // (9.8)
  }
  {
    const Timed timer("solve", s.solve_seconds);
    UzawaResult &uzawa = s.uzawa;
    bool over = false;
    LastMinimum last;
    std::vector<double> worst;  // largest residual of each iteration
    while (!over) {             // paper (16), paper (17): the gradient method for the dual problem
      if (uzawa.iterations > 0) // the correction is small against u (5.13)
        iterate.move_origin(*u, *uzawa.residuals.internal.forces, *step.elastic.applied_load);
      const Minimization found = // paper (10), (4.1): choose states (5.8) and solve (5.7), (5.9),
          minimize(problem, iterate, u, state, options, uzawa.iterations + 1, last, predicted,
                   progress); // Newton (4.2)
      last.confirmed = found.active_set_confirmed;
      if (step.contact.friction.anywhere) last.dual = iterate.duals().values();
      uzawa.multiplier_change = found.active_set_confirmed ? iterate.take_active_set_pressures(*u)
                                                           : iterate.duals().update(*u); // paper (11), (5.1)
      s.state = iterate.state(*u);
      uzawa.residuals =
          judge(problem, step, iterate, s.state, state, options.uzawa.tolerance); // paper (8); (5.2) - (5.5)
      uzawa.newton_iterations.push_back(found.steps);
      s.line_search_steps += found.line_search_steps;
      s.coarse_choices += found.coarse_choices;
      s.found_by = std::max(s.found_by, found.found_by);
      ++uzawa.iterations;
      if (progress.uzawa) progress.uzawa(uzawa);
      const double previous = residual_before(worst, found.bounds_follow);
      worst.push_back(uzawa.residuals.worst());
      s.u = s.state.displacement;
      uzawa.converged = found.active_set_confirmed && leads_on(problem, s, starts, options); // (3.17c)
      if (uzawa.converged) break;
      over = is_over(
          uzawa, found, previous, options.uzawa, problem.discretization().mesh->comm(),
          [&] { return iterate.raise_penalty(*u); }, // (5.12)
          [&] {
            return contact::residual_of_rounding(problem.discretization(), problem.model().materials,
                                                 step.elastic.dirichlet, *s.state.displacement,
                                                 uzawa.residuals.force_size);
          });
    }
    if (!uzawa.converged && step.support.by_coulomb_only) tell_want_of_friction(uzawa, problem, *s.state.displacement);
    s.state.rest = Teuchos::null; // of the judgement alone
    if (uzawa.converged && starts.may_rest) rest_where_led(problem, starts.led_before, options.uzawa.tolerance, s);
    read_results(problem, options, state, s);
  }
  s.linear = counts_since(counts_before, state.linear().counts());
  s.solve_seconds -= s.linear.setup_seconds;
  return s;
}

} // namespace

StepSolution solve_step(const Problem &problem, const Step &step, SolverState &state, const StepOptions &options,
                        const Starts &starts, const Progress &progress)
{
  StepSolution s = solve_with(problem, step, state, options, false, starts, progress);
  const auto again = [&](const bool low_penalties, const Starts &from) {
    StepSolution other = solve_with(problem, step, state, options, low_penalties, from, progress);
    if (other.uzawa.converged) std::swap(other, s);
    add_work(other, s);
  };
  const bool from_rest = s.start + 1 == starts.states.size();
  if (s.uzawa.friction_unsettled && options.from_rest && !starts.states.empty() && !from_rest) {
    again(false, {{starts.states.back()}, {}}); // there may be no solution near by
    s.from_rest = s.uzawa.converged;
  }
  if (s.uzawa.friction_unsettled && options.low_penalties) again(true, starts);
  return s;
}

namespace
{

// Predict: the nearest of the given states, or what coarser meshes say ----------------------------------------------------

/// Starts from the state whose displacement and multipliers are nearest to equilibrium. @return whether it is so near that a prediction would be no better
bool start_from_nearest(Iterate &iterate, Vector &u, const Starts &starts, const double near, std::size_t &nearest)
{
  const std::vector<contact::ContactState> &states = starts.states;
  const Vector rest(u, Teuchos::Copy);
  const auto take = [&](const contact::ContactState &state) {
    u.assign(rest);
    iterate.start_from(state, u);
  };
  if (states.size() == 1 && !starts.predict) { // nothing to choose
    take(states[0]);
    return true;
  }
  nearest = 0;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    take(states[k]);
    const double out_of_balance = iterate.out_of_balance(u);
    most = std::max(most, out_of_balance);
    if (!(out_of_balance < least)) continue;
    least = out_of_balance;
    nearest = k;
  }
  if (nearest + 1 < states.size()) take(states[nearest]);
  return !starts.predict || (least <= near * std::max(iterate.force_scale(), most) &&
                             contact::contact_law_residual(iterate.points(), iterate.state(u)) <= near);
}

/// @return its reason is why no coarser mesh predicted the start; empty if one did, or none was needed
Prediction predict(const Problem &problem, const Step &step, Iterate &iterate, Vector &u, const Starts &starts,
                   const double near)
{
  Prediction prediction;
  if (starts.states.empty() && !contact::is_loaded(*u.getMap()->getComm(), step.elastic, step.contact)) {
    prediction.reason = "nothing loads the body"; // the start is the solution; a coarser mesh would see other gaps
    return prediction;
  }
  if (!starts.states.empty() && start_from_nearest(iterate, u, starts, near, prediction.nearest)) return prediction;
  const std::size_t nearest = prediction.nearest;
  prediction.reason = "there is none";
  if (starts.predict) prediction = starts.predict();
  prediction.nearest = starts.states.empty() || prediction.start ? starts.states.size() : nearest;
  if (prediction.start) iterate.start_from(*prediction.start, u);
  if (!starts.states.empty()) prediction.reason.clear();
  if (starts.predict || starts.states.empty()) settle_obstacle(problem, iterate, u); // (3.17f)
  return prediction;
}

// Solve: a loop for each minimization, whose steps NOX makes: those of the active-set iteration, then Newton's ------------------

/// Iterative refinement: a solve for the residual at the origin, below Newton's tolerance, which moves a body that bends far.
/// @return the number of solves
int refine(const Iterate &iterate, Vector &u, SolverState &state)
{
  Vector F(u.getMap()), G(u.getMap()), move(u.getMap());
  iterate.gradient(u, F);
  iterate.active_set_gradient(u, F, G); // (5.6)
  if (!(G.norm2() > 0) || !state.linear().solve(G, move, double(step_rules.refinement)).converged) return 0;
  u.update(-1., move, 1.);
  return 1;
}

/// A minimization by a loop, of so many steps at most.
using Run = std::function<solver::MinimizeResult(const solver::MinimizationLoop &, int most_steps)>;

/// Chooses states and solves, or goes on with another method where that makes no progress: see ActiveSetLoop.
Minimization minimize_by_choices(const Problem &problem, Iterate &iterate, const StepOptions &options,
                                 const std::optional<PredictedBy> &predicted, const Run &run)
{
  ActiveSetTolerances tolerances = active_set_tolerances(options);
  tolerances.nearly_incompressible = is_nearly_incompressible(problem.discretization(), problem.model().materials);
  ActiveSetLoop loop(iterate, tolerances);
  if (predicted) loop.starts_predicted(predicted->found_by, predicted->coarse_choice);
  if (options.starts_near) loop.starts_near();
  const auto result = run(std::ref(loop), options.newton.max_iterations);
  const bool bounds_follow = iterate.points().friction.anywhere && !loop.confirmed();
  return {result.converged,    result.steps,          result.reason, loop.confirmed(),
          result.newton_steps, loop.coarse_choices(), bounds_follow, loop.found_by()};
}

/// From the states of the last minimization; with friction by one step, after which choices go on, not the functional.
/// @param[out] in_vain  steps that were taken back
/// @return none if friction changes states: u is where it was
std::optional<Minimization> minimize_for_same_states(Iterate &iterate, Vector &u, SolverState &state,
                                                     const StepOptions &options, const Run &run, int &in_vain)
{
  const bool friction = iterate.points().friction.anywhere;
  const Vector start(u, friction ? Teuchos::Copy : Teuchos::View);
  const auto result =
      run([&](solver::MinimizationSteps &steps) { return minimize_from_same_active_set(iterate, steps); },
          friction ? 1 : options.newton.max_iterations);
  if (friction && !(result.converged && result.newton_steps == 0)) {
    if (result.newton_steps > 0) u.assign(start);
    in_vain = result.steps;
    return std::nullopt;
  }
  const int steps = result.steps == 0 && result.converged ? refine(iterate, u, state) : result.steps;
  return Minimization{result.converged, steps, result.reason, false, result.newton_steps};
}

/// Where friction's states were not confirmed: coupled active-set updates once more, from the end of the last Tresca problem; if these do
/// not converge within a few steps, the Tresca problem with the next bounds. (12.12)
Minimization minimize_for_next_bounds(Iterate &iterate, Vector &u, const StepOptions &options, const int iteration,
                                      const LastMinimum &last, const Run &run)
{
  int steps = 0, most = options.newton.max_iterations;
  if (solver::takes_loop(options.newton)) {
    const Vector start(u, Teuchos::Copy);
    const DualVariables::Values dual = iterate.duals().values();
    // With pressures for multipliers r v counts twice, and v may turn its sign at each update. Active sets converge from the multipliers before
    // as a rule, and at times only from the pressures: in turn.
    if (!last.confirmed && iteration % 2 == 0) iterate.duals().take(last.dual);
    ActiveSetLoop choices(iterate, active_set_tolerances(options), ActiveSetLoop::Then::nothing);
    const auto tried = run(std::ref(choices), most);
    if (choices.confirmed()) return {tried.converged, tried.steps, tried.reason, true};
    steps = tried.steps;
    u.assign(start);
    iterate.duals().take(dual);
    most = std::min<int>(most, solver::newton_rules.most_inner_steps);
  }
  iterate.duals().follow_bounds();
  auto result = run({}, most);
  if (result.steps == most && most < options.newton.max_iterations)
    result.reason.clear(); // the bound is not the deck's
  return {result.converged, steps + result.steps, result.reason, false, result.steps, 0, true};
}

Minimization minimize(const Problem &problem, Iterate &iterate, const RCP<Vector> &u, SolverState &state,
                      const StepOptions &options, const int iteration, const LastMinimum &last,
                      const std::optional<PredictedBy> &predicted, const Progress &progress)
{
  const Run run = [&](const solver::MinimizationLoop &loop, const int most_steps) {
    solver::NewtonOptions newton = options.newton;
    newton.max_iterations = most_steps;
    return solver::minimize(iterate, state.linear(), u, iterate.force_scale(), newton, loop,
                            [&](const solver::NewtonStep &newton, const Vector &at) {
                              if (progress.newton)
                                progress.newton(iteration, newton, iterate.functional().count_states(at));
                            });
  };
  if (iteration == 1) return minimize_by_choices(problem, iterate, options, predicted, run);
  int in_vain = 0;
  if (!iterate.points().friction.anywhere || last.confirmed)
    if (auto found = minimize_for_same_states(iterate, *u, state, options, run, in_vain)) return *std::move(found);
  Minimization found = minimize_for_next_bounds(iterate, *u, options, iteration, last, run);
  found.steps += in_vain;
  return found;
}

/// The residual that an iteration's is compared with: the last one, or one of some iterations ago where bounds follow the pressures, for
/// accelerated sequences do not fall at each step.
double residual_before(const std::vector<double> &worst, const bool bounds_follow)
{
  const std::size_t back = bounds_follow ? static_cast<std::size_t>(step_rules.iterations_back) : 1;
  return worst.size() < back ? std::numeric_limits<double>::infinity() : worst[worst.size() - back];
}

// Judge ----------------------------------------------------------------------------------------------------------------

contact::OptimalityResiduals judge(const Problem &problem, const Step &step, const Iterate &iterate,
                                   const contact::ContactState &now, SolverState &state, const double tolerance)
{
  const auto of = [&](const contact::ContactState &judged) {
    return contact::optimality_residuals(
        problem.discretization(), problem.model().materials, step.elastic, step.contact, judged, iterate.force_scale(),
        [&](const Vector &residual) { return state.linear().inverse_energy(residual); },
        tolerance * step.energies_before);
  };
  contact::ContactState rounded = now;
  rounded.rest = Teuchos::null;
  auto residuals = of(rounded);
  if (residuals.holds(tolerance)) return residuals;
  if (!now.rest.is_null()) {
    const auto unrounded = of(now);          // (5.2a)
    residuals.internal = unrounded.internal; // the next origin's
    if (unrounded.worst() < residuals.worst()) residuals = unrounded;
  }
  if (!residuals.holds(tolerance) && step.contact.friction.anywhere)
    residuals.kkt_residual = contact::contact_law_residual(step.contact, now, 1); // (12.7a)
  if (!residuals.holds(tolerance))
    contact::forgive_energies_of_rounding(problem.discretization(), problem.model().materials, step.elastic,
                                          step.contact, now, tolerance, tolerance * step.energies_before,
                                          residuals); // (5.5a)
  return residuals;
}

/// The reason of a step without convergence where friction that follows the pressures must hold the body. What ended the last minimization is
/// then no reason, nor is a residual, or the rounding, of a body that has moved away. (12.10)
void tell_want_of_friction(UzawaResult &uzawa, const Problem &problem, const Vector &u)
{
  if (interrupted(problem.discretization().mesh->comm())) return;
  const bool moves =
      uzawa.friction_unsettled || !(uzawa.residuals.worst() < 1) || u.normInf() > problem.discretization().diameter;
  if (moves) uzawa.reason = std::to_string(uzawa.iterations) + " Uzawa iterations were not enough";
  uzawa.reason += "; " + because(causes::want_of_friction);
  if (moves) uzawa.reason_has_residuals = false;
}

/// Forces with which the Dirichlet conditions hold the body, and those of rigid sides with their moments. (2.11)
std::vector<std::array<double, 3>> reactions(const Problem &problem, StepSolution &s)
{
  const fem::ElasticProblem &elastic = s.step.elastic;
  const fem::Discretization &d = problem.discretization();
  Vector out_of_balance(*s.uzawa.residuals.forces, Teuchos::Copy);
  out_of_balance.update(-1., *elastic.applied_load, -1., contact::contact_forces(d, s.step.contact, s.contact), 1.);
  if (!s.step.on_floating.is_null()) out_of_balance.update(1., *s.step.on_floating, 1.); // which is no load (3.17)
  const Model now = problem.model().seen_at(s.step.time);
  auto forces = fem::reaction_forces(d, elastic.dirichlet, static_cast<int>(now.dirichlet.size()), out_of_balance);
  for (const auto &[k, c] : fem::moved_by_force(now.dirichlet)) forces[k][c] += (*now.dirichlet[k].force[c])({});
  s.rigid_forces.clear();
  for (const fem::RigidSide &side : elastic.dirichlet.rigid) {
    fem::SixNumbers all = fem::resultants_on(side, elastic.dirichlet.condition, out_of_balance);
    const fem::SixNumbers given = fem::given_forces(now.dirichlet[side.condition]);
    for (int k = 0; k < 6; ++k) all[k] += given[k];
    std::copy_n(all.begin(), 3, forces[side.condition].begin());
    s.rigid_forces.push_back(all);
  }
  return forces;
}

/// How far forces have moved sides, and the sides' other means. @throws rpc::Error (bad_input) where a node that moves so touches; collective
void read_tied(const Problem &problem, const StepOptions &options, StepSolution &s)
{
  const fem::DirichletDofs &dirichlet = s.step.elastic.dirichlet;
  s.rigid_motions.clear();
  for (const fem::RigidSide &side : dirichlet.rigid) s.rigid_motions.push_back(fem::motions_of(side, *s.u));
  if (!dirichlet.tied) return;
  const auto &conditions = problem.model().dirichlet;
  if (s.uzawa.converged && obstacle_rests(problem, s, step_rules.of_rounding * options.uzawa.tolerance))
    contact::settle_tied_points(problem.discretization(), s.step.contact, dirichlet, problem.model().contact, s.state);
  s.displacements = held_displacements(problem, *s.u);
  const auto moved = means(*dirichlet.tied, *s.u);
  const auto groups = fem::moved_by_force(conditions);
  for (std::size_t j = 0; j < groups.size(); ++j) s.displacements[groups[j].condition][groups[j].component] = moved[j];
  for (std::size_t j = 0; j < dirichlet.rigid.size(); ++j)
    std::copy_n(s.rigid_motions[j].begin(), 3, s.displacements[dirichlet.rigid[j].condition].begin());
}

/// Of the loads along the displacement, seen from where the body is held, and of the force on the obstacle along its way.      (3.17)
double work_of_loads(const Problem &problem, const StepSolution &s)
{
  const Vector &load = *s.step.elastic.applied_load;
  if (s.step.on_floating.is_null()) return load.dot(*s.state.displacement);
  const Point way = left_to_go(problem, s);
  const auto u = shifted(*s.state.displacement, way, problem.discretization().dim());
  return load.dot(*u) - s.step.on_floating->dot(*u) + work_on_obstacle(problem, s.step, way);
}

void read_results(const Problem &problem, const StepOptions &options, SolverState &state, StepSolution &s)
{
  read_tied(problem, options, s);
  s.softness = softness_of(problem, s.step.elastic.dirichlet, state);
  s.contact = contact::contact_result(problem.discretization(), problem.contact_sides(), s.step.contact, s.state,
                                      contact::has_friction(problem.model().contact));
  if (options.looks_between_nodes)
    contact::look_between_nodes(problem.discretization(), problem.contact_sides(),
                                problem.model().seen_at(s.step.time, s.step.obstacle).contact, s.step.contact,
                                problem.model().materials, *s.state.displacement, s.contact); // (3.15)
  s.energy_norm_squared = s.uzawa.residuals.internal.energy_norm_squared;
  const double elastic = 0.5 * s.energy_norm_squared - work_of_loads(problem, s) +
                         fem::spring_energy(s.step.elastic.dirichlet.rigid, *s.u) + // (1.2), (2.9c)
                         spring_energy_of_obstacle(problem, s.step, left_to_go(problem, s));
  s.energy = contact::energy(elastic, s.step.contact, s.state); // paper (6); (5.14)
  s.reactions = reactions(problem, s);
}

/// What the linear solver has done since.
solver::LinearSolverCounts counts_since(const solver::LinearSolverCounts &before, solver::LinearSolverCounts now)
{
  now.iterations.erase(now.iterations.begin(),
                       now.iterations.begin() + static_cast<std::ptrdiff_t>(before.iterations.size()));
  now.preconditioner_setups -= before.preconditioner_setups;
  now.local_corrections -= before.local_corrections;
  now.setup_seconds -= before.setup_seconds;
  now.solve_seconds -= before.solve_seconds;
  return now;
}

} // namespace

void add_work(const StepSolution &other, StepSolution &s)
{
  s.prediction_seconds += other.prediction_seconds;
  s.solve_seconds += other.solve_seconds;
  s.line_search_steps += other.line_search_steps;
  s.coarse_choices += other.coarse_choices;
  s.uzawa.iterations += other.uzawa.iterations;
  s.uzawa.newton_iterations.insert(s.uzawa.newton_iterations.end(), other.uzawa.newton_iterations.begin(),
                                   other.uzawa.newton_iterations.end());
  s.linear.iterations.insert(s.linear.iterations.end(), other.linear.iterations.begin(), other.linear.iterations.end());
  s.linear.preconditioner_setups += other.linear.preconditioner_setups;
  s.linear.local_corrections += other.linear.local_corrections;
  s.linear.setup_seconds += other.linear.setup_seconds;
  s.linear.solve_seconds += other.linear.solve_seconds;
}

} // namespace rpc::analysis
