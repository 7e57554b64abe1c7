// SPDX-License-Identifier: BSD-3-Clause
#include "solve.hpp"

#include "checkpoint.hpp"
#include "deck_notes.hpp"
#include "notes.hpp"
#include "report.hpp"
#include "understood.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

namespace rpc
{
namespace
{

/// Where a load is more than the foundation carries, a force per area may be meant as a force.
std::string load_hint(const Scene &scene, const ExitCode code, const std::string &reason)
{
  const bool too_large = code == ExitCode::no_solution && reason.find("carries at most") != std::string::npos;
  const std::string load = too_large ? force_per_area_hint(scene) : "";
  return load.empty() ? "" : " " + load + ".";
}

/// A number of which two digits are known.
std::string two_digits(const double value)
{
  const double unit = std::pow(10., std::max(0., std::floor(std::log10(std::max(value, 1.))) - 1));
  return std::to_string(std::llround(std::round(value / unit) * unit));
}

/// When the target is met, as the last meshes tell.
std::string target_text(const adapt::Forecast &forecast, const adapt::AdaptOptions &adapt)
{
  if (forecast.misses_contact)
    return "when the target is met is not known yet: most of the error is contact that this mesh does not see";
  const std::string dofs = two_digits(forecast.last_dofs) + " dofs",
                    seconds = two_digits(std::max(1., forecast.seconds)) + " s";
  const bool too_many = forecast.last_dofs > static_cast<double>(adapt.max_dofs);
  const std::string when =
      too_many ? ", more than \"Adapt->Max Dofs\" = " + std::to_string(adapt.max_dofs) : " in about " + seconds;
  return "the target with about " + dofs + when +
         (forecast.told_before > 0 ? "; the mesh before told " + two_digits(forecast.told_before) + " dofs"
                                   : ", as one mesh tells");
}

} // namespace

Solution solve(const Scene &scene, const RCP<const Comm> &comm, std::ostream &console,
               const std::function<void(const Scene &, Solution &)> &keep,
               const std::function<void(const Scene &, const analysis::Solution &)> &keep_step,
               Checkpoints *const checkpoints,
               const std::function<void(const analysis::Problem &, const analysis::Step &, const Notes &)> &ready)
{
  std::optional<ConsoleTable> table; // of one mesh
  bool points_looked_for = false;
  std::set<std::string> told_of_meshes; // notes without their counts, which are other ones on each mesh
  Notes notes(console);
  SeldomMeant seldom_meant(scene, checkpoints && checkpoints->goes_on(), notes);
  for (const std::string &note : scene.notes) notes.add(note);
  adapt::Listener listener;
  listener.mesh = [&](const fem::Discretization &d, const contact::ContactNodes &contact) {
    seldom_meant.on_new_mesh();
    if (!table || !scene.has_steps()) table.emplace(console, scene.output.verbose);
    if (!std::exchange(points_looked_for, true)) require_inside(scene.output.points, d, scene.model.units);
    table->scene(scene, d, contact);
    const std::set<std::string> told = told_of_meshes; // sides of one mesh may differ by a number in their names
    const auto is_new = [&](const std::string &note) {
      const std::string without_counts = std::regex_replace(note, std::regex("[0-9]+"), "");
      told_of_meshes.insert(without_counts);
      return told.count(without_counts) == 0;
    };
    for (const std::string &note : d.mesh->notes)
      if (is_new(note)) notes.add("mesh: " + note);
    if (const HeldContact held = held_contact(scene, contact); is_new(held.note))
      held.harmless ? notes.add_harmless(held.note) : notes.add(held.note);
    for (const std::string &note : notes_on_mesh(scene, d, contact))
      if (is_new(note)) notes.add(note);
  };
  listener.step.start = [&](const analysis::Problem &problem, const analysis::Step &step) {
    seldom_meant.before(problem, step);
    if (ready) ready(problem, step, notes);
    table->heads(scene);
  };
  listener.step.part = [&](const analysis::Problem &problem, const analysis::StepSolution &part) {
    seldom_meant.after_part(problem.discretization(), part);
  };
  const bool several_steps = scene.has_steps(); // a line for each is enough then
  if (!several_steps)
    listener.step.newton = [&](const int uzawa, const solver::NewtonStep &step, const contact::StateCounts &states) {
      table->newton(uzawa, step, states);
    };
  if (!several_steps) listener.step.uzawa = [&](const analysis::UzawaResult &result) { table->uzawa(result); };
  listener.estimate = [&](const Solution &solution) { print_estimate(console, scene, solution); };
  listener.forecast = [&](const adapt::Forecast &forecast) {
    console << "next mesh: about " << std::llround(forecast.dofs) << " dofs; " << target_text(forecast, scene.adapt)
            << std::endl;
  };
  listener.note = [&](const std::string &note) { notes.add(note); };
  listener.load_step = [&](const analysis::Solution &solution) {
    seldom_meant.after(solution);
    if (keep_step) keep_step(scene, solution); // what the table tells is on disk
    table->load_step(scene, solution);
  };
  if (checkpoints) {
    listener.resume = [&] {
      auto state = checkpoints->resume(comm);
      if (state) // of this run, not of its results: those of an uninterrupted one are the same
        console << "note: goes on after \"" << checkpoints->source() << "\", t = " << state->last.time << std::endl;
      return state;
    };
    listener.checkpoint = [&](const analysis::HistoryState &state) { checkpoints->write(state); };
  }
  if (keep)
    listener.cycle = [&](Solution &solution) {
      solution.notes = notes.all();
      keep(scene, solution);
    };
  Solution solution = [&] {
    try {
      return adapt::solve(scene, comm, listener);
    } catch (const Error &error) { // on all ranks
      throw Error(error.code(), error.what() + load_hint(scene, error.code(), error.what()));
    }
  }();
  if (auto &failure = solution.failure) failure->reason += load_hint(scene, failure->code, failure->reason);
  if (!several_steps) seldom_meant.after(solution);
  seldom_meant.at_end(solution);
  solution.notes = notes.all();
  if (!scene.output.exodus) solution.skipped.push_back("stress recovery and nodal fields: no Exodus file");
  if (!scene.output.csv && !scene.model.contact.empty()) solution.skipped.push_back("contact tables: no CSV file");
  return solution;
}

namespace
{

/// Ends a run before its first solve.
struct Ready {
  GO dofs, contact_points;
  std::size_t num_notes; // that are to be read
};

} // namespace

std::string check(const Scene &scene, const RCP<const Comm> &comm, std::ostream &console, Checkpoints &checkpoints)
{
  const auto stop = [&](const analysis::Problem &problem, const analysis::Step &step, const Notes &notes) {
    print_understood(console, scene, problem, step);
    throw Ready{static_cast<GO>(problem.discretization().owned_dofs->getGlobalNumElements()), step.contact.num_total,
                notes.num_telling()};
  };
  const std::string nothing_wrong = "nothing wrong with it";
  std::ostringstream found;
  try {
    solve(scene, comm, console, {}, {}, &checkpoints, stop);
    return nothing_wrong;
  } catch (const Ready &ready) { // on all ranks
    if (ready.num_notes == 0)
      found << nothing_wrong;
    else
      found << "a run refuses nothing of it; see the " << (ready.num_notes == 1 ? "note" : "notes") << " above";
    found << ": " << ready.dofs << " dofs, " << ready.contact_points << " contact points";
  }
  return found.str();
}

Error failure_of(const Solution &solution)
{
  const auto &failure = *solution.failure;
  const auto converged =
      std::count_if(solution.history.begin(), solution.history.end(), [](const auto &step) { return step.converged; });
  std::string reason = failure.reason;
  if (!reason.empty() && reason.back() == '.') reason.pop_back();
  std::ostringstream text;
  text << "at t = " << failure.time << ": " << reason << ". The results end with step " << converged
       << ", t = " << solution.time;
  return {failure.code, text.str()};
}

} // namespace rpc
