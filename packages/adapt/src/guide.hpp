// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/adapt/solve.hpp"

namespace rpc::adapt
{

/// The estimate that meshes follow: with a guaranteed bound its local terms, in which unseen contact is counted.         doc/bounds.md (13.1)
ErrorEstimate guide(const Solution &s);

/// What the target is a limit of: the relative error, estimated or bounded. Without a bound that is asked for nothing is known.
double relative_error(const Task &task, const Solution &s);

/// Of meshes that follow a first one with such cells.
/// @throws rpc::Error (bad_input) where guaranteed bounds do not cover them
void require_coverable_meshes(const Task &task, const mesh::Element &first);

} // namespace rpc::adapt
