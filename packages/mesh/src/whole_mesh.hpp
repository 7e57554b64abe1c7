// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"
#include "rpc/mesh/mesh_data.hpp"
#include "rpc/mesh/size_field.hpp"

#include <vector>

namespace rpc::mesh
{

/// A mesh of one rank as plain arrays, nodes and cells by their ids.
MeshData whole_mesh(const Mesh &mesh);

/// (cells) Into how many cells refined_to() divides each cell of a mesh of triangles or tetrahedra, about, after some refinements.
std::vector<double> cells_to_come(const MeshData &mesh, const SizeField &sizes, int refinements);

} // namespace rpc::mesh
