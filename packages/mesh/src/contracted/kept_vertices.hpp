// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "features.hpp"

#include <vector>

namespace rpc::mesh
{

/// (vertices) 1 for those that a coarser mesh keeps: all corners, then as many vertices as there can be along the boundary's edges, then on its
/// faces, then inside, without two neighbours. Each is two edges of the mesh from another one where that can be: they grow from corners along
/// edges, from there over faces, and from these inwards. Of a regular grid that is every second vertex in each direction.
std::vector<char> kept_vertices(const MeshData &mesh, const Features &features);

} // namespace rpc::mesh
