#pragma once

#include "local_mesh.hpp"

namespace rpc::mesh
{

/// Divides cells of order 2 into cells of order 1 with the same nodes, numbers and owners; no communication. Children of a cell of
/// another rank stay where they touch a node of this one; nodes that no cell has are dropped.
LocalMesh divided(const LocalMesh &whole);

} // namespace rpc::mesh
