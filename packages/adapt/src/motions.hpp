// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/adapt/cycle.hpp"

namespace rpc::adapt
{

/// What forces move, of a solution.
Motions motions_of(const analysis::StepSolution &s);

} // namespace rpc::adapt
