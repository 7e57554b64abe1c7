// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/solve_step.hpp"

namespace rpc::analysis
{

/// How soft what forces move is after the last linear solve, whose contact states are those of the solution. Collective.
Softness softness_of(const Problem &problem, const fem::DirichletDofs &dirichlet, SolverState &state);

} // namespace rpc::analysis
