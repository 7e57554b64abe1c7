// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/solver/newton_group.hpp"
#include "rpc/solver/sweep_direction.hpp"

#include <NOX_Direction_Generic.H>
#include <NOX_Direction_UserDefinedFactory.H>
#include <NOX_StatusTest_Generic.H>

namespace rpc::solver
{

/// Steps of one's own within a NOX solver, before Newton's: such as those of an active-set iteration. NOX's loop, its printing
/// and its observers see them like any others. All members are collective.
class FirstStage
{
public:
  enum class Verdict {
    go_on,
    converged, ///< this is the minimum
    over       ///< Newton's directions and status tests take over from here
  };
  /// What to do with a step.
  enum class Step {
    full,   ///< take it as it is
    search, ///< search along it
    none    ///< there is none: the stage is over
  };
  virtual ~FirstStage() = default;
  /// Judges a point; once for each, the start included.
  virtual Verdict judge(const NewtonGroup &at) = 0;
  /// @param[in,out] group  may be moved before the step; F is computed  @param[out] direction
  virtual Step propose(NewtonGroup &group, Vector &direction) = 0;
  /// After each of Newton's steps. @return whether the stage takes over once more, from this point
  virtual bool resume(const NewtonGroup &, const NewtonProgress &) { return false; }
};

/// The stage's steps, then Newton's directions after sweeps, as a NOX direction for NewtonGroup. After each of Newton's steps the
/// stage may resume.
class StagedDirection : public NOX::Direction::Generic
{
public:
  bool reset(const Teuchos::RCP<NOX::GlobalData> &, Teuchos::ParameterList &) override { return true; }
  bool compute(NOX::Abstract::Vector &direction, NOX::Abstract::Group &group,
               const NOX::Solver::Generic &solver) override;

private:
  SweepDirection sweep_;
};

/// Hands StagedDirection to NOX ("Direction" -> "Method" = "User Defined").
class StagedDirectionFactory : public NOX::Direction::UserDefinedFactory
{
public:
  Teuchos::RCP<NOX::Direction::Generic> buildDirection(const Teuchos::RCP<NOX::GlobalData> &,
                                                       Teuchos::ParameterList &) const override;
};

/// The stage's verdict, then Newton's own tests.
class StagedTest : public NOX::StatusTest::Generic
{
public:
  StagedTest(RCP<NewtonContext> context, RCP<NOX::StatusTest::Generic> newton)
      : context_(std::move(context)), newton_(std::move(newton))
  {
  }
  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic &solver, NOX::StatusTest::CheckType type) override;
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream &print(std::ostream &out, int indent) const override;

private:
  RCP<NewtonContext> context_;
  RCP<NOX::StatusTest::Generic> newton_;
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
};

} // namespace rpc::solver
