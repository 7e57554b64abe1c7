#pragma once

#include "rpc/mesh/mesh_data.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace rpc::mesh
{

/// A plane mesh in the making, with what messages about it need.
struct TaggedMesh {
  std::string where; ///< what messages begin with
  MeshData mesh;
  std::vector<double> z;             ///< (nodes) [m], 0 in a good mesh
  std::vector<std::size_t> node_tag; ///< (nodes) the file's numbers, ascending
  std::vector<int> node_of_tag;      ///< (tags) -1 where there is none; empty if tags are far apart
  std::vector<std::size_t> cell_tag; ///< (cells)
};

/// A facet of a cell, by its end nodes in ascending order.
struct Edge {
  int low = 0, high = 0;
  int middle = -1; ///< node, with order 2
  int cell = 0, ordinal = 0;

  std::pair<int, int> nodes() const { return {low, high}; }
};

/// @throws rpc::Error (bad_mesh) if a coordinate is not finite, a node is off the plane z = 0, or two are at one place
void check_nodes(const TaggedMesh &draft);

/// @throws rpc::Error (bad_mesh) if a cell names a node twice, is degenerate, or inverted anywhere
void check_cells(const TaggedMesh &draft);

/// The facets of all cells, by their nodes. For cells that passed check_cells().
/// @throws rpc::Error (bad_mesh) if cells overlap at an edge, or share its ends but not its middle node
std::vector<Edge> checked_edges(const TaggedMesh &draft);

} // namespace rpc::mesh
