#include "rpc/solver/active_set.hpp"

#include <Teuchos_TimeMonitor.hpp>
#include <algorithm>
#include <set>

namespace rpc::solver
{
namespace
{

// Weights of penetration against pressure in the choice of states, in E / diameter. The first is best for a foundation
// that gives way at once as well as for a rigid one; where it goes in circles, the second sticks more and yields later.
// Measured on the half cylinder at xi = 2 .. inf, with both normals: 11 steps at most for 10, 13 for 20 and 30; at 100
// and beyond some of them go in circles.
constexpr double weights[] = {10, 1};
constexpr int most_steps = 12; // per weight

/// One iteration with one weight; adds to steps. @return whether the states are confirmed, or nothing more can be done
bool iterate(contact::SmoothedFunctional &functional, LinearSolver &linear_solver, Vector &u, const double rho,
             const NewtonOptions &options, const std::function<void(const NewtonStep &)> &report, int &steps)
{
  const double scale = functional.force_scale(), target = options.residual_tolerance * scale;
  const Vector start(u, Teuchos::Copy);
  Vector F(u.getMap()), d(u.getMap());
  std::set<std::uint64_t> seen;
  for (int k = 0; k < most_steps; ++k) {
    const auto change = functional.choose_states(u, rho);
    if (change.stiffness > 0) linear_solver.matrix_changed();
    if (steps > 0 && change.nodes == 0) return true;
    if (!seen.insert(change.fingerprint).second) return false;
    functional.piece_gradient(u, F);
    const double norm = F.norm2();
    if (!(norm > target)) return true;
    const auto solved = linear_solver.solve(F, d, std::min(0.1, 0.1 * target / norm));
    if (!solved.converged) { // a choice that leaves the body unheld
      u.assign(start);
      functional.reset_multipliers();
      return true;
    }
    u.update(-1., d, 1.);
    NewtonStep step;
    step.iteration = ++steps;
    step.residual = norm / scale;
    step.step_length = 1;
    step.linear_iterations = solved.iterations;
    step.states = functional.count_states(u);
    report(step);
  }
  return false;
}

} // namespace

int find_states(contact::SmoothedFunctional &functional, LinearSolver &linear_solver, Vector &u,
                const double stiffness_scale, const NewtonOptions &options,
                const std::function<void(const NewtonStep &)> &report)
{
  if (functional.contact().num_total == 0) return 0;
  const Teuchos::TimeMonitor timer(*Teuchos::TimeMonitor::getNewTimer("rpc::active_set"));
  int steps = 0;
  for (const double weight : weights)
    if (iterate(functional, linear_solver, u, weight * stiffness_scale, options, report, steps)) break;
  return steps;
}

} // namespace rpc::solver
