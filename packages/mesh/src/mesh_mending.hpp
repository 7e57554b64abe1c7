// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"
#include "mesh_checks.hpp"

#include <string>

namespace rpc::mesh
{

/// Gives quadrilaterals of 8 nodes, hexahedra of 20, wedges of 15 and pyramids of 13 the nodes that those of 9, 27, 18 and 14 have besides, where
/// the map of their own nodes has the middle of a face or cell: the geometry stays what it is. A note says so.
/// @param where  beginning of messages
/// @throws rpc::Error (bad_mesh) if a cell names a node that there is not
void complete_serendipity(const std::string &where, GmshContents &contents);

/// Turns cells whose nodes run the wrong way round, as a mirrored mesh has them. A note tells how many.
void turn_mirrored_cells(TaggedMesh &draft);

} // namespace rpc::mesh
