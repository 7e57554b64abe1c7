// SPDX-License-Identifier: BSD-3-Clause
#include "newton/status_tests.hpp"

#include "rpc/core/headway.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/rules.hpp"
#include "rpc/solver/rules.hpp"

#include <NOX.H>
#include <NOX_StatusTest_Factory.H>
#include <utility>

namespace rpc::solver
{
namespace
{

/// The stopping test of the paper's section 4, |full Newton step| / |u| < tolerance. The full step, not the one that the line search
/// shortened: a short step is no sign of convergence.
class StepTest : public NOX::StatusTest::Generic
{
public:
  StepTest(RCP<NewtonContext> context, const double tolerance) : context_(std::move(context)), tolerance_(tolerance) {}

  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic &solver, NOX::StatusTest::CheckType) override
  {
    status_ = NOX::StatusTest::Unconverged;
    if (solver.getNumIterations() > 0) {
      ratio_ = context_->direction_norm / context_->functional.size(tpetra(solver.getSolutionGroup().getX()));
      if (ratio_ < tolerance_) status_ = NOX::StatusTest::Converged;
    }
    return status_;
  }
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream &print(std::ostream &out, const int indent) const override
  {
    return out << std::string(indent, ' ') << status_ << "|step|/|u| = " << ratio_ << " < " << tolerance_ << "\n";
  }

private:
  RCP<NewtonContext> context_;
  double tolerance_, ratio_ = 0;
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
};

/// Stops where rounding ends Newton's progress: some more full steps on the same piece, and the residual does not fall. Counts the
/// steps back to a piece that had been left.
class StagnationTest : public NOX::StatusTest::Generic
{
public:
  explicit StagnationTest(RCP<NewtonContext> context) : context_(std::move(context)) {}

  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic &solver, NOX::StatusTest::CheckType) override
  {
    const auto &group = solver.getSolutionGroup();
    const auto piece = context_->functional.piece(tpetra(group.getX()));
    if (solver.getNumIterations() == 0 || piece != piece_ || !(context_->step_length > newton_rules.full_step))
      headway_.start_over();
    const bool stuck = headway_.add(group.getNormF()) == Headway::Answer::stuck;
    status_ = stuck ? NOX::StatusTest::Failed : NOX::StatusTest::Unconverged;
    if (piece != piece_ && headway_.visit(piece) != Headway::Answer::progress) ++context_->returns;
    piece_ = piece;
    context_->stagnates = status_ == NOX::StatusTest::Failed;
    return status_;
  }
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream &print(std::ostream &out, const int indent) const override
  {
    return out << std::string(indent, ' ') << status_ << "residual falls, or the piece changes\n";
  }

private:
  RCP<NewtonContext> context_;
  std::uint64_t piece_ = 0;
  Headway headway_{{headway_rules.falls, newton_rules.most_idle - 1}}; // of residuals, since the piece last changed
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
};

/// Fails as soon as the run is to stop.
class InterruptTest : public NOX::StatusTest::Generic
{
public:
  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic &solver, NOX::StatusTest::CheckType) override
  {
    const auto &u = tpetra(solver.getSolutionGroup().getX());
    status_ = interrupted(*u.getMap()->getComm()) ? NOX::StatusTest::Failed : NOX::StatusTest::Unconverged;
    return status_;
  }
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream &print(std::ostream &out, const int indent) const override
  {
    return out << std::string(indent, ' ') << status_ << "no interrupt\n";
  }

private:
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
};

} // namespace

RCP<NOX::StatusTest::Generic> status_tests(const NewtonOptions &options)
{
  using namespace NOX::StatusTest;
  const RCP<Combo> tests = rcp(new Combo(Combo::OR));
  tests->addStatusTest(rcp(new FiniteValue));
  tests->addStatusTest(rcp(new InterruptTest));
  if (options.nox.isSublist("Status Tests")) {
    Teuchos::ParameterList list = options.nox.sublist("Status Tests");
    tests->addStatusTest(buildStatusTests(list, NOX::Utils()));
  }
  return tests;
}

RCP<NOX::StatusTest::Generic> newton_tests(const NewtonOptions &options, const RCP<NewtonContext> &context)
{
  using namespace NOX::StatusTest;
  if (options.nox.isSublist("Status Tests")) return Teuchos::null;
  const RCP<Combo> newton = rcp(new Combo(Combo::OR));
  newton->addStatusTest(rcp(new NormF(context->target_residual, NOX::Abstract::Vector::TwoNorm, NormF::Unscaled)));
  newton->addStatusTest(rcp(new StepTest(context, options.step_tolerance)));
  newton->addStatusTest(rcp(new StagnationTest(context)));
  return newton;
}

} // namespace rpc::solver
