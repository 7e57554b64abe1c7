// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh_data.hpp"

namespace rpc::mesh
{

/// The plane mesh of order 1 as one of order 2, with straight edges: nodes in the middle of its edges, in the order of their
/// ends, and then in that of its quadrilaterals follow those that it has.
MeshData with_middle_nodes(MeshData mesh);

} // namespace rpc::mesh
