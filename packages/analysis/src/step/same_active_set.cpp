// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/same_active_set.hpp"

#include "rpc/solver/rules.hpp"

namespace rpc::analysis
{
solver::MinimizationSteps::Status minimize_from_same_active_set(const contact::Iterate &iterate,
                                                                solver::MinimizationSteps &steps)
{
  using Status = solver::MinimizationSteps::Status;
  solver::NewtonContext &context = steps.context();
  if (!steps.user_decides() && steps.at().getNormF() <= context.target_residual)
    return steps.newton_to_end(steps.newton_begins());
  const Vector &F = solver::tpetra(steps.at().getF());
  Vector G(F.getMap());
  iterate.active_set_gradient(solver::tpetra(steps.at().getX()), F, G); // (5.6)
  const double norm = G.norm2();
  const auto direction = rcp(new Vector(G.getMap()));
  const auto solved = solver::solve_for_direction(context, G, *direction,
                                                  solver::newton_rules.beside_target * context.target_residual / norm);
  if (!solved.converged || !(direction->dot(F) > 0)) return steps.newton_to_end(Status::goes_on);
  direction->scale(-1.);
  ++context.steps;
  const Status status = steps.take(direction, true);
  return status == Status::goes_on ? steps.newton_to_end(steps.newton_begins()) : status;
}

} // namespace rpc::analysis
