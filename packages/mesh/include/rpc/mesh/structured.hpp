// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"
#include "rpc/mesh/mesh_data.hpp"

#include <memory>
#include <optional>
#include <vector>

/// Coarser meshes of quadrilaterals and hexahedra that come from structured blocks: layers of cells joined in pairs. doc/theory.md, section 2
namespace rpc::mesh
{

/// A mesh whose cells are those of a finer one joined, with the same blocks, sides and points; no geometry.
struct CoarserMesh {
  MeshData mesh;
  std::vector<int> parent; ///< (finer cells)
  std::vector<int> kind;   ///< (finer cells) which kind of child, see Parents
  ChildVertices vertices;  ///< of each kind
};

/// What can be told of a whole mesh of quadrilaterals or hexahedra by its layers, see Layers.
struct LayeredMesh {
  std::optional<CoarserMesh> coarser; ///< none where no layers can be joined, or a joined cell would be inverted
  /// (nodes) Block by block of the grid, in each along its layers, the shortest direction fastest: neighbours lie alike.
  std::vector<int> order;
};

/// Linear in the number of cells but for the sort of `order`; one rank only.
/// @param mesh  any; of simplices it tells nothing
LayeredMesh layered(const MeshData &mesh);

/// Deals a mesh out as distribute() does, with the coarser meshes that its layers give, down to a few hundred unknowns: Mesh::parents leads to
/// them, the same on any number of ranks: small ones are on fewer of them. A rank has the parents of its cells. Where layers give none, or hardly smaller ones, it is distribute(). Collective.
/// @param whole  read on rank 0 only
std::shared_ptr<const Mesh> distribute_with_parents(MeshData whole, const RCP<const Comm> &comm);

} // namespace rpc::mesh
