// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"
#include "mesh_checks.hpp"

#include <string>

namespace rpc::mesh
{

/// Gives quadrilaterals of 8 nodes and hexahedra of 20 the nodes that those of 9 and 27 have besides, where the map of the 8 or 20 nodes has
/// the middle of a face or cell: the geometry stays what it is. A note says so.
/// @param where  beginning of messages
/// @throws rpc::Error (bad_mesh) if a cell names a node that there is not
void complete_serendipity(const std::string &where, GmshContents &contents);

/// Turns cells whose nodes run the wrong way round, as a mirrored mesh has them. A note tells how many.
void turn_mirrored_cells(TaggedMesh &draft);

} // namespace rpc::mesh
