// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "edge_marks.hpp"
#include "local_mesh.hpp"

namespace rpc::mesh
{

/// Divides cells of order 2 into cells of order 1 with the same nodes, numbers and owners; no communication. Children of a cell of
/// another rank stay where they touch a node of this one; nodes that no cell has are dropped.
LocalMesh divided(const LocalMesh &whole);

/// Divides triangles or tetrahedra some edges of which are halved; middle nodes of other edges are dropped, and nodes renumbered where there are
/// any. Collective.
/// @param whole  of order 2; nodes in the middle of edges that are not marked may be missing (-1)
LocalMesh divided(const LocalMesh &whole, const EdgeMarks &marks);

} // namespace rpc::mesh
