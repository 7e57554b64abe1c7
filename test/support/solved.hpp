// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/solve_step.hpp"

namespace rpc::test
{

/// A step from rest, with a preconditioner of its own.
inline analysis::StepSolution solved(const analysis::Problem &problem, const analysis::Step &step,
                                     const analysis::StepOptions &options = {},
                                     const solver::LinearSolverOptions &linear = {})
{
  analysis::SolverState state(problem, linear);
  return analysis::solve_step(problem, step, state, options);
}

} // namespace rpc::test
