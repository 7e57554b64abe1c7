// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/load_history.hpp"

#include "body/obstacle_force.hpp"
#include "rpc/analysis/quantities.hpp"
#include "rpc/analysis/side_displacements.hpp"
#include "rpc/contact/node_columns.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/timed.hpp"
#include "rpc/fem/rounding.hpp"
#include "step/step_dents.hpp"
#include "step/step_energies.hpp"

#include <Teuchos_Time.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>
#include <utility>

namespace rpc::analysis
{
namespace
{

/// Zero start, for solutions small against the rounding of the last step.
contact::ContactState at_rest(const contact::ContactNodes &points, const fem::Discretization &d)
{
  return {rcp(new Vector(d.owned_dofs)), DeviceView<double *>("rpc::analysis::no_pressure", points.size()), {}};
}

int newton_steps(const StepSolution &s)
{
  return std::accumulate(s.uzawa.newton_iterations.begin(), s.uzawa.newton_iterations.end(), 0);
}

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

Energies unknown_energies()
{
  Energies energies;
  for (const auto &q : energy_quantities) energies.*q.value = unknown;
  return energies;
}

/// Adds what solving a part of a step took.
void add_work(const StepSolution &s, StepRecord &record)
{
  record.newton_iterations += newton_steps(s);
  record.linear_solves += static_cast<int>(s.linear.iterations.size());
  record.linear_iterations =
      std::accumulate(s.linear.iterations.begin(), s.linear.iterations.end(), record.linear_iterations);
  record.preconditioner_setups += s.linear.preconditioner_setups;
  record.from_rest = record.from_rest || s.from_rest;
}

/// Where a step to time t was divided in vain, and had come nearer to a solution as a whole than its part that failed, the reasons of both: the
/// remedy of the former may be the better one.
void tell_what_came_nearer(const UzawaResult &undivided, const double t, UzawaResult &part)
{
  if (!(undivided.residuals.worst() < part.residuals.worst()) || undivided.reason == part.reason) return;
  std::ostringstream reason;
  reason << part.reason << "; undivided, the step to t = " << t << " ended nearer to a solution: " << undivided.reason;
  part.reason = reason.str();
}

} // namespace

double relative_imbalance(const Energies &before, const Energies &after)
{
  const double change = std::abs(after.imbalance - before.imbalance);
  return change == 0 ? 0 : change / std::max(before.largest(), after.largest());
}

StepRecord broken_off(const Model &model, StepRecord until_then, const double t, const std::string &reason)
{
  StepRecord record = std::move(until_then);
  record.time = t;
  record.converged = false;
  record.reason = reason;
  record.energies = unknown_energies();
  for (const auto &q : contact::contact_quantities) record.contact.*q.value = unknown;
  for (const auto &q : body_quantities) record.body.*q.value = unknown;
  for (const auto &q : contact::patch_quantities) record.patches.*q.value = unknown;
  record.contact.force.fill(unknown);
  std::array<double, 3> vector{};
  vector.fill(unknown);
  record.side_forces.assign(model.contact.size(), vector);
  record.obstacle = vector;
  record.displacements.assign(model.dirichlet.size(), vector);
  record.reactions = record.displacements;
  fem::SixNumbers motions{};
  motions.fill(unknown);
  const auto is_rigid = [](const auto &condition) { return condition.rigid.has_value(); };
  record.rigid_motions.assign(std::count_if(model.dirichlet.begin(), model.dirichlet.end(), is_rigid), motions);
  record.rigid_forces = record.rigid_motions;
  return record;
}

LoadHistory::LoadHistory(std::shared_ptr<const Problem> problem, StepOptions options, const int max_halvings,
                         const solver::LinearSolverOptions &linear, Predictor predictor)
    : problem_(std::move(problem)), options_(std::move(options)), max_halvings_(max_halvings), linear_(linear),
      state_(std::make_unique<SolverState>(*problem_, linear_)), predictor_(std::move(predictor))
{
}

LoadHistory::LoadHistory(std::shared_ptr<const Problem> problem, const StepOptions &options, const int max_halvings,
                         const solver::LinearSolverOptions &linear, const CoarserProblem &coarser)
    : LoadHistory(std::move(problem), options, max_halvings, linear, Predictor(coarser, options, linear))
{
}

void LoadHistory::go_on_from(Memory memory, std::optional<Memory> before)
{
  kept_.memory = std::move(memory);
  kept_.before = std::move(before);
  kept_.last_forces = Teuchos::null;
}

void LoadHistory::start_anew()
{
  kept_.last_forces = Teuchos::null;
  state_.reset(); // two hierarchies would take twice the memory
  state_ = std::make_unique<SolverState>(*problem_, linear_);
  predictor_.forget();
}

StepSolution LoadHistory::advance(const double t, const Progress &progress,
                                  const std::function<void(const Problem &, const Step &)> &now)
{
  const double start = Teuchos::Time::wallTime();
  last_ = {};
  last_.time = t;
  kept_.whole_step = {};
  const Remembered before = kept_;
  const Energies energies_before = kept_.memory ? kept_.memory->energies : Energies{};
  StepSolution s;
  double tolerance = energy_tolerance_;
  Headway attempts({headway_rules.falls, 0, Headway::unlimited, step_rules.most_attempts - 1});
  while (true) {
    last_.parts = 0; // counted as they are solved
    last_.from_rest = false;
    s = advance_in_parts(t, {max_halvings_, balance_halvings_, std::max(max_halvings_, balance_halvings_), tolerance},
                         progress, now);
    const double off = s.uzawa.converged ? share_missed(energies_before, s, energy_tolerance_) : 0;
    if (!(off > energy_tolerance_) || last_.parts == 1 || attempts.add(off) == Headway::Answer::stuck) break;
    tolerance *= step_rules.part_of_tolerance * energy_tolerance_ / off; // what parts miss adds up
    kept_ = before;                                                      // as if what came after had not been tried
  }
  last_.time = s.uzawa.converged ? t : tried_;
  last_.converged = s.uzawa.converged;
  if (last_.converged) {
    if (last_.parts > 1) kept_.whole_step.take(problem_->discretization().mesh->comm(), s.step.contact, s.contact);
    last_.contact = s.contact.total;
    for (const auto &side : s.contact.sides) last_.side_forces.push_back(side.force);
    last_.patches = contact::counted(contact::contact_patches(*problem_->discretization().mesh,
                                                              problem_->contact_sides(), s.step.contact, s.contact));
    last_.body = fem::body_peaks(problem_->discretization(), problem_->model().materials, *s.u);
    last_.displacements = held_displacements(*problem_, *s.u);
    last_.rigid_motions = s.rigid_motions;
    last_.rigid_forces = s.rigid_forces;
    const auto &rigid = s.step.elastic.dirichlet.rigid;
    for (std::size_t j = 0; j < rigid.size(); ++j)
      std::copy_n(s.rigid_motions[j].begin(), 3, last_.displacements[rigid[j].condition].begin());
    last_.reactions = s.reactions;
    last_.obstacle = obstacle_displacement(problem_->model(), t, s.step.obstacle);
    last_.energies = kept_.memory->energies;
  } else {
    last_ = broken_off(s.uzawa.reason);
  }
  last_.seconds = Teuchos::Time::wallTime() - start;
  return s;
}

/// relative_imbalance() of a step that is remembered; 0 where one above the tolerance is rounding of the energies.
double LoadHistory::share_missed(const Energies &before, const StepSolution &s, const double tolerance) const
{
  const Energies &now = kept_.memory->energies;
  const double share = relative_imbalance(before, now);
  if (!(share > tolerance)) return share;
  const double rounding = fem::rounding_energy(problem_->discretization(), problem_->model().materials, *s.u);
  return std::abs(now.imbalance - before.imbalance) > rounding ? share : 0;
}

StepRecord LoadHistory::broken_off(const std::string &reason) const
{
  return analysis::broken_off(problem_->model(), last_, tried_, reason);
}

StepSolution LoadHistory::advance_in_parts(const double t, const Halvings &left, const Progress &progress,
                                           const std::function<void(const Problem &, const Step &)> &now)
{
  const Remembered before = kept_;
  const bool from_rest_before = last_.from_rest;
  StepOptions options = options_;
  options.low_penalties = left.failures == 0;         // what else could be tried is to halve the step
  options.from_rest = left.failures == max_halvings_; // parts of a step that failed have solutions near by
  StepSolution s = solve(t, options, progress, now);
  const double from = before.memory ? before.memory->time : time_at_rest(t);
  const double half = 0.5 * (from + t);
  Halvings then = left;
  const bool may_halve = then.all-- > 0;
  if (s.uzawa.converged) {
    const Energies start = before.memory ? before.memory->energies : Energies{}, &end = kept_.memory->energies;
    const auto answer = then.headway.add(std::abs(end.imbalance - start.imbalance));
    if (!(share_missed(start, s, left.tolerance) > left.tolerance) || !may_halve || answer == Headway::Answer::stuck ||
        then.balance-- == 0)
      return s;
  } else if (!may_halve || then.failures-- == 0 || interrupted(problem_->discretization().mesh->comm())) {
    return s;
  }
  if (!(half > from && half < t)) return s;
  if (s.uzawa.converged) {
    --last_.parts;
    last_.from_rest = from_rest_before;
    kept_ = before; // as if what came after had not been tried
  }
  std::optional<UzawaResult> undivided;
  if (!s.uzawa.converged && left.failures == max_halvings_) undivided = s.uzawa;
  s = advance_in_parts(half, then, progress, now);
  if (s.uzawa.converged) {
    if (progress.part) progress.part(*problem_, s);
    s = advance_in_parts(t, then, progress, now);
  }
  if (undivided && !s.uzawa.converged && !interrupted(problem_->discretization().mesh->comm()))
    tell_what_came_nearer(*undivided, t, s.uzawa);
  return s;
}

namespace
{

/// Whether a force moves an obstacle whose gap is not linear in how far it has moved.
bool bends(const Model &model)
{
  const contact::ContactOptions *const pressed = pressed_by_force(model);
  return pressed != nullptr && !pressed->obstacle.surface->is_flat;
}

/// Of a search that is only to find where the next one is to look.
StepOptions to_look_further(StepOptions options)
{
  double &tolerance = options.uzawa.tolerance, &residual = options.newton.residual_tolerance;
  tolerance = std::max(tolerance, options.prediction.tolerance);
  residual = std::max(residual, options.prediction.tolerance);
  options.looks_between_nodes = false;
  return options;
}

/// How far the obstacle would go on, the other way round, were it to move as in the last step.
Point further_by(const Memory &last, const Memory &before, const double t)
{
  return scaled((t - last.time) / (last.time - before.time), difference(before.obstacle, last.obstacle));
}

/// Adds what the searches before have taken and shown.
void add_searched(const StepSolution &before, StepSolution &s)
{
  auto newton = before.uzawa.newton_iterations; // the first ones first
  newton.insert(newton.end(), s.uzawa.newton_iterations.begin(), s.uzawa.newton_iterations.end());
  analysis::add_work(before, s);
  s.uzawa.newton_iterations = std::move(newton);
  s.levels = before.levels;
  s.not_predicted = before.not_predicted;
  s.found_by = std::max(s.found_by, before.found_by);
  s.start = before.start;
  s.from_rest = s.from_rest || before.from_rest;
  s.raised_penalties = before.raised_penalties;
}

/// Searches for the obstacle have not ended. @param jumps  whether the force that it takes jumps at the place that they have come down to
void give_up_search(const Point &way, const bool jumps, StepSolution &s)
{
  s.uzawa.converged = false;
  std::ostringstream reason;
  reason << "the obstacle that a force or a spring moves does not come to rest: "
         << (jumps ? "the force that it takes jumps at one place, as at a kink of its surface"
                   : "of " + std::to_string(step_rules.most_attempts) + " searches none has brought it nearer")
         << ", and the last search has moved it by " << length(way);
  s.uzawa.reason = reason.str();
}

} // namespace

StepSolution LoadHistory::solve(const double t, const StepOptions &options, const Progress &progress,
                                const std::function<void(const Problem &, const Step &)> &now)
{
  tried_ = t;
  const Model &model = problem_->model();
  const bool by_force = pressed_by_force(model) != nullptr;
  const bool on_foundation = kept_.memory && contact::any_moves_with_foundation(model.contact);
  const auto met_at = [&](const Vector &u, const Point &obstacle) {
    return contact::dents_met(problem_->discretization(), model.seen_at(t, obstacle).contact, kept_.memory->dent,
                              kept_.memory->foundations, u);
  };
  RCP<const MultiVector> met = kept_.memory ? kept_.memory->dent : Teuchos::null;
  if (on_foundation) met = met_at(moved_along(*problem_, t, *kept_.memory->displacement), kept_.memory->obstacle);
  std::optional<Offered> offered = std::exchange(offered_, std::nullopt);
  const bool finds_obstacle = by_force && !offered;
  Step step = problem_->step(t, met.get(), memory(), by_force && offered ? &offered->obstacle : nullptr);
  if (now) now(*problem_, step);
  Starts starts = starts_of(step, std::move(offered));
  Progress reports = progress;
  double prediction_seconds = 0;
  if (by_force) {
    if (reports.start) reports.start(*problem_, step);
    reports.start = {};
  }
  if (finds_obstacle) {
    const Timed timer("prediction", prediction_seconds);
    foresee(met.get(), step, starts);
  }
  ++last_.parts;
  StepSolution s;
  std::optional<StepSolution> searched; // what the searches before have taken
  Point way_before{};
  ObstaclePlaces places;
  Headway searches({1, Headway::unlimited, Headway::unlimited, step_rules.most_attempts - 1});
  Headway ways({headway_rules.falls, Headway::unlimited, step_rules.most_attempts - 1}); // of the obstacle, which fall
  while (true) {
    const bool is_rough = !searched && bends(model);
    starts.may_rest = by_force && !is_rough && !on_foundation;
    starts.led_before = way_before;
    StepOptions of_search = is_rough ? to_look_further(options) : options;
    of_search.starts_near = searched.has_value();
    if (bends(model) && !on_foundation) of_search.on_the_way = options.prediction.tolerance;
    s = solve_step(*problem_, step, *state_, of_search, starts, reports);
    ++last_.solves;
    add_work(s, last_);
    s.prediction_seconds += std::exchange(prediction_seconds, 0);
    const Point way = left_to_go(*problem_, s), seen = s.step.obstacle, place = places.next(seen, way);
    const bool rounds = searched && length(way) >= length(way_before);
    const double of_rounding = step_rules.of_rounding * options.uzawa.tolerance;
    const bool rests = !is_rough && obstacle_rests(*problem_, s, rounds ? of_rounding : options.uzawa.tolerance);
    const double least = options.uzawa.tolerance * s.u->normInf(), step_to_next = length(difference(place, seen));
    const bool jumps = length(way) > least && !(step_to_next > least); // halfway between two places is as good as there
    if (by_force) take_to_obstacle(way, s);
    if (searched) add_searched(*searched, s);
    if (!s.uzawa.converged) return s;
    if ((!on_foundation && rests) || (!rests && jumps) ||
        (by_force ? ways.add(step_to_next) : searches.take(true)) == Headway::Answer::stuck) {
      if (!rests) give_up_search(way, jumps, s);
      break;
    }
    const auto next = on_foundation ? met_at(*s.u, s.step.obstacle) : met;
    if (rests && (!on_foundation || settled(*met, *next, kept_.memory->foundations, of_rounding))) break;
    met = next;
    step = problem_->step(t, met.get(), memory(), by_force ? &place : nullptr);
    starts = {{onto(s.step.contact, step.contact, s.state)}, {}};
    if (by_force) searched = s;
    way_before = way;
  }
  if (s.uzawa.converged) remember(t, model.seen_at(t, s.step.obstacle).contact, step, s);
  return s;
}

/// Asks coarser meshes how far a force will have moved its obstacle, and makes the step there.                    (3.17c)
void LoadHistory::foresee(const MultiVector *const met, Step &step, Starts &starts)
{
  if (!starts.predict) return;
  Prediction predicted = starts.predict();
  if (predicted.start) {
    const Point way = difference(predicted.obstacle, step.obstacle);
    const contact::ContactNodes points = step.contact;
    step = problem_->step(step.time, met, memory(), &predicted.obstacle);
    const int dim = problem_->discretization().dim();
    for (auto &state : starts.states) state = onto(points, step.contact, shifted(std::move(state), way, dim));
    predicted.start = onto(points, step.contact, *std::move(predicted.start));
  }
  starts.predict = [predicted] { return predicted; };
}

/// A state at the contact points of another place of the obstacle.
contact::ContactState LoadHistory::onto(const contact::ContactNodes &from, const contact::ContactNodes &to,
                                        contact::ContactState state) const
{
  if (pressed_by_force(problem_->model()) == nullptr) return state;
  const auto owned_nodes = problem_->discretization().mesh->owned_nodes;
  auto &multiplier = state.multiplier;
  multiplier.normal = contact::at_points(to, *contact::node_columns(from, multiplier.normal, owned_nodes));
  if (max_all(problem_->discretization().mesh->comm(), static_cast<int>(multiplier.has_tangential())) > 0)
    multiplier.tangential =
        contact::vectors_at_points(to, *contact::node_columns(from, multiplier.tangential, owned_nodes));
  state.active_set = {};
  return state;
}

/// The solution, seen from where the body is held, and the obstacle where that has led it.
void LoadHistory::take_to_obstacle(const Point &way, StepSolution &s) const
{
  for (int c = 0; c < 3; ++c) s.step.obstacle[c] += way[c];
  s.state = shifted(std::move(s.state), way, problem_->discretization().dim());
  s.u = s.state.displacement;
}

/// What is offered, the last state, the extrapolated one, rest, and what coarser meshes predict; without a last state the first or the latter alone.
Starts LoadHistory::starts_of(const Step &step, std::optional<Offered> offered)
{
  Starts starts;
  const bool has_place = pressed_by_force(problem_->model()) != nullptr && offered;
  if (kept_.memory) {
    starts.states.push_back(state_of(step.contact, *kept_.memory));
    if (kept_.before && kept_.before->time < kept_.memory->time) {
      auto later = extrapolated(step.contact, *kept_.before, *kept_.memory, step.time);
      if (pressed_by_force(problem_->model())) // seen from where the obstacle was in the last step
        later = shifted(std::move(later), further_by(*kept_.memory, *kept_.before, step.time),
                        problem_->discretization().dim());
      starts.states.push_back(std::move(later));
    }
    starts.states.push_back(at_rest(step.contact, problem_->discretization()));
    if (has_place)
      for (auto &state : starts.states)
        state = shifted(std::move(state), difference(step.obstacle, kept_.memory->obstacle),
                        problem_->discretization().dim());
  }
  if (offered) starts.states.insert(starts.states.begin(), std::move(offered->start));
  if (!has_place && (kept_.memory || starts.states.empty()))
    starts.predict = [this, &step] { return predictor_.predict(*problem_, step, memory()); };
  return starts;
}

void LoadHistory::remember(const double t, const std::vector<contact::ContactOptions> &sides, const Step &step,
                           StepSolution &s)
{
  const auto owned_nodes = problem_->discretization().mesh->owned_nodes;
  const auto forces = rcp(new Vector(other_forces(*problem_, s)));
  Memory now;
  remember_dents(*problem_, sides, step.contact, memory(), s, now);
  now.time = t;
  now.displacement = s.u;
  if (step.contact.friction.anywhere) now.displacement = contact::on_foundation(step.contact, s.state); // (12.14)
  now.obstacle = s.step.obstacle;
  now.pressure = contact::node_columns(step.contact, s.contact.pressure, owned_nodes);
  now.gap = contact::node_columns(step.contact, moving_gap(*problem_, step.contact, s.contact.dent), owned_nodes);
  now.energies = energies_after(*problem_, t, s, memory(), kept_.last_forces.get(), *forces);
  const double tolerance = options_.uzawa.tolerance,
               rounding = fem::rounding_energy(problem_->discretization(), problem_->model().materials, *s.u);
  now.energy_scale =
      std::max({step.energies_before, now.energies.strain, rounding / (tolerance * tolerance)}); // (5.5b)
  if (max_all(problem_->discretization().mesh->comm(), static_cast<int>(s.state.multiplier.has_tangential())) > 0)
    now.tangential = contact::node_columns(step.contact, s.state.multiplier.tangential, owned_nodes);
  kept_.whole_step.add(step.contact, s.contact, owned_nodes);
  kept_.before = std::exchange(kept_.memory, std::move(now));
  kept_.last_forces = forces;
}

} // namespace rpc::analysis
