// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/run.hpp"

namespace rpc::bound
{

/// An estimate of Q(u) - Q(u_h) for a load Q, u the exact solution: weighted by what the load moves with contact states as they are. No bound.
/// Collective.                                                                                            doc/bounds.md (13.19)
/// @param Q  (owned dofs) forces   @return NaN where the linear solve fails
double estimated_error(const analysis::Problem &problem, const analysis::StepSolution &solution,
                       const solver::LinearSolverOptions &options, const Vector &Q);

} // namespace rpc::bound
