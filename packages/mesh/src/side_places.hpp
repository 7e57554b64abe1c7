// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/gmsh.hpp"
#include "rpc/mesh/mesh_data.hpp"

#include <string>
#include <vector>

namespace rpc::mesh
{

/// Adds the sides that a deck has chosen by number or place among the facets of the boundary.
/// @param mesh  has its geometry where a side is chosen by a surface's number or by a point
/// @throws rpc::Error (bad_input) if a side has no facets, a surface that the file lacks, or the name of another one
void add_sides(const std::vector<SidePlace> &places, MeshData &mesh);

} // namespace rpc::mesh
