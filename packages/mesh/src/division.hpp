// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/graph.hpp"
#include "rpc/mesh/mesh.hpp"
#include "rpc/mesh/mesh_data.hpp"

#include <vector>

/// Division of a whole mesh among ranks; private to distribute().
namespace rpc::mesh
{

/// The rank of each node and each cell of a whole mesh.
struct Division {
  std::vector<int> node_owner;       // (nodes) rank
  std::vector<int> gid;              // (nodes)
  Lists nodes;                       // of each rank, by gid
  Lists cells;                       // of each rank
  Lists halo;                        // of each rank: cells of others that touch its nodes
  std::vector<int> node_id, cell_id; // (nodes), (cells) the numbers that they keep in files; empty: those here
  bool sorts_cells =
      false; // those with the same lowest node by their other vertices: cells around alike nodes are alike in order
};

/// METIS' cut, and the order of each rank's nodes; on one rank by itself.
/// @throws rpc::Error (bad_mesh) if there are fewer cells than ranks
/// @param weights  (cells) what each counts for, > 0; empty: all the same
Division divide(const MeshData &whole, int num_ranks, const std::vector<double> &weights = {});

/// METIS' cut alone: a rank for each cell, none without cells.
std::vector<int> ranks_of_cells(const MeshData &whole, int num_ranks, const std::vector<double> &weights = {});

/// On how many ranks a coarser mesh is: those that it has enough cells for, at least one; the others have none of it.
int ranks_for(const MeshData &coarse, int num_ranks);

/// The division that gives each cell to a rank.
/// @param rank   (cells)
/// @param order  (nodes) in which each rank numbers its own; empty: so that neighbours lie close in memory
Division divide_by(const MeshData &whole, int num_ranks, const std::vector<int> &rank,
                   const std::vector<int> &order = {});

/// Deals the mesh out by a division, which is read on rank 0 only; collective on comm.
/// @param[out] halo  (local cells of other ranks) their ids, unless it is null
Mesh distribute(const MeshData &whole, const RCP<const Comm> &comm, const Division &division,
                std::vector<int> *halo = nullptr);

} // namespace rpc::mesh
