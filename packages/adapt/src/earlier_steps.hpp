// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/adapt/cycle.hpp"
#include "rpc/adapt/options.hpp"
#include "rpc/adapt/solve.hpp"

#include <optional>

namespace rpc::adapt
{

/// The options of a mesh of the same body with cells about twice as long; none if there is none to be had: for a .msh.
std::optional<mesh::MeshOptions> with_larger_cells(const mesh::MeshOptions &options);

/// What counts of the load steps up to a solution, for its error bars.                                 doc/theory.md (10.7c)
EarlierSteps earlier_steps(const Task &task, const Solution &s);

/// left_by_misreading() of a step and of those before it: the most.
LeftOpen misread_so_far(const Solution &s);

/// What a step leaves for the next one, which reads nothing else of it.
analysis::HistoryState state_of(const Solution &s);

/// The step that left it, without its solution.
Solution step_of(analysis::HistoryState state);

} // namespace rpc::adapt
