// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh_data.hpp"

#include <vector>

namespace rpc::mesh
{

/// A mesh whose nodes and cells are numbered so that those close in space are close in memory, whatever the order in its file.
struct SpatialOrder {
  MeshData mesh;
  std::vector<int> node_id, cell_id; ///< (nodes), (cells) their numbers before
};

/// (nodes) Along Morton's curve, see G. M. Morton, A computer oriented geodetic data base, IBM, 1966.
std::vector<int> along_morton_curve(const MeshData &mesh);

/// @param node_id  (nodes) what the new nodes' numbers are; cells follow their lowest new nodes, block by block
SpatialOrder renumbered(MeshData mesh, std::vector<int> node_id);

} // namespace rpc::mesh
