// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/iterate.hpp"
#include "rpc/solver/minimization_steps.hpp"

namespace rpc::analysis
{

/// The loop of a minimization after a multiplier update: one step to the minimum for the last active set, with the exact line search, then
/// Newton's steps. That set is a better guess than the states of lambda + r v at the old v.                 doc/theory.md (5.6)
///
/// Where the set stays the same and rounding leaves more than Newton's tolerance, the step ends the minimization: the residuals are judged
/// next, and if another step is needed it is made from a new origin (5.13), which rounding leaves less of.
solver::MinimizationSteps::Status minimize_from_same_active_set(const contact::Iterate &iterate,
                                                                solver::MinimizationSteps &steps);

} // namespace rpc::analysis
