#pragma once

#include "rpc/contact/iterate.hpp"
#include "rpc/solver/first_stage.hpp"

namespace rpc::analysis
{

/// After a multiplier update: one step to the minimum for the active set that the last minimization ended on, as far as the
/// functional falls on the way there. That is a better guess than the states of lambda + r v at the old v. doc/theory.md (5.6)
class SameActiveSet : public solver::FirstStage
{
public:
  explicit SameActiveSet(const contact::Iterate &iterate) : iterate_(iterate) {}

  Verdict judge(const solver::NewtonGroup &at) override;
  Step propose(solver::NewtonGroup &group, Vector &direction) override;

private:
  const contact::Iterate &iterate_;
  bool proposed_ = false;
};

} // namespace rpc::analysis
