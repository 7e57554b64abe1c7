// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"
#include "rpc/mesh/mesh_data.hpp"

#include <memory>
#include <optional>

/// Coarser meshes of triangles and tetrahedra by contraction of edges. doc/theory.md, section 2
namespace rpc::mesh
{

/// A mesh of the same body with cells about twice as long, of order 1. Of the vertices those are kept of which no two share an edge, and each other
/// one is moved onto a neighbour: cells with both are gone, others are stretched. A vertex stays where all neighbours would invert or flatten a cell,
/// or turn a facet of the boundary by more than 37 degrees. Vertices are some of the finer ones; blocks, sides and named points are the same, and
/// edges and corners of the boundary stay.
/// @param mesh  of order 1 or 2; of the latter, cells between the vertices are taken for straight
/// @return none of quadrilaterals and hexahedra, where more than 70 % of the vertices would stay, or where a middle node has a name
std::optional<MeshData> contracted(const MeshData &mesh);

/// Deals a mesh out as distribute() does, with the coarser meshes that contraction gives, down to a few hundred unknowns: Mesh::parents leads to
/// them. Where there are none it is distribute(). Collective.
/// @param whole  read on rank 0 only
std::shared_ptr<const Mesh> distribute_with_contracted(MeshData whole, const RCP<const Comm> &comm);

} // namespace rpc::mesh
