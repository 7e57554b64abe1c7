// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/first_stage.hpp"

#include "rpc/solver/exact_line_search.hpp"
#include "rpc/solver/rules.hpp"
#include "rpc/solver/sweep_direction.hpp"

#include <NOX_Solver_Generic.H>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rpc::solver
{
namespace
{

void end_stage(NewtonContext &context)
{
  context.resting = std::exchange(context.stage, nullptr);
  context.newton = {};
}

/// Notes how Newton's last step went, which led here.
void note_step(NewtonContext &context, const NewtonGroup &here)
{
  NewtonProgress &newton = context.newton;
  newton.left *= std::max<double>(newton_rules.least_left, std::abs(1 - context.step_length));
  newton.short_steps += context.step_length < newton_rules.cut_short;
  newton.settled = std::abs(context.step_length - 1) <= newton_rules.to_the_minimum &&
                   context.functional.piece(tpetra(here.getX())) == context.piece;
}

} // namespace

bool StagedDirection::compute(NOX::Abstract::Vector &direction, NOX::Abstract::Group &group,
                              const NOX::Solver::Generic &solver)
{
  auto &newton_group = dynamic_cast<NewtonGroup &>(group);
  NewtonContext &context = newton_group.context();
  context.full_step = false;
  if (context.resting && context.newton.steps > 0) {
    note_step(context, newton_group);
    if (context.resting->resume(newton_group, context.newton)) context.stage = std::exchange(context.resting, nullptr);
  }
  if (context.stage) {
    const auto step = context.stage->propose(newton_group, dynamic_cast<NoxVector &>(direction).data());
    context.full_step = step == FirstStage::Step::full;
    if (step != FirstStage::Step::none) return true;
    end_stage(context);
  }
  if (!sweep_.compute(direction, group, solver)) return false;
  if (context.resting) {
    ++context.newton.steps;
    context.piece = context.functional.piece(tpetra(group.getX()));
  }
  return true;
}

Teuchos::RCP<NOX::Direction::Generic> StagedDirectionFactory::buildDirection(const Teuchos::RCP<NOX::GlobalData> &,
                                                                             Teuchos::ParameterList &) const
{
  return Teuchos::rcp(new StagedDirection);
}

NOX::StatusTest::StatusType StagedTest::checkStatus(const NOX::Solver::Generic &solver,
                                                    const NOX::StatusTest::CheckType type)
{
  if (context_->stage) {
    const auto verdict = context_->stage->judge(dynamic_cast<const NewtonGroup &>(solver.getSolutionGroup()));
    status_ = verdict == FirstStage::Verdict::converged ? NOX::StatusTest::Converged : NOX::StatusTest::Unconverged;
    if (verdict != FirstStage::Verdict::over) return status_;
    end_stage(*context_);
    context_->direction_norm = std::numeric_limits<double>::infinity(); // no Newton step has been made
  }
  return status_ = newton_->checkStatus(solver, type);
}

std::ostream &StagedTest::print(std::ostream &out, const int indent) const
{
  if (!context_->stage) return newton_->print(out, indent);
  return out << std::string(indent, ' ') << status_ << "the first stage is at its end\n";
}

} // namespace rpc::solver
