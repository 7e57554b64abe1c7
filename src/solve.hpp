// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"

#include <functional>
#include <optional>
#include <ostream>

namespace rpc
{

using adapt::Solution;
class Checkpoints;
class Notes;

/// Solves a deck's scene and tells the console about it; collective on comm.
/// @param console  where the table of the iteration goes; a stream without a buffer prints nothing
/// @param keep     called with the solution on each mesh of an adaptive run, from the first
/// @param keep_step  called with the solution of each load step, where there are several
/// @param checkpoints  of load steps, to go on from and to write
/// @param ready        called with each step that is about to be solved, and the notes until then; may throw to end the run
/// @throws rpc::Error on every rank if the scene does not fit its mesh; failing to converge is in the result
Solution solve(const Scene &scene, const RCP<const Comm> &comm, std::ostream &console,
               const std::function<void(const Scene &, Solution &)> &keep = {},
               const std::function<void(const Scene &, const analysis::Solution &)> &keep_step = {},
               Checkpoints *checkpoints = nullptr,
               const std::function<void(const analysis::Problem &, const analysis::Step &, const Notes &)> &ready = {});

/// All that solve() does before its first solve, the notes on the console included. Collective.
/// @return what was found: "nothing wrong with it: 10626 dofs, 161 contact points"; with notes that nothing is refused
/// @throws rpc::Error as solve()
std::string check(const Scene &scene, const RCP<const Comm> &comm, std::ostream &console, Checkpoints &checkpoints);

/// The message on a failure in a later load step: its time, its reason, and which results there are.
Error failure_of(const Solution &solution);

} // namespace rpc
