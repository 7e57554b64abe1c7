// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/solver/newton_group.hpp"

#include <NOX_Solver_Generic.H>
#include <NOX_StatusTest_Generic.H>
#include <functional>

namespace rpc::solver
{

/// The steps of one minimization, as its loop asks for them. NOX makes each, with its line search and its printing, and counts them; a deck's
/// status tests see all of them. All members are collective.
class MinimizationSteps
{
public:
  enum class Status { goes_on, converged, failed };
  static Status status_of(NOX::StatusTest::StatusType status);
  /// @param nox    has the group
  /// @param newton_tests  Newton's tests; null: the deck's "Status Tests", which NOX has, stand in their place
  MinimizationSteps(RCP<NewtonGroup> group, RCP<NOX::Solver::Generic> nox, RCP<NOX::StatusTest::Generic> newton_tests,
                    int most_steps)
      : group_(std::move(group)), nox_(std::move(nox)), newton_tests_(std::move(newton_tests)), most_steps_(most_steps)
  {
  }

  NewtonGroup &at() { return *group_; } ///< the present point, where F is computed
  NewtonContext &context() { return group_->context(); }
  void move_to(const RCP<Vector> &u); ///< no step
  /// The deck's tests end the minimization: neither Newton's do nor those of a loop.
  bool user_decides() const { return newton_tests_.is_null(); }
  bool stepped() const { return stepped_; } ///< some step was asked for

  /// A step along a direction of the loop's: as it is, or searched, as far as the functional falls.
  Status take(const RCP<const Vector> &direction, bool search = false);
  Status stay(); ///< a step of length 0
  Status newton_step();
  Status newton_begins(); ///< Newton's tests where another method has led to
  Status newton_to_end(Status status);
  /// After the deck's "Maximum Iterations" failed, unless it is over.
  Status unless_last(Status status) const;

private:
  Status step();
  Status judge_newton();

  RCP<NewtonGroup> group_;
  RCP<NOX::Solver::Generic> nox_;
  RCP<NOX::StatusTest::Generic> newton_tests_;
  int most_steps_;
  bool stepped_ = false;
};

/// Chooses the steps of a minimization, from its start to its end.
using MinimizationLoop = std::function<MinimizationSteps::Status(MinimizationSteps &)>;

} // namespace rpc::solver
