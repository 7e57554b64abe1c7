// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/same_active_set.hpp"

#include "rpc/analysis/rules.hpp"
#include "rpc/solver/rules.hpp"

namespace rpc::analysis
{
namespace
{

/// The functional's gradient with the states of the active set. (5.6)
Vector gradient_of_set(const contact::Iterate &iterate, const solver::NewtonGroup &at)
{
  const Vector &F = solver::tpetra(at.getF());
  Vector G(F.getMap());
  iterate.active_set_gradient(solver::tpetra(at.getX()), F, G);
  return G;
}

/// Whether a step to the minimum for the active set has ended there, up to rounding.
bool is_enough(const contact::Iterate &iterate, const solver::NewtonGroup &at, const double norm_before)
{
  Vector G = gradient_of_set(iterate, at);
  G.update(-1., solver::tpetra(at.getF()), 1.);
  return at.getNormF() <= choice_rules.ended_by_rounding * norm_before &&
         G.norm2() <= choice_rules.same_gradient * at.getNormF();
}

} // namespace

solver::MinimizationSteps::Status minimize_from_same_active_set(const contact::Iterate &iterate,
                                                                solver::MinimizationSteps &steps)
{
  using Status = solver::MinimizationSteps::Status;
  solver::NewtonContext &context = steps.context();
  const auto is_near = [&] { return !steps.user_decides() && steps.at().getNormF() <= context.target_residual; };
  if (is_near()) return steps.newton_to_end(steps.newton_begins());
  const Vector G = gradient_of_set(iterate, steps.at());
  const double norm = G.norm2();
  const auto direction = rcp(new Vector(G.getMap()));
  const auto solved = solver::solve_for_direction(
      context, G, *direction, solver::newton_rules.largest_residual * context.target_residual / norm);
  if (!solved.converged || !(direction->dot(solver::tpetra(steps.at().getF())) > 0))
    return steps.newton_to_end(Status::goes_on);
  direction->scale(-1.);
  ++context.steps;
  const Status status = steps.take(direction, true);
  if (status != Status::goes_on) return status;
  if (!is_near() && !steps.user_decides() && is_enough(iterate, steps.at(), norm)) return Status::converged;
  return steps.newton_to_end(steps.newton_begins());
}

} // namespace rpc::analysis
