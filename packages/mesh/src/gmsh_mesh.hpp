// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"
#include "rpc/mesh/mesh_data.hpp"

namespace rpc::mesh
{

/// The mesh that gmsh made, or that of a file, checked: blocks, sides and nodes as read_gmsh() promises.
/// @param where  beginning of messages
/// @param made   whether it was made of a geometry: nodes that no cell uses are no fault then, for points may only serve to construct
/// @throws rpc::Error (bad_mesh)
MeshData mesh_of_gmsh(const std::string &where, GmshContents contents, bool made);

} // namespace rpc::mesh
