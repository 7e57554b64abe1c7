#include "rpc/solver/active_set.hpp"

#include "rpc/core/interrupt.hpp"

#include <Teuchos_TimeMonitor.hpp>
#include <algorithm>
#include <limits>
#include <optional>
#include <set>

namespace rpc::solver
{
namespace
{

// Weights of penetration against pressure in the choice of states, in E / diameter. The first is best for a foundation
// that gives way at once as well as for a rigid one; where it goes in circles, the others stick more and yield later.
// Measured on the half cylinder at xi = 2 .. inf, with both normals: 11 steps at most for 10, 13 for 20 and 30; at 100
// and beyond some of them go in circles.
constexpr double weights[] = {10, 1, 0.1};
constexpr int most_steps = 24;
// While states change, solves bring the residual below this part of what it was, and of the load: three to five CG
// iterations. With 1e-1 pressures are too rough to choose states by, 1e-4 saves no step. What the multipliers of the last
// rough solve miss, the penalty leaves a part of, k/r, in the final pressures: some 1e-8 of them.
constexpr double forcing = 5e-3;
constexpr int most_updates = 2; // of multipliers at the end, even if pressures miss their tolerance then
constexpr double enough = 0.3;  // of the tolerance: recomputed residuals are a little larger than CG's

/// A choice of states that has not been there yet, with the first weight that leads to one; nothing otherwise.
std::optional<contact::StateChoice> new_choice(const contact::SmoothedFunctional &functional, const Vector &u,
                                               std::set<std::uint64_t> &seen)
{
  for (const double weight : weights) {
    auto choice = functional.choose_states(u, weight);
    if (choice.confirmed || seen.insert(choice.fingerprint).second) return choice;
  }
  return std::nullopt;
}

} // namespace

ActiveSetResult find_states(contact::SmoothedFunctional &functional, LinearSolver &linear_solver, Vector &u,
                            const NewtonOptions &options, const std::function<void(const NewtonStep &)> &report)
{
  ActiveSetResult result;
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::active_set"));
  const double scale = functional.force_scale(), target = options.start_tolerance * scale;
  Vector start(u, Teuchos::Copy);
  Vector G(u.getMap()), F(u.getMap()), d(u.getMap());
  std::set<std::uint64_t> seen;
  NewtonStep step;
  const bool held =
      functional.held_by_contact(); // small residuals may be large rigid motions: the last word is Newton's
  bool rough = !held;
  double norm = std::numeric_limits<double>::infinity(), before = norm;
  int updates = 0; // of the multipliers alone
  while (result.steps < most_steps) {
    const auto choice = new_choice(functional, u, seen);
    const bool solved_well = choice && choice->confirmed && norm <= target;
    result.confirmed = solved_well && !held &&
                       (functional.pressure_error(u) <= options.pressure_tolerance || ++updates > most_updates);
    const bool stalled = !rough && choice && choice->confirmed && (held || (!solved_well && !(norm < 0.5 * before)));
    if (result.confirmed || stalled || (!choice && !rough)) break;
    if (rough && (!choice || choice->changes == 0)) {
      rough = false;
      seen.clear(); // what rough solves led to says little
      if (!choice) continue;
      seen.insert(choice->fingerprint);
    }
    functional.take_states(*choice, u);
    functional.elastic_gradient(u, G);
    functional.piece_gradient(u, G, F);
    before = norm = F.norm2();
    if (!(norm > target)) continue;
    if (!rough && !held) {       // a held body may have come far here, and K times that rounds
      functional.move_origin(u); // what is left is small, and wants its digits
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
