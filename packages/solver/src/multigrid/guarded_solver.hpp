// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multigrid/gathered_solver.hpp"

namespace rpc::solver
{

/// MueLu's direct coarse solver, which may live on one rank of several: where it fails it gives NaN instead of an exception that
/// only that rank would see, while the others wait for it. The norms of CG then tell all ranks.
class GuardedSolver : public CoarseSolver
{
public:
  /// @param direct  a prototype that can be set up
  explicit GuardedSolver(RCP<CoarseSolver> direct) : direct_(std::move(direct)) {}

  void DeclareInput(MueLu::Level &level) const override { direct_->DeclareInput(level); }
  void Setup(MueLu::Level &level) override;
  void Apply(XpetraVectors &x, const XpetraVectors &b, bool initial_guess_is_zero) const override;
  RCP<CoarseSolver> Copy() const override { return rcp(new GuardedSolver(direct_->Copy())); }
  std::size_t getNodeSmootherComplexity() const override { return direct_->getNodeSmootherComplexity(); }

private:
  RCP<CoarseSolver> direct_;
  bool failed_ = false; // in Setup
};

} // namespace rpc::solver
