// SPDX-License-Identifier: BSD-3-Clause
#include "earlier_steps.hpp"
#include "guide.hpp"
#include "motions.hpp"
#include "next_mesh.hpp"
#include "rpc/adapt/solve.hpp"
#include "rpc/analysis/run_steps.hpp"
#include "rpc/bound/rules.hpp"
#include "rpc/contact/clearance.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/timed.hpp"

#include <Teuchos_Time.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace rpc::adapt
{
namespace
{

/// a(u, u) of the solution, with what unseen contact would add: without any contact that is seen there may be nothing else [J]. (10.4b)
double estimated_energy(const Solution &s)
{
  return s.energy_norm_squared + s.estimate->unseen();
}

/// The estimate of a displacement that is no solution.
ErrorEstimate unknown_estimate()
{
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  ErrorEstimate estimate;
  estimate.parts = {{"recovery", unknown},
                    {"contact_equilibrium", unknown},
                    {"contact_complementarity", unknown},
                    {ErrorEstimate::unseen_contact, unknown}};
  estimate.rounding = estimate.pressure = estimate.max_pressure = estimate.contact_ends = unknown;
  return estimate;
}

/// A run on one mesh whose solution gets its error estimate, and what the loop reads of its pressures. Collective.
/// @param run  with the listener that it is given
template <class Run>
Solution with_estimate(const Task &task, const Listener &listener, const Run &run)
{
  Solution s;
  auto all = static_cast<const analysis::Listener &>(listener);
  const bool guaranteed = task.adapt.bound == ErrorBound::guaranteed;
  bound::FacetsOfMesh facets;
  if (guaranteed)
    all.step.start = [&](const analysis::Problem &problem, const analysis::Step &step) {
      facets = bound::require_covered(problem, step, task.goals);
      require_coverable_meshes(task, problem.discretization().mesh->element);
      if (listener.step.start) listener.step.start(problem, step);
    };
  all.solved = [&](const analysis::Problem &problem, analysis::Solution &found) {
    if (guaranteed && found.has_results())
      s.bound = bound::energy_bound(problem, found, task.linear_solver, bound::bound_rules.steps, facets, task.goals);
    facets.reset(); // memory
    const contact::ContactNodes &points = found.step.contact;
    const Comm &comm = found.discretization.mesh->comm();
    const auto &pressure = found.contact.pressure;
    if (task.adapt.adapts()) s.pressure_norm = contact::pressure_distance(comm, points, pressure, {});
    if (found.start_pressure)
      s.pressure_change = contact::pressure_distance(comm, points, pressure, *found.start_pressure);
    if (task.adapt.adapts()) s.smallest_gap = contact::smallest_gap(comm, points, found.contact);
    if (!task.adapt.estimate) return;
    if (!found.has_results()) {
      if (!s.estimate) s.estimate = unknown_estimate(); // else that of the step before, whose results these are
      return;
    }
    const Timed phase("estimate", found.seconds.estimate);
    const auto loads = task.model.seen_at(found.time).tractions;
    s.estimate = estimator()(
        {found.discretization, task.model.materials, problem.contact_sides(), loads, points, found.contact, *found.u});
    const double tolerance = task.step.uzawa.tolerance;
    s.estimate->rounding = std::max(s.estimate->rounding, tolerance * tolerance * found.step.energies_before); // (5.5b)
    s.largest_estimate = std::max(s.largest_estimate, std::sqrt(s.estimate->total()));
    found.squared_errors = s.estimate->squared;
  };
  static_cast<analysis::Solution &>(s) = run(all);
  if (!task.adapt.estimate) s.skipped.push_back("error estimate: not asked for");
  return s;
}

/// @param previous, earlier  see analysis::solve_on()
Solution solve_on_mesh(const Task &task, const analysis::MadeMesh &mesh, const Solution *const previous,
                       const Solution *const earlier, const Listener &listener)
{
  return with_estimate(task, listener, [&](const analysis::Listener &all) {
    return analysis::solve_on(task, mesh, previous, earlier, all);
  });
}

Cycle cycle_of(const Solution &s, const double seconds)
{
  Cycle cycle;
  cycle.dofs = s.discretization.owned_dofs->getGlobalNumElements();
  cycle.estimate = relative_estimate(s);
  cycle.energy = s.energy;
  cycle.energy_norm_squared = s.energy_norm_squared;
  cycle.contact = s.contact.total;
  cycle.reactions = s.reactions;
  cycle.motions = motions_of(s);
  cycle.pressure_change = s.pressure_norm > 0 ? s.pressure_change / s.pressure_norm : 0;
  for (const int steps : s.uzawa.newton_iterations) cycle.newton_iterations += steps;
  cycle.linear_iterations = s.linear.iterations;
  cycle.recovered_pressure = s.pressure_norm > 0 ? s.estimate->pressure / s.pressure_norm : 0;
  cycle.recovered_max_pressure = s.estimate->max_pressure;
  cycle.peak = s.estimate->peak;
  cycle.contact_ends = s.estimate->contact_ends;
  cycle.jumped_force = s.estimate->jumped_force;
  cycle.jumped_energy = s.estimate->jumped_energy;
  cycle.ends_force = s.estimate->ends_force;
  cycle.misread_force = s.estimate->misread_force;
  cycle.misread_energy = s.estimate->misread_energy;
  cycle.misread_penetration = s.estimate->misread_penetration;
  cycle.interpolated = s.estimate->interpolated;
  cycle.misses_contact = s.estimate->misses_contact();
  cycle.smallest_gap = s.smallest_gap;
  cycle.max_displacement = s.body.displacement;
  cycle.bound = s.bound;
  cycle.seconds = seconds;
  return cycle;
}

/// Why there is nothing to adapt a mesh to.
std::string nothing_strained(const Solution &s, const UnitNames &units)
{
  std::ostringstream reason;
  reason << "nothing is strained";
  if (s.energy_norm_squared > 0)
    reason << ": the strain energy " << s.energy_norm_squared << " "
           << units.of(unit::energy, s.discretization.per_length()) << " is rounding, which may reach "
           << s.estimate->rounding;
  return reason.str();
}

/// Of meshes that grow alike, from the next one to the last.
/// @param per_dof  what an unknown of the last mesh took [s]: mesh, matrix, solves, estimate and the plan before it
double seconds_for(const Forecast &forecast, const double per_dof)
{
  const double growth =
      forecast.meshes > 1 ? std::pow(forecast.last_dofs / forecast.dofs, 1. / (forecast.meshes - 1)) : 1;
  double dofs = 0, of_mesh = forecast.dofs;
  for (int k = 0; k < forecast.meshes; ++k, of_mesh *= growth) dofs += of_mesh;
  return dofs * per_dof;
}

/// Why no other mesh follows one that is solved.
std::string why_ended(const Error &failure, const Comm &comm)
{
  return interrupted(comm) ? interruption() + " before the next mesh" : failure.what();
}

/// The mesh after that of a solution. Meshes that come out larger than allowed are made again, with larger cells. Collective.
/// @param forecast     of the mesh before, if there was one; becomes that of this one
/// @param per_dof      see seconds_for()
/// @param[out] reason  why there is none
std::optional<analysis::MadeMesh> next_mesh(MeshPlanner &planner, const Solution &s, Forecast &forecast,
                                            const double per_dof, const Listener &listener,
                                            analysis::PhaseSeconds &seconds, std::string &reason)
{
  const RCP<const Comm> comm = s.discretization.mesh->owned_nodes->getComm();
  forecast.told_before = forecast.misses_contact ? 0 : forecast.last_dofs;
  const ErrorEstimate estimate = guide(s);
  forecast.misses_contact = estimate.falls_at_once();
  auto options = planner.next(s.discretization, estimate, s.energy_norm_squared + estimate.unseen(), forecast, reason);
  if (options) {
    forecast.seconds = seconds_for(forecast, per_dof);
    if (listener.forecast) listener.forecast(forecast);
  }
  try {
    while (options) {
      analysis::MadeMesh made = analysis::made_mesh(*options, comm);
      if (planner.fits(*made.mesh)) return made;
      seconds.mesh += made.seconds;
      options = planner.smaller(s.discretization, estimate, *made.mesh, reason);
    }
  } catch (const Error &failure) { // on all ranks
    reason = why_ended(failure, *comm);
  }
  return std::nullopt;
}

/// @param earlier  the load step before, if there are several; its mesh is the first one
Solution solve_adaptively(const Task &task, const Solution *const earlier, const RCP<const Comm> &comm,
                          const Listener &listener)
{
  Adaptation adaptation;
  std::vector<Cycle> &cycles = adaptation.cycles;
  std::optional<analysis::MadeMesh> mesh = earlier
                                               ? analysis::MadeMesh{earlier->mesh_options, earlier->discretization.mesh}
                                               : analysis::made_mesh(task.mesh, comm);
  MeshPlanner planner(task, mesh->options);
  if (const std::string none = planner.why_no_other(*mesh->mesh); !none.empty() && listener.note)
    listener.note("\"Adapt->Target Relative Error\" finds no mesh after the first one: " + none);
  std::optional<Solution> last, best;
  std::string hint;
  analysis::PhaseSeconds seconds;
  Forecast forecast;
  double planned_from = Teuchos::Time::wallTime() - mesh->seconds; // when the present mesh's plan began
  while (mesh) {
    const double start = Teuchos::Time::wallTime() - mesh->seconds;
    std::optional<Solution> next;
    try {
      next = solve_on_mesh(task, *mesh, last ? &*last : nullptr, earlier, listener);
    } catch (const Error &failure) { // on all ranks
      if (!last) throw;
      adaptation.reason = why_ended(failure, *comm);
      break;
    }
    seconds += next->seconds;
    if (last && !next->uzawa.converged) {
      adaptation.reason = "no solution on the next mesh: " + next->uzawa.reason;
      break;
    }
    last = std::move(next);
    hint = fem::order_note(last->discretization, task.model.materials);
    if (cycles.empty() && !hint.empty() && listener.note) listener.note(hint);
    cycles.push_back(cycle_of(*last, Teuchos::Time::wallTime() - start));
    if (!best || best_of(cycles) + 1 == cycles.size()) best = last;
    if (listener.cycle) listener.cycle(*last);
    if (!last->uzawa.converged || !std::isfinite(cycles.back().estimate)) {
      adaptation.reason = "there is no solution to estimate an error of";
      break;
    }
    if (listener.estimate) listener.estimate(*last);
    adaptation.reached = relative_error(task, *last) <= task.adapt.target;
    if (only_rounding(*last)) adaptation.reason = nothing_strained(*last, task.model.units);
    if (adaptation.reached) break;
    if (last->estimate->total() <= last->estimate->rounding) {
      adaptation.reason = "the estimated error is rounding of the displacements, which finer meshes do not reduce";
      break;
    }
    if (static_cast<int>(cycles.size()) == task.adapt.max_cycles) {
      adaptation.reason = "there were \"Adapt->Max Cycles\" = " + std::to_string(task.adapt.max_cycles) + " meshes";
      break;
    }
    const double now = Teuchos::Time::wallTime();
    const double per_dof = (now - planned_from) / static_cast<double>(cycles.back().dofs);
    planned_from = now;
    mesh = next_mesh(planner, *last, forecast, per_dof, listener, seconds, adaptation.reason);
  }
  if (!adaptation.reached && !hint.empty() && !interrupted(*comm)) adaptation.reason += ". " + hint;
  adaptation.errors = observed_errors({cycles.begin(), cycles.begin() + best_of(cycles) + 1}, fixed_by_load(task.model),
                                      task.step.uzawa.tolerance);
  best->adaptation = std::move(adaptation);
  best->seconds = seconds;
  return std::move(*best);
}

/// The load steps up to a solution, or where earlier ones do not matter its own alone, on a mesh with larger cells. Collective.
/// @param[inout] seconds  of phases: those that it takes are added
CoarserHistory coarser_history(const Task &task, const Solution &s, const bool earlier_matter,
                               const RCP<const Comm> &comm, analysis::PhaseSeconds &seconds)
{
  CoarserHistory coarser;
  if (earlier_matter && !std::isfinite(s.largest_estimate)) {
    coarser.missing = "the run before the restart was on one mesh";
    return coarser;
  }
  const std::string none = "the mesh has no coarser one, on which the same steps would show it";
  const auto options = with_larger_cells(s.mesh_options);
  if (!options) {
    coarser.missing = none;
    return coarser;
  }
  Task again = task;
  again.mesh = *options;
  auto &times = again.steps.times;
  times.erase(std::remove_if(times.begin(), times.end(),
                             [&](const double t) { return t > s.time || (t < s.time && !earlier_matter); }),
              times.end());
  again.steps.checkpoint_every = 0;
  Listener quiet;
  quiet.mesh = [&](const fem::Discretization &d, const contact::ContactNodes &) {
    if (d.owned_dofs->getGlobalNumElements() >= s.discretization.owned_dofs->getGlobalNumElements())
      throw Error(ExitCode::bad_mesh, none); // a .geo may divide its curves by numbers
  };
  try {
    const Solution found = with_estimate(
        again, quiet, [&](const analysis::Listener &all) { return analysis::solve_steps(again, comm, all); });
    seconds += found.seconds;
    if (!found.has_results() || found.failure) {
      coarser.missing = "the same steps have no solution on a coarser mesh: " +
                        (found.failure ? found.failure->reason : found.uzawa.reason);
    } else {
      coarser.last = cycle_of(found, 0);
      coarser.largest_estimate = found.largest_estimate;
    }
  } catch (const Error &failure) { // on all ranks
    coarser.missing = interrupted(*comm) ? interruption() : one_line(failure.what());
  }
  return coarser;
}

/// Error bars of the last of several load steps count what the meshes of earlier ones have left. Collective.   doc/theory.md (10.7c)
void count_earlier_steps(const Task &task, Solution &s, const RCP<const Comm> &comm)
{
  const bool first = std::none_of(s.history.begin(), s.history.end(),
                                  [&](const auto &step) { return step.converged && step.time < s.time; });
  if (first || !s.adaptation || !s.has_results() || only_rounding(s)) return;
  const EarlierSteps earlier = earlier_steps(task, s);
  const auto &all = s.adaptation->cycles;
  const std::vector<Cycle> cycles(all.begin(), all.begin() + best_of(all) + 1);
  if (!earlier.matter && cycles.size() > 1) return;
  s.adaptation->errors = observed_errors(cycles, coarser_history(task, s, earlier.matter, comm, s.seconds), earlier,
                                         fixed_by_load(task.model), task.step.uzawa.tolerance);
}

/// Load steps, each on meshes of its own, for run_steps(). A step that a signal meets may end in other bits, for predictions are cut short: the
/// checkpoint is that of the step before.
class StepsOnMeshes
{
public:
  /// @param from  none: at rest
  StepsOnMeshes(const Task &task, std::optional<analysis::HistoryState> from, const RCP<const Comm> &comm,
                const Listener &listener)
      : task_(task), comm_(comm), listener_(listener), kept_(std::move(from))
  {
    if (kept_) resumed_ = step_of(*kept_);
  }

  Solution solve(const double t, const Solution *const last)
  {
    if (last) resumed_.reset(); // with its mesh
    const Solution *const earlier = last || !resumed_ ? last : &*resumed_;
    Task step = task_;
    step.time = t;
    Solution s = solve_adaptively(step, earlier, comm_, listener_);
    if (earlier) {
      s.largest_estimate = std::max(earlier->largest_estimate, s.largest_estimate);
      s.earlier_misread = misread_so_far(*earlier);
    }
    if (adapt::succeeded(s) && !interrupted(*comm_)) kept_ = state_of(s);
    return s;
  }

  analysis::StepRecord broken_off(const double t, const std::string &reason) const
  {
    return analysis::broken_off(task_.model, {}, t, reason);
  }

  static bool succeeded(const Solution &s) { return adapt::succeeded(s); }
  bool keep() const { return kept_ && analysis::keep_checkpoint(*kept_, listener_); }
  void start_anew() {} // each mesh has a multigrid of its own

private:
  const Task &task_;
  RCP<const Comm> comm_;
  const Listener &listener_;
  std::optional<analysis::HistoryState> kept_; // of the last step that no signal met
  std::optional<Solution> resumed_;            // the step that the run goes on from
};

Solution solve_steps_adaptively(const Task &task, const RCP<const Comm> &comm, const Listener &listener)
{
  analysis::PhaseSeconds seconds;
  auto from = analysis::resumed(listener, seconds);
  const double after = from ? from->last.time : analysis::no_step_before();
  StepsOnMeshes steps(task, std::move(from), comm, listener);
  auto s = analysis::run_steps<Solution>(task, after, *comm, listener, seconds, steps);
  if (!s) return {};
  count_earlier_steps(task, *s, comm);
  return *std::move(s);
}

} // namespace

Solution solve(const Task &task, const RCP<const Comm> &comm, const Listener &listener)
{
  if (!task.adapt.adapts())
    return with_estimate(task, listener,
                         [&](const analysis::Listener &all) { return analysis::solve(task, comm, all); });
  if (comm->getRank() == 0 && !nests(task.mesh, task.adapt)) mesh::start_gmsh_early();
  return task.has_steps() ? solve_steps_adaptively(task, comm, listener)
                          : solve_adaptively(task, nullptr, comm, listener);
}

bool only_rounding(const Solution &s)
{
  return s.estimate && std::max(s.energy_norm_squared, s.estimate->unseen()) <= s.estimate->rounding;
}

double relative_estimate(const Solution &s)
{
  const double squared = s.estimate->total();
  return squared == 0 || only_rounding(s) ? 0 : std::sqrt(squared / estimated_energy(s));
}

ObservedErrors errors_of(const Task &task, const Solution &s)
{
  if (s.adaptation) {
    const auto &seen = s.adaptation->errors;
    const auto reason = seen.unknown.find("energy_J");
    if (reason == seen.unknown.end() || reason->second != one_mesh) return seen;
  }
  ObservedErrors errors;
  std::string reason = "not estimated: set \"Adapt->Target Relative Error\"";
  if (!s.has_results())
    reason = "there is no solution";
  else if (s.estimate && only_rounding(s))
    reason = "the strain energy is at rounding level";
  else if (s.estimate && s.estimate->misses_contact())
    reason = unseen_by_mesh;
  else if (s.estimate)
    reason = std::string(one_mesh) + (task.adapt.adapts() ? "" : ": set \"Adapt->Target Relative Error\"");
  for (const auto &q : error_bars) {
    errors.*q.value = std::numeric_limits<double>::quiet_NaN();
    errors.unknown[q.key] = reason;
  }
  if (!s.has_results() || !s.estimate || only_rounding(s) || s.estimate->misses_contact()) return errors;
  errors.energy = energy_left(cycle_of(s, 0));
  errors.unknown.erase("energy_J");
  return errors;
}

std::vector<double> contact_force_bars(const Task &task, const Solution &s)
{
  if (!s.adaptation || !s.has_results()) return {};
  const auto &all = s.adaptation->cycles;
  return contact_force_bars({all.begin(), all.begin() + best_of(all) + 1}, errors_of(task, s),
                            fixed_by_load(task.model), task.step.uzawa.tolerance);
}

double exact_error(const Task &task, const Solution &s)
{
  return std::sqrt(2 * std::abs(s.energy - task.adapt.exact_energy) / s.energy_norm_squared);
}

bool succeeded(const Solution &s)
{
  return s.has_results() && !s.failure && (!s.adaptation || s.adaptation->reached) &&
         (!s.out_of_balance || s.out_of_balance->steps == 0);
}

} // namespace rpc::adapt
