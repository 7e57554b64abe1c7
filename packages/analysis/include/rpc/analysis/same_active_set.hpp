// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/iterate.hpp"
#include "rpc/solver/first_stage.hpp"

namespace rpc::analysis
{

/// After a multiplier update: one step to the minimum for the active set that the last minimization ended on, as far as the
/// functional falls on the way there. That is a better guess than the states of lambda + r v at the old v. doc/theory.md (5.6)
///
/// Where the set stays the same and rounding leaves more than Newton's tolerance, the step ends the minimization: the residuals are judged
/// next, and if another step is needed it is made from a new origin (5.13), which rounding leaves less of.
class SameActiveSet : public solver::FirstStage
{
public:
  explicit SameActiveSet(const contact::Iterate &iterate) : iterate_(iterate) {}

  Verdict judge(const solver::NewtonGroup &at) override;
  Step propose(solver::NewtonGroup &group, Vector &direction) override;

  int steps() const { return steps_; } ///< of the stage: 0 or 1

private:
  const contact::Iterate &iterate_;
  bool proposed_ = false;
  int steps_ = 0;
  double norm_before_ = 0;
};

} // namespace rpc::analysis
