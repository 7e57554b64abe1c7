// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/node_patches.hpp"
#include "rpc/mesh/box.hpp"

namespace rpc::mesh
{

/// For each vertex of a box that this rank owns, the nodes inside the cells around it: the functions that vanish outside these cells. In 3D
/// up to 3 x 3 x 3 nodes of order 2.
NodePatches vertex_stars(const BoxOptions &box, const Comm &comm);

/// The nodes of a box that lie inside each cell of the coarser box, which is halved(box). A patch is on the rank that owns its first node.
NodePatches inside_cells_of(const BoxOptions &coarse, const BoxOptions &box, const Comm &comm);

} // namespace rpc::mesh
