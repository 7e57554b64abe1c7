// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/graph.hpp"
#include "rpc/mesh/mesh.hpp"

#include <optional>
#include <vector>

/// Which facets and edges cells have, and which cells lie around nodes, facets and edges. On the host.
namespace rpc::mesh
{

/// The facets of cells, or their edges, each with a number of its own.
///
/// Vertices alone tell them apart: with order 2, two cells whose facets have the same vertices share the facet. Numbers
/// ascend with the lists of vertices, so that they depend on the numbers of nodes alone.
struct Entities {
  int per_cell = 0;          ///< how many each cell has
  int num_vertices = 0;      ///< how many each has
  std::vector<int> vertices; ///< (entities, num_vertices) nodes, ascending
  std::vector<int> of_cell;  ///< (cells, per_cell) entity
  Lists occurrences;         ///< of each entity: cell * per_cell + ordinal, ascending

  int size() const { return occurrences.size(); }
  int num_cells_at(const int entity) const { return occurrences.size_of(entity); }
  int cell(const int entity, const int k) const { return occurrences.first(entity)[k] / per_cell; } ///< the k-th at it
  int ordinal(const int entity, const int k) const { return occurrences.first(entity)[k] % per_cell; } ///< in that cell

  /// The entity with these vertices, in any order; none if no cell has it.
  std::optional<int> find(std::vector<int> vertices) const;
};

/// @param cells  (cells, nodes per cell)
Entities facets_of(const Element &element, const std::vector<int> &cells);
Entities edges_of(const Element &element, const std::vector<int> &cells);

/// The cells at each node, ascending.
Lists node_to_cells(const Element &element, const std::vector<int> &cells, int num_nodes);
/// For each node the others of the same owner that share a cell with it.
/// @param cells_at  node_to_cells()   @param owner  (nodes)
Lists node_to_nodes(const Element &element, const std::vector<int> &cells, const Lists &cells_at,
                    const std::vector<int> &owner);

/// Facets and edges of one rank's cells.
///
/// Every facet and edge of the whole mesh is owned by one rank: that of its vertex with the lowest gid. All cells around an
/// owned one are local cells; around others there may be more than this rank has.
struct Topology {
  Entities facets, edges;
  std::vector<char> owns_facet; ///< (facets) 1 or 0
  std::vector<char> owns_edge;  ///< (edges) 1 or 0

  /// Whether an owned facet is part of the body's boundary.
  bool on_boundary(const int facet) const { return facets.num_cells_at(facet) == 1; }
};

/// Copies the cells to the host; no communication.
Topology topology(const Mesh &mesh);

} // namespace rpc::mesh
