// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"
#include "rpc/mesh/mesh_data.hpp"

namespace rpc::mesh
{

/// Deals a mesh that rank 0 holds out to all ranks, each of which keeps its part only; collective on comm.
///
/// METIS cuts the cells into one part per rank with the fewest shared nodes; a node belongs to the lowest of the parts
/// around it. Each rank numbers its own nodes and cells so that neighbours lie close in memory. The result depends on
/// nothing but the mesh and the number of ranks.
/// @param whole    read on rank 0 only
/// @param weights  (cells) what each counts for, > 0, read on rank 0 only; empty: all the same
/// @throws rpc::Error (bad_mesh) on every rank if there are fewer cells than ranks
Mesh distribute(const MeshData &whole, const RCP<const Comm> &comm, const std::vector<double> &weights = {});

} // namespace rpc::mesh
