// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/minimization_steps.hpp"

#include <limits>

namespace rpc::solver
{

MinimizationSteps::Status MinimizationSteps::status_of(const NOX::StatusTest::StatusType status)
{
  if (status == NOX::StatusTest::Converged) return Status::converged;
  return status == NOX::StatusTest::Failed ? Status::failed : Status::goes_on;
}

void MinimizationSteps::move_to(const RCP<Vector> &u)
{
  group_->setX(NoxVector(u));
  group_->computeF();
}

MinimizationSteps::Status MinimizationSteps::take(const RCP<const Vector> &direction, const bool search)
{
  context().given = direction;
  context().full_step = !search;
  const Status status = step();
  context().given = Teuchos::null;
  context().full_step = false;
  return status;
}

MinimizationSteps::Status MinimizationSteps::step()
{
  stepped_ = true;
  return status_of(nox_->step());
}

MinimizationSteps::Status MinimizationSteps::stay()
{
  return take(rcp(new Vector(tpetra(group_->getX()).getMap())));
}

MinimizationSteps::Status MinimizationSteps::judge_newton()
{
  if (user_decides()) return Status::goes_on;
  return unless_last(status_of(newton_tests_->checkStatus(*nox_, NOX::StatusTest::Minimal)));
}

MinimizationSteps::Status MinimizationSteps::newton_step()
{
  const Status status = step();
  return status == Status::goes_on ? judge_newton() : status;
}

MinimizationSteps::Status MinimizationSteps::newton_begins()
{
  context().direction_norm = std::numeric_limits<double>::infinity(); // no Newton step has been made
  return judge_newton();
}

MinimizationSteps::Status MinimizationSteps::newton_to_end(Status status)
{
  while (status == Status::goes_on) status = newton_step();
  return status;
}

MinimizationSteps::Status MinimizationSteps::unless_last(const Status status) const
{
  const bool is_last = !user_decides() && nox_->getNumIterations() >= most_steps_;
  return status == Status::goes_on && is_last ? Status::failed : status;
}

} // namespace rpc::solver
