// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/graph.hpp"
#include "rpc/mesh/mesh_data.hpp"

#include <vector>

/// Division of a whole mesh among ranks; private to distribute().
namespace rpc::mesh
{

/// The rank of each node and each cell of a whole mesh.
struct Division {
  std::vector<int> node_owner; // (nodes) rank
  std::vector<int> gid;        // (nodes)
  Lists nodes;                 // of each rank, by gid
  Lists cells;                 // of each rank
  Lists halo;                  // of each rank: cells of others that touch its nodes
};

/// METIS' cut, and the order of each rank's nodes; on one rank by itself.
/// @throws rpc::Error (bad_mesh) if there are fewer cells than ranks
/// @param weights  (cells) what each counts for, > 0; empty: all the same
Division divide(const MeshData &whole, int num_ranks, const std::vector<double> &weights = {});

} // namespace rpc::mesh
