#include "rpc/solver/active_set.hpp"

#include "rpc/core/interrupt.hpp"

#include <Teuchos_TimeMonitor.hpp>
#include <algorithm>
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

int find_states(contact::SmoothedFunctional &functional, LinearSolver &linear_solver, Vector &u,
                const NewtonOptions &options, const std::function<void(const NewtonStep &)> &report)
{
  if (functional.contact().num_total == 0) return 0;
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::active_set"));
  const double scale = functional.force_scale(), target = options.residual_tolerance * scale;
  const Vector start(u, Teuchos::Copy);
  Vector F(u.getMap()), d(u.getMap());
  std::set<std::uint64_t> seen;
  NewtonStep step;
  while (step.iteration < most_steps) {
    const auto choice = new_choice(functional, u, seen);
    if (!choice || choice->confirmed) break;
    functional.take_states(*choice);
    if (functional.take_hessian_change()) linear_solver.matrix_changed();
    functional.piece_gradient(u, F);
    const double norm = F.norm2();
    if (!(norm > target)) break;
    const auto solved = linear_solver.solve(F, d, std::min(0.1, 0.1 * target / norm));
    if (interrupted(*u.getMap()->getComm())) break;
    if (!solved.converged) { // a choice that leaves the body unheld
      u.assign(start);
      functional.reset_multipliers();
      break;
    }
    u.update(-1., d, 1.);
    ++step.iteration;
    step.residual = norm / scale;
    step.step_length = 1;
    step.linear_iterations = solved.iterations;
    step.states = functional.count_states(u);
    report(step);
  }
  return step.iteration;
}

} // namespace rpc::solver
