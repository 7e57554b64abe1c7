// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"

namespace rpc::mesh
{

/// Opens what a request names: a .geo, a file of shapes or a mesh. The parts of a file of shapes are joined where they touch, and the surface
/// of an STL is divided at its edges and filled. Faces in space without a solid are sewn.
/// @param[in,out] notes  what the user should know of it
/// @return why that cannot be done; "" if it is
std::string open_file(const GmshRequest &request, std::vector<std::string> &notes);

/// gmsh's complaint, with a remedy where a .geo merges a file of a format that gmsh takes for a script.
std::string with_remedy(const std::string &complaint);

/// Why there is no cell after a mesh of a .geo, where that can be told: the surfaces are triangles of an STL. "" otherwise.
std::string why_no_cells(const GmshContents &contents);

/// The sizes of cells that a file of shapes has none of.
void set_own_size(const GmshRequest &request);

/// About how many nodes a file of shapes would have at the size of cells that is asked for: what lattices of it have in its surfaces and
/// volumes. 0: not known.
double expected_nodes(const GmshRequest &request);

/// The groups of a file of shapes, with their elements: its volumes are blocks, and all surfaces of the boundary are sides, by the names that
/// the file gives them, else by their numbers, "surface 7". In the plane surfaces and curves.
void take_shapes(GmshContents &contents);

} // namespace rpc::mesh
