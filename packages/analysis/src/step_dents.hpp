#pragma once

#include "rpc/analysis/solve_step.hpp"

#include <vector>

namespace rpc::analysis
{

/// The dents that are to be remembered, (owned nodes; sides), from those before the step, null for none. Collective.
/// @param sides  seen at the time of the step
RCP<const MultiVector> dents_after(const Problem &problem, const std::vector<contact::ContactOptions> &sides,
                                   const contact::ContactNodes &points, const StepSolution &s,
                                   const MultiVector *before);

/// Where a step is expected to lead from a displacement: along with the mean change of what is prescribed. Collective.
/// @param u  (owned dofs) [m]
Vector moved_along(const Problem &problem, double t, const Vector &u);

/// Whether the dents met have converged: their changes since the last solve are below a part of the deepest dent. Collective.
bool settled(const MultiVector &used, const MultiVector &met, const MultiVector &dents);

} // namespace rpc::analysis
