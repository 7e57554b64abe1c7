// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"
#include "rpc/mesh/mesh_data.hpp"

#include <string>
#include <vector>

namespace rpc::mesh
{

/// A rank's part of a mesh on the host, in plain arrays, while it is refined. As in Mesh owned nodes and cells come first.
struct LocalMesh {
  Element element;
  RCP<const Map> owned_nodes;
  std::vector<GO> gid, id;    ///< (overlap nodes)
  std::vector<double> coords; ///< (overlap nodes, dim) [m]
  std::vector<char> moved;    ///< (overlap nodes) whether its place is not where the coarse mesh has it
  std::vector<int> cells;     ///< (local cells, nodes per cell) overlap node lids
  std::vector<int> block;     ///< (local cells)
  std::vector<GO> cell_id;    ///< (owned cells)
  std::vector<SideData> sides;
  std::vector<BoundaryPart> geometry;
  std::vector<PointData> points;
  std::vector<LO> parent;       ///< (local cells) of the mesh before
  std::vector<int> kind;        ///< (local cells)
  ChildVertices child_vertices; ///< of each kind

  int dim() const { return element.dim; }
  int num_owned_nodes() const { return num_local(*owned_nodes); }
  int num_nodes() const { return static_cast<int>(gid.size()); }
  int num_owned_cells() const { return static_cast<int>(cell_id.size()); }
  int num_cells() const { return static_cast<int>(block.size()); }
  const int *nodes_of(const int cell) const { return &cells[std::size_t(element.num_nodes()) * cell]; }
};

/// Collective.
LocalMesh local_mesh(const Mesh &mesh);

/// Without the owned nodes that no cell has: ids and gids of the others close up. Collective.
LocalMesh without_unused_nodes(LocalMesh mesh);

/// The mesh of `local`; names, and where the geometry is from, are those of the coarse one. Collective.
Mesh mesh_of(const LocalMesh &local, const std::shared_ptr<const Mesh> &coarse);

} // namespace rpc::mesh
