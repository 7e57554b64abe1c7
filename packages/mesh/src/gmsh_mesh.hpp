// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"
#include "rpc/mesh/mesh_data.hpp"

namespace rpc::mesh
{

/// The mesh that gmsh made, checked: blocks, sides and nodes as read_gmsh() promises.
/// @param where      beginning of messages
/// @param any_nodes  whether nodes that no cell uses are no fault: a .geo has points that only serve to construct
/// @throws rpc::Error (bad_mesh)
MeshData mesh_of_gmsh(const std::string &where, GmshContents contents, bool any_nodes);

} // namespace rpc::mesh
