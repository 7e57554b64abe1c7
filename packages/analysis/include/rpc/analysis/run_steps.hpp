// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/run.hpp"
#include "rpc/core/interrupt.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace rpc::analysis
{

/// A time before that of all steps.
inline double no_step_before()
{
  return -std::numeric_limits<double>::infinity();
}

/// The loop over the load steps of a run, on one mesh or each on meshes of its own. Where a step does not converge or an error ends it, the
/// solution is that of the step before, with its `failure`; an error in the first step of all is thrown. An interrupted run leaves a
/// checkpoint. Collective.
///
/// @tparam Found  analysis::Solution, or what derives from it
/// @param after   time of the step that the run goes on from; `no_step_before()`: it begins with the first one
/// @param spent   seconds of the run before the steps
/// @param steps   what solves them:
///
///     Found solve(double t, const Found *last)         the step to t, with the history up to it; the seconds are its own
///     StepRecord broken_off(double t, reason)          of a step that solve() has left with an error
///     bool succeeded(const Found &)                    whether another step can follow
///     bool keep()                                      has a checkpoint kept of the last step that no signal met; whether it was
///     void start_anew()                                goes on as from that checkpoint
///
/// @return none if no step is later than `after`
template <class Found, class Steps>
std::optional<Found> run_steps(const Task &task, const double after, const Comm &comm, const Listener &listener,
                               PhaseSeconds spent, Steps &steps)
{
  std::optional<Found> s;
  bool checkpoint_due = false;
  for (const double t : task.steps.times) {
    if (t <= after) continue;
    if (s && interrupted(comm)) { // a step that converges without iterations does not ask
      steps.keep();
      s->failure = Failure{t, interruption() + " before the step", ExitCode::not_converged};
      break;
    }
    bool solved = false;
    try {
      Found next = steps.solve(t, s ? &*s : nullptr);
      spent += next.seconds;
      next.seconds = spent;
      next.energy_rounding = std::max(s ? s->energy_rounding : 0, energy_rounding(task, next));
      if (next.has_results() || !s) {
        s = std::move(next);
      } else {
        s->failure = Failure{next.time, next.uzawa.reason, ExitCode::not_converged};
        s->history = std::move(next.history);
        s->matrix_assemblies = next.matrix_assemblies;
        s->seconds = spent;
      }
      solved = true;
      if (listener.load_step && s->has_results() && !s->failure) listener.load_step(*s);
    } catch (const Error &error) { // on all ranks; what the steps before have found is not lost
      const StepRecord broken = steps.broken_off(t, one_line(error.what()));
      if (!s) throw error_at(broken.time, error, after == no_step_before());
      if (!solved) s->history.push_back(broken);
      s->failure = Failure{solved ? s->time : broken.time, broken.reason, error.code()};
    }
    if (s->failure || !steps.succeeded(*s)) {
      if (interrupted(comm)) steps.keep();
      break;
    }
    const int every = task.steps.checkpoint_every;
    checkpoint_due |= every > 0 && s->history.size() % every == 0;
    const bool last = t == task.steps.times.back();
    if (!checkpoint_due || (!last && interrupted(comm))) continue; // before another step, a signal has one kept
    checkpoint_due = !steps.keep();
    if (!last) steps.start_anew();
  }
  if (s) judge_balance(task, *s);
  return s;
}

} // namespace rpc::analysis
