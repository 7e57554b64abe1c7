#pragma once

#include "rpc/mesh/mesh_data.hpp"
#include "rpc/mesh/topology.hpp"

#include <cstddef>
#include <string>
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

/// @throws rpc::Error (bad_mesh) if a coordinate is not finite, a node is off the plane z = 0, or two are at one place
void check_nodes(const TaggedMesh &draft);

/// @throws rpc::Error (bad_mesh) if a cell names a node twice, is degenerate, or inverted anywhere
void check_cells(const TaggedMesh &draft);

/// For cells that passed check_cells().
/// @param facets  of the draft's cells
/// @throws rpc::Error (bad_mesh) if cells overlap at an edge, or share its ends but not its middle node
void check_facets(const TaggedMesh &draft, const Entities &facets);

/// The node in the middle of the facet `ordinal` of a cell; -1 with order 1.
int middle_node(const MeshData &mesh, int cell, int ordinal);

} // namespace rpc::mesh
