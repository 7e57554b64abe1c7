// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "local_mesh.hpp"
#include "rpc/core/graph.hpp"

#include <vector>

namespace rpc::mesh
{

/// The edges, the faces or the cells of a mesh of order 1, in the middle of which it gets nodes.
///
/// Each belongs to the rank of its vertex with the lowest id, which has all cells around it.
struct Middles {
  int width = 0;              ///< vertices of each
  int per_cell = 0;           ///< how many a cell has
  std::vector<int> vertices;  ///< (middles, width) node lids, by ascending id
  std::vector<int> of_cell;   ///< (cells, per_cell); -1: not among them
  std::vector<int> slot;      ///< (per_cell) which node of the cell of order 2 lies there
  std::vector<char> in_place; ///< (middles) 1: the coarse mesh has a node there, which does not move; empty: nowhere
  Lists at_vertex;            ///< (overlap nodes) those whose first vertex it is, by the ids of the other ones

  int size() const { return static_cast<int>(vertices.size()) / width; }
  const int *vertices_of(const int middle) const { return &vertices[std::size_t(width) * middle]; }
  const int *of(const int cell) const { return &of_cell[std::size_t(per_cell) * cell]; }
  int owner_vertex(const int middle) const { return *vertices_of(middle); }
};

/// Edges; faces of hexahedra; cells that are tensor products.
std::vector<Middles> middles_of(const LocalMesh &mesh);

/// Ids of the middles that this rank owns, which follow `first` and do not depend on the number of ranks; -1: another rank's. Collective.
/// @param[in,out] first  the first id, then the first that is left
std::vector<GO> ids_of(const LocalMesh &mesh, const Middles &middles, GO &first);

/// For each number that this rank has the sum of the counts of all lower numbers. Each rank sums over a range of numbers; collective.
/// @param num_ids     0 .. num_ids - 1 over all ranks, each on one
/// @param id, count   of this rank's
/// @param[out] total  of all counts
std::vector<GO> sums_before(const Comm &comm, GO num_ids, const std::vector<GO> &id, const std::vector<int> &count,
                            GO &total);

/// Ranks of nodes by their gids; collective.
std::vector<int> owners_of(const LocalMesh &mesh, const std::vector<GO> &gids);

} // namespace rpc::mesh
