// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/problem.hpp"
#include "rpc/solver/linear_solver.hpp"

#include <memory>

namespace rpc::analysis
{

/// What changes while steps of a problem are solved: the Hessian, K with an update at the contact nodes, and the linear solver with its
/// preconditioner. It is the run's: one serves all steps, also where gaps, normals and loads change.
class SolverState
{
public:
  /// Cheap: a preconditioner is set up when the first solve asks for it. Collective.
  explicit SolverState(const Problem &problem, const solver::LinearSolverOptions &options = {});

  /// H = K + contact: each step writes its contact into it, and solves with it.
  const RCP<UpdatedOperator> &hessian() { return hessian_; }
  /// Solves with the present H, for a step or for any other right side.
  solver::LinearSolver &linear() { return *linear_; }
  const solver::LinearSolverOptions &options() const { return options_; } ///< as they were given

private:
  solver::LinearSolverOptions options_;
  RCP<UpdatedOperator> hessian_;
  std::unique_ptr<solver::LinearSolver> linear_;
};

} // namespace rpc::analysis
