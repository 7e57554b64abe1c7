#include "rpc/solver/active_set.hpp"

#include "rpc/core/interrupt.hpp"

#include <Teuchos_TimeMonitor.hpp>
#include <algorithm>
#include <limits>
#include <set>

namespace rpc::solver
{
namespace
{

constexpr int most_changes = 10; // of states; then Newton with its sweep needs fewer steps
// While states change, solves bring the residual below this part of what it was, and of the load: three to five CG
// iterations. With 1e-1 pressures are too rough to choose states by, 1e-4 saves no step. What the multipliers of the last
// rough solve miss, the penalty leaves a part of, k/r, in the final pressures: some 1e-8 of them.
constexpr double forcing = 5e-3;
constexpr int most_updates = 2;     // of multipliers at the end, even if pressures miss their tolerance then
constexpr double enough = 0.3;      // of the tolerance: recomputed residuals are a little larger than CG's
constexpr double negligible = 1e-3; // of the tolerance of pressures: violations that change no state

} // namespace

ActiveSetResult find_states(contact::SmoothedFunctional &functional, LinearSolver &linear_solver, Vector &u,
                            const NewtonOptions &options, const std::function<void(const NewtonStep &)> &report)
{
  ActiveSetResult result;
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::active_set"));
  const double scale = functional.force_scale(), target = options.start_tolerance * scale;
  Vector start(u, Teuchos::Copy);
  Vector G(u.getMap()), F(u.getMap()), d(u.getMap());
  std::set<std::uint64_t> seen; // fingerprints of states
  NewtonStep step;
  bool rough = functional.contact().num_total > functional.contact().num_fixed; // else there are no states to look for
  double norm = std::numeric_limits<double>::infinity(), before = norm;
  int changes = 0, updates = 0; // of states; of the multipliers alone
  while (true) {
    const auto choice = functional.choose_states(u, negligible * options.pressure_tolerance);
    // Nothing touches, as far as is known: one solve, for CG in one go keeps the energy balance to rounding.
    if (choice.changes == 0 && result.steps == 0) rough = false;
    if (choice.confirmed) {
      const bool solved_well = norm <= target;
      result.confirmed =
          solved_well && (functional.pressure_error(u) <= options.pressure_tolerance || ++updates > most_updates);
      const bool stalled = !rough && !solved_well && !(norm < 0.5 * before);
      if (result.confirmed || stalled) break;
      rough = false;
    } else if (!seen.insert(choice.fingerprint).second || ++changes > most_changes) {
      break; // in circles, or too slow
    } else if (result.steps == 1) {
      rough = true; // it touches after all
    }
    functional.take_states(choice, u);
    functional.elastic_gradient(u, G);
    functional.piece_gradient(u, G, F);
    before = norm = F.norm2();
    if (!(norm > target)) continue;
    if (!rough) {
      functional.move_origin(u); // the remaining correction is small against u and keeps its relative accuracy
      start.putScalar(0);
    }
    const double needed = std::max(enough * target, rough ? forcing * std::min(scale, norm) : 0.);
    const auto solved = linear_solver.solve(F, d, std::min(0.1, needed / norm));
    if (interrupted(*u.getMap()->getComm())) break;
    if (!solved.converged) { // a choice that leaves the body unheld
      u.assign(start);
      functional.reset_multipliers();
      break;
    }
    u.update(-1., d, 1.);
    step.iteration = ++result.steps;
    step.residual = norm / scale;
    step.step_length = 1;
    step.linear_iterations = solved.iterations;
    step.states = functional.count_states(u);
    report(step);
    functional.elastic_gradient(u, G);
    functional.piece_gradient(u, G, F);
    norm = F.norm2();
  }
  return result;
}

} // namespace rpc::solver
