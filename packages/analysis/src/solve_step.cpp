/// The algorithm, from top to bottom: solve_step() predicts (predict) and alternates (uzawa) the minimization of the smoothed
/// functional, whose first steps choose the active set (ActiveSetStage) before Newton's with their exact line search follow,
/// with updates of the multipliers, until the optimality residuals are small. Equation numbers are those of doc/theory.md.
#include "rpc/analysis/solve_step.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/timed.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace rpc::analysis
{

using contact::OptimalityResiduals;
using contact::SmoothedFunctional;
using solver::NewtonGroup;

namespace
{

// Below, a solution costs about as much as its prediction.
constexpr std::size_t least_nodes_predicted = 500;
// Steps on a coarser mesh: with rough solves there they cost no more than a few elastic solves of the finer one, and what they
// lead to is a start in any case.
constexpr int most_steps_predicting = 40;

constexpr int most_changes = 10;         // of the active set; then Newton with its sweep needs fewer steps
constexpr int most_changes_resumed = 30; // where it creeps: on slender bodies the choices get there in the end
// While the active set changes, solves bring the residual below this part of what it was, and of the load: three to five CG
// iterations. With 1e-1 pressures are too rough to choose by, 1e-4 saves no step. What the multipliers of the last rough
// solve miss, the penalty leaves a part of, k/r, in the final pressures: some 1e-8 of them.
constexpr double forcing = 5e-3;
constexpr int most_updates = 2;     // of multipliers at the end, even if pressures miss their tolerance then
constexpr double enough = 0.3;      // of the tolerance: recomputed residuals are a little larger than CG's
constexpr double negligible = 1e-3; // of the tolerance of pressures: violations that change no state

// A start out of balance by less than this part of the load, and off the contact law by less than this part of the pressure, needs
// no coarser mesh: states hardly change from there.
constexpr double near_equilibrium = 1e-7;

constexpr double fast = 0.1; // an update that leaves more of the largest residual calls for a higher penalty

/// A step of a problem with all that changes while it is solved.
struct Iterate {
  const Problem &problem;
  std::shared_ptr<SmoothedFunctional> functional;
  RCP<Vector> u; // (owned dofs) [m]

  Iterate(const Problem &of, const Step &step)
      : problem(of), functional(std::make_shared<SmoothedFunctional>(step.elastic, step.contact, of.hessian())),
        u(rcp(new Vector(*step.elastic.dirichlet.value, Teuchos::Copy)))
  {
    if (step.support.by_contact_only) functional->hold_by_contact();
  }
  const fem::Discretization &discretization() const { return problem.discretization(); }
  solver::LinearSolver &linear() const { return problem.linear_solver(); }
};

std::string predict(Iterate &iterate, double t, const StepOptions &options, const CoarserProblem &coarser, int level,
                    std::vector<LevelWork> &work);
Minimization minimize(const Iterate &iterate, const StepOptions &options, int iteration,
                      const solver::NewtonReport &report);

/// Forces with which the Dirichlet conditions hold the body. (2.11)
std::vector<std::array<double, 3>> reactions(const Problem &problem, const StepSolution &s)
{
  const fem::ElasticProblem &elastic = s.step.elastic;
  const fem::Discretization &d = problem.discretization();
  Vector out_of_balance(*s.uzawa.residuals.internal.forces, Teuchos::Copy);
  out_of_balance.update(-1., *elastic.applied_load, -1., contact::contact_forces(d, s.step.contact, s.contact), 1.);
  return fem::reaction_forces(d, elastic.dirichlet, static_cast<int>(problem.model().dirichlet.size()), out_of_balance);
}

/// Starts from the state whose displacement and multipliers are nearest to equilibrium, or from what is predicted where that is far.
void start_from_nearest(SmoothedFunctional &functional, const Starts &starts, Vector &u, std::vector<LevelWork> &work)
{
  const Vector rest(u, Teuchos::Copy);
  const auto take = [&](const contact::ContactState &state) {
    u.assign(rest);
    functional.start_from(state, u);
  };
  const std::vector<contact::ContactState> &states = starts.states;
  if (states.size() == 1 && !starts.predicted) return take(states[0]); // nothing to choose
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  Vector F(u.getMap());
  for (std::size_t k = 0; k < states.size(); ++k) {
    take(states[k]);
    functional.elastic_gradient(u, F);
    F.update(1., functional.multiplier_forces(), 1.);
    fem::clear_prescribed(functional.problem().dirichlet, F);
    const double out_of_balance = F.norm2();
    most = std::max(most, out_of_balance);
    if (!(out_of_balance < least)) continue;
    least = out_of_balance;
    nearest = k;
  }
  if (nearest + 1 < states.size()) take(states[nearest]);
  if (starts.predicted && (least > near_equilibrium * std::max(functional.force_scale(), most) ||
                           functional.contact_law_residual(u) > near_equilibrium))
    if (const auto predicted = starts.predicted(work)) take(*predicted);
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

// The step ------------------------------------------------------------------------------------------------------------

StepSolution solve_step(const Problem &problem, const Step &step, const StepOptions &options, const Starts &starts,
                        const CoarserProblem &coarser, const Progress &progress)
{
  StepSolution s;
  s.step = step;
  Iterate iterate(problem, step);
  SmoothedFunctional &functional = *iterate.functional;
  s.u = iterate.u;
  const auto before = iterate.linear().counts();
  solver::check_nox_parameters(functional, iterate.linear(), s.u, options.newton);
  {
    const Timed timer("prediction", s.prediction_seconds);
    if (!starts.states.empty())
      start_from_nearest(functional, starts, *s.u, s.levels);
    else
      s.not_predicted = predict(iterate, step.time, options, coarser, 1, s.levels);
  }
  {
    const Timed timer("solve", s.solve_seconds);
    const fem::Discretization &d = problem.discretization();
    const auto minimization = [&](const int iteration) {
      const auto report = [&](const solver::NewtonStep &newton, const Vector &u) {
        if (progress.newton) progress.newton(iteration, newton, functional.count_states(u));
      };
      const Minimization found = minimize(iterate, options, iteration, report);
      s.line_search_steps += found.line_search_steps;
      return found;
    };
    const auto residuals = [&](const Vector &u) {
      return contact::optimality_residuals(d, problem.model().materials, functional, u, [&](const Vector &residual) {
        return iterate.linear().inverse_energy(residual);
      });
    };
    const auto report = [&](const UzawaResult &result) {
      if (progress.uzawa) progress.uzawa(result);
    };
    s.uzawa = uzawa(functional, *s.u, minimization, residuals, options.uzawa, report);
    s.contact = contact::contact_result(d, problem.contact_sides(), functional, *s.u);
    s.energy = functional.energy(*s.u);
    s.energy_norm_squared = s.uzawa.residuals.internal.energy_norm_squared;
    s.reactions = reactions(problem, s);
    s.state = functional.current(s.u);
  }
  s.linear = counts_since(before, iterate.linear().counts());
  s.solve_seconds -= s.linear.setup_seconds;
  return s;
}

// Prediction: the solution on a coarser mesh, which a still coarser one predicts ------------------------------------------

std::string no_prediction(const fem::Discretization &d, const contact::ContactNodes &contact,
                          const PredictionOptions &options)
{
  if (contact.num_total == contact.num_fixed) return "no node can touch";
  if (!options.enabled) return "switched off";
  if (d.mesh->owned_nodes->getGlobalNumElements() < least_nodes_predicted) return "the mesh is small";
  return "";
}

namespace
{

/// Starts an iterate from the solution on a coarser mesh. Nothing is lost where that fails.
/// @return why it did; empty if it did not
std::string predict(Iterate &iterate, const double t, const StepOptions &options, const CoarserProblem &coarser,
                    const int level, std::vector<LevelWork> &work)
{
  std::string reason = no_prediction(iterate.discretization(), iterate.functional->contact(), options.prediction);
  if (!reason.empty()) return reason;
  try {
    const double start = Teuchos::Time::wallTime();
    const auto problem = coarser ? coarser(iterate.problem, level) : nullptr;
    if (!problem) return "a mesh from a file cannot be made coarser";
    Iterate coarse(*problem, problem->step(t));
    predict(coarse, t, options, coarser, level + 1, work);
    StepOptions rough = options;
    rough.newton.residual_tolerance = options.prediction.tolerance;
    rough.newton.max_iterations = std::min(options.newton.max_iterations, most_steps_predicting);
    const Minimization found = minimize(coarse, rough, 1, [](const solver::NewtonStep &, const Vector &) {});
    if (!found.active_set_confirmed) coarse.functional->update_multipliers(*coarse.u);
    const auto way = interpolation(problem->mesh(), iterate.problem.mesh());
    const contact::ContactNodes &points = coarse.functional->contact();
    const auto state = contact::with_weightless(
        coarse.functional->current(rcp(new Vector(coarse.functional->displacement(*coarse.u), Teuchos::Copy))), points,
        coarse.discretization(), problem->contact_sides());
    const auto predicted =
        contact::interpolated(*way, points, state, iterate.functional->contact(), iterate.discretization().owned_dofs);
    iterate.functional->start_from(predicted, *iterate.u);
    const auto &counts = coarse.linear().counts();
    work.push_back({coarse.discretization().owned_dofs->getGlobalNumElements(), found.steps, counts.iterations,
                    counts.preconditioner_setups, Teuchos::Time::wallTime() - start});
  } catch (const Error &failure) { // an interrupt too: the finest mesh is where a run stops with what it has found
    return one_line(failure.what());
  }
  return "";
}

} // namespace

// Uzawa: minimization and multiplier update in turns ---------------------------------------------------------------------

namespace
{

std::string verdict(const UzawaResult &result, const UzawaOptions &options)
{
  std::ostringstream text;
  const OptimalityResiduals &r = result.residuals;
  text << (result.converged ? "converged" : std::to_string(result.iterations) + " Uzawa iterations were not enough")
       << ": KKT residual " << r.kkt_residual << ", equilibrium residual " << r.equilibrium_residual
       << ", energy balance " << r.energy_balance << ", duality gap " << r.duality_gap << ", tolerance "
       << options.tolerance;
  return text.str();
}

} // namespace

UzawaResult uzawa(SmoothedFunctional &functional, Vector &u, const std::function<Minimization(int)> &minimize,
                  const std::function<OptimalityResiduals(const Vector &)> &residuals, const UzawaOptions &options,
                  const std::function<void(const UzawaResult &)> &report)
{
  UzawaResult result;
  bool stop = false;
  while (!stop && result.iterations < options.max_iterations) {
    // The remaining correction is small against u: solving for it from where u is keeps its relative accuracy. (5.13)
    if (result.iterations > 0) functional.move_origin(u);
    const Minimization inner = minimize(result.iterations + 1); // u <- argmin M(u; lambda)                        (4.1)
    result.newton_iterations.push_back(inner.steps);
    ++result.iterations;
    result.multiplier_change = inner.active_set_confirmed
                                   ? functional.take_active_set_pressures(u)
                                   : functional.update_multipliers(u); // lambda <- Psi'(v)  (5.1)
    const OptimalityResiduals previous = result.residuals;
    result.residuals = residuals(functional.displacement(u)); // (5.2), (5.3), (5.4), (5.5)
    const bool holds = result.residuals.holds(options.tolerance);
    const bool changes = result.multiplier_change >= options.tolerance;
    stop = holds && (options.test == UzawaTest::optimality || !changes);
    report(result);
    if (holds) continue;
    if (interrupted(*u.getMap()->getComm())) {
      result.reason = interruption() + " in Uzawa iteration " + std::to_string(result.iterations);
      break;
    }
    const bool slow = result.iterations > 1 && !(result.residuals.worst() <= fast * previous.worst());
    const bool raised = slow && functional.raise_penalty(); // (5.12)
    // A minimization that stopped at the rounding of an ill-conditioned scene is good enough to go on from, while that helps.
    if ((slow && !raised) || std::isnan(result.residuals.worst())) {
      result.reason = inner.converged
                          ? verdict(result, options) + ": more iterations do not help, what remains is rounding"
                          : inner.reason;
      break;
    }
  }
  u.assign(functional.displacement(u));
  result.converged = stop;
  if (stop || result.reason.empty()) result.reason = verdict(result, options);
  return result;
}

// Minimization: one NOX solver for the active-set steps and Newton's -----------------------------------------------------

namespace
{

Minimization minimize(const Iterate &iterate, const StepOptions &options, const int iteration,
                      const solver::NewtonReport &report)
{
  SmoothedFunctional &functional = *iterate.functional;
  const auto run = [&](solver::FirstStage &stage) {
    return solver::minimize(functional, iterate.linear(), iterate.u, functional.force_scale(), options.newton, &stage,
                            report);
  };
  if (iteration > 1) {
    SameActiveSet stage(functional);
    const auto result = run(stage);
    return {result.converged, result.steps, result.reason, false, result.steps};
  }
  ActiveSetStage stage(functional, active_set_tolerances(options));
  const auto result = run(stage);
  return {result.converged, result.steps, result.reason, stage.confirmed(), result.steps - stage.steps()};
}

} // namespace

// The active set: chosen by the last pressures, until a choice confirms itself --------------------------------------------

ActiveSetStage::ActiveSetStage(SmoothedFunctional &functional, const ActiveSetTolerances &tolerances)
    : functional_(functional), scale_(functional.force_scale()), target_(tolerances.residual * scale_),
      pressure_tolerance_(tolerances.pressure), start_(functional.hessian()->getDomainMap()),
      rough_(functional.contact().num_total > functional.contact().num_fixed), // else there is no state to choose
      most_changes_(most_changes)
{
}

bool ActiveSetStage::resume(const NewtonGroup &from)
{
  if (std::exchange(resumed_, true)) return false;
  const Vector &u = solver::tpetra(from.getX());
  functional_.update_hessian(u); // the states there
  start_.assign(u);
  seen_.clear();
  choice_.reset();
  norm_ = before_ = confirmed_norm_ = std::numeric_limits<double>::infinity();
  changes_ = updates_ = 0;
  most_changes_ = most_changes_resumed;
  rough_ = false; // a small residual may be all of the bending
  decided_ = false;
  return true;
}

/// What becomes of the iteration at a point, after the step that led there.
ActiveSetStage::Verdict ActiveSetStage::choose(const Vector &u)
{
  choice_ = functional_.choose_active_set(u, negligible * pressure_tolerance_); // (5.8)
  // Nothing touches, as far as is known: one solve, for CG in one go keeps the energy balance to rounding.
  if (choice_->changes == 0 && steps_ == 0) rough_ = false;
  if (choice_->confirmed) {
    const bool solved_well = norm_ <= target_;
    confirmed_ =
        solved_well && (functional_.pressure_error(u) <= pressure_tolerance_ || ++updates_ > most_updates); // (5.10)
    // Rounding may end progress below: where the foundation's forces are many times the load, F grows and falls with each step.
    const bool stalled = !rough_ && !solved_well && !(norm_ < 0.5 * std::min(before_, confirmed_norm_));
    if (!rough_) confirmed_norm_ = norm_;
    if (confirmed_) return Verdict::converged;
    if (stalled) return Verdict::over;
    rough_ = false;
  } else if (!seen_.insert(choice_->fingerprint).second || ++changes_ > most_changes_) {
    return Verdict::over; // in circles, or too slow
  } else if (steps_ == 1) {
    rough_ = true; // it touches after all
  }
  return Verdict::go_on;
}

ActiveSetStage::Verdict ActiveSetStage::judge(const NewtonGroup &at)
{
  if (decided_) return confirmed_ ? Verdict::converged : Verdict::over;
  const Vector &u = solver::tpetra(at.getX());
  if (steps_ == 0) {
    start_.assign(u);
  } else {
    Vector F(u.getMap());
    functional_.active_set_gradient(u, solver::tpetra(at.getF()), F); // (5.6)
    norm_ = F.norm2();
  }
  return choose(u);
}

ActiveSetStage::Step ActiveSetStage::propose(NewtonGroup &group, Vector &direction)
{
  if (!choice_ && judge(group) != Verdict::go_on) return Step::none; // a user's status tests do not ask for the verdict
  auto u = rcp(new Vector(solver::tpetra(group.getX()), Teuchos::Copy));
  const auto move_to = [&] {
    group.setX(solver::NoxVector(u));
    group.computeF();
  };
  Vector F(u->getMap());
  while (true) {
    functional_.take_active_set(*choice_, *u); // (5.7)
    choice_.reset();
    move_to();
    functional_.active_set_gradient(*u, solver::tpetra(group.getF()), F);
    before_ = norm_ = F.norm2();
    if (norm_ > target_) break;
    const Verdict verdict = choose(*u); // nothing to solve for: the next choice
    if (verdict == Verdict::go_on) continue;
    decided_ = true;
    direction.putScalar(0);
    return verdict == Verdict::converged ? Step::full : Step::none;
  }
  if (!rough_) { // the remaining correction is small against u: solving for it keeps its relative accuracy       (5.13)
    functional_.move_origin(*u);
    start_.putScalar(0);
    move_to();
  }
  u = Teuchos::null; // a solve needs the memory
  const double needed = std::max(enough * target_, rough_ ? forcing * std::min(scale_, norm_) : 0.);
  const auto solved = solver::solve_for_direction(group.context(), F, direction, needed / norm_); // (5.9)
  if (!solved.converged) { // an active set that leaves the body unheld, or an interrupt
    if (!solved.interrupted) {
      u = rcp(new Vector(start_, Teuchos::Copy));
      functional_.reset_multipliers();
      move_to();
    }
    return Step::none;
  }
  direction.scale(-1.);
  ++group.context().steps;
  ++steps_;
  return Step::full;
}

// After a multiplier update -----------------------------------------------------------------------------------------------

SameActiveSet::Verdict SameActiveSet::judge(const NewtonGroup &at)
{
  return proposed_ || at.getNormF() <= at.context().target_residual ? Verdict::over : Verdict::go_on;
}

SameActiveSet::Step SameActiveSet::propose(NewtonGroup &group, Vector &direction)
{
  if (std::exchange(proposed_, true)) return Step::none;
  const Vector &F = solver::tpetra(group.getF());
  Vector G(F.getMap());
  functional_.active_set_gradient(solver::tpetra(group.getX()), F, G); // (5.6)
  const auto solved =
      solver::solve_for_direction(group.context(), G, direction, 0.1 * group.context().target_residual / G.norm2());
  if (!solved.converged || !(direction.dot(F) > 0)) return Step::none;
  direction.scale(-1.);
  ++group.context().steps;
  return Step::search;
}

} // namespace rpc::analysis
