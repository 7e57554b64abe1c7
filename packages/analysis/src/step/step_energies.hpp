// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/memory.hpp"
#include "rpc/analysis/solve_step.hpp"

namespace rpc::analysis
{

/// Forces on the body from all but the foundation, f_int + sum of w p nu (owned dofs, [N]): loads, and at prescribed unknowns
/// the reactions too.
Vector other_forces(const Problem &problem, const StepSolution &s);

/// (points) The gap that changes by motion alone: g, and where points move along dents that too [m].
/// @param dent  (points) that they stand on
DeviceView<double *> moving_gap(const Problem &problem, const contact::ContactNodes &points,
                                const DeviceView<double *> &dent);

/// The energies after a step that began at `before`, null for the first one. (11.3)
/// @param t             of the step
/// @param force_before  see other_forces(), at `before`; null: not known
/// @param force         the same after the step
Energies energies_after(const Problem &problem, double t, const StepSolution &s, const Memory *before,
                        const Vector *force_before, const Vector &force);

} // namespace rpc::analysis
