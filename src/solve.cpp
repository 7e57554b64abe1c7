#include "solve.hpp"

#include "checkpoint.hpp"
#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace rpc
{

Solution solve(const Scene &scene, const RCP<const Comm> &comm, std::ostream &console,
               const std::function<void(const Scene &, Solution &)> &keep,
               const std::function<void(const Scene &, const analysis::Solution &)> &keep_step,
               Checkpoints *const checkpoints)
{
  std::optional<ConsoleTable> table; // of one mesh
  adapt::Listener listener;
  listener.mesh = [&](const fem::Discretization &d, const contact::ContactNodes &contact) {
    if (!table || !scene.has_steps()) table.emplace(console);
    table->scene(scene, d, contact);
  };
  const bool several_steps = scene.has_steps(); // a line for each is enough then
  if (!several_steps)
    listener.step.newton = [&](const int uzawa, const solver::NewtonStep &step, const contact::StateCounts &states) {
      table->newton(uzawa, step, states);
    };
  if (!several_steps) listener.step.uzawa = [&](const analysis::UzawaResult &result) { table->uzawa(result); };
  listener.estimate = [&](const Solution &solution) { print_estimate(console, scene, solution); };
  listener.forecast = [&](const adapt::Forecast &forecast) {
    console << "next mesh: about " << std::llround(forecast.dofs) << " dofs; the target ";
    if (forecast.last_dofs > static_cast<double>(scene.adapt.max_dofs))
      console << "takes more than \"Adapt->Max Dofs\" = " << scene.adapt.max_dofs << ", as it looks" << std::endl;
    else
      console << "in about " << std::max(1LL, std::llround(forecast.seconds)) << " s" << std::endl;
  };
  listener.note = [&](const std::string &note) { console << "note: " << note << std::endl; };
  listener.load_step = [&](const analysis::Solution &solution) {
    if (keep_step) keep_step(scene, solution); // what the table tells is on disk
    table->load_step(scene, solution);
  };
  if (checkpoints) {
    listener.resume = [&] {
      auto state = checkpoints->resume(comm);
      if (state)
        console << "note: goes on after \"" << checkpoints->source() << "\", t = " << state->last.time << std::endl;
      return state;
    };
    listener.checkpoint = [&](const analysis::HistoryState &state) { checkpoints->write(state); };
  }
  if (keep) listener.cycle = [&](Solution &solution) { keep(scene, solution); };
  Solution solution = adapt::solve(scene, comm, listener);
  if (!scene.output.exodus) solution.skipped.push_back("stress recovery and nodal fields: no Exodus file");
  if (!scene.output.csv && !scene.model.contact.empty()) solution.skipped.push_back("contact tables: no CSV file");
  return solution;
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
