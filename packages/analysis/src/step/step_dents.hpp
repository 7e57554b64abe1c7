// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/memory.hpp"
#include "rpc/analysis/solve_step.hpp"

#include <vector>

namespace rpc::analysis
{

/// Takes a step's dents into what is remembered, and those of all nodes and of whole foundations into its results. Collective.
/// @param sides   seen at the time of the step
/// @param before  what the step before has left; null: there was none
void remember_dents(const Problem &problem, const std::vector<contact::ContactOptions> &sides,
                    const contact::ContactNodes &points, const Memory *before, StepSolution &s, Memory &memory);

/// The predicted displacement of a step: u and the mean change of what is prescribed. Collective.
/// @param u  (owned dofs) [m]
Vector moved_along(const Problem &problem, double t, const Vector &u);

/// Whether the dents met have converged: their changes since the last solve are below this part of the deepest dent of each side. Collective.
bool settled(const MultiVector &used, const MultiVector &met, const std::vector<contact::FoundationDents> &foundations,
             double tolerance);

} // namespace rpc::analysis
