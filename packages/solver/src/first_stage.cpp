#include "rpc/solver/first_stage.hpp"

#include "rpc/solver/sweep_direction.hpp"

#include <NOX_Solver_Generic.H>
#include <limits>
#include <utility>

namespace rpc::solver
{
namespace
{

/// Newton creeps from kink to kink after so many steps that ended at one.
constexpr int most_short_steps = 3;

void end_stage(NewtonContext &context)
{
  context.resting = std::exchange(context.stage, nullptr);
  context.short_steps = 0;
}

/// Counts the last step if it was short.
bool creeps(NewtonContext &context)
{
  context.short_steps += context.step_length < cut_short;
  return context.short_steps >= most_short_steps;
}

} // namespace

bool StagedDirection::compute(NOX::Abstract::Vector &direction, NOX::Abstract::Group &group,
                              const NOX::Solver::Generic &solver)
{
  auto &newton_group = dynamic_cast<NewtonGroup &>(group);
  NewtonContext &context = newton_group.context();
  context.full_step = false;
  if (context.resting && creeps(context) && context.resting->resume(newton_group))
    context.stage = std::exchange(context.resting, nullptr);
  if (context.stage) {
    const auto step = context.stage->propose(newton_group, dynamic_cast<NoxVector &>(direction).data());
    context.full_step = step == FirstStage::Step::full;
    if (step != FirstStage::Step::none) return true;
    end_stage(context);
  }
  return sweep_.compute(direction, group, solver);
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
