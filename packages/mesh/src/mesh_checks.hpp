// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/error.hpp"
#include "rpc/mesh/mesh_data.hpp"
#include "rpc/mesh/topology.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace rpc::mesh
{

/// A mesh before it is checked, with the names that messages need.
struct TaggedMesh {
  std::string where; ///< what messages begin with
  MeshData mesh;
  std::vector<double> z;             ///< (nodes) [m] of a plane mesh, 0 in a good one; empty in space
  std::vector<std::size_t> node_tag; ///< (nodes) the file's numbers, ascending
  std::vector<int> node_of_tag;      ///< (tags) -1 where there is none; empty if tags are far apart
  std::vector<std::size_t> cell_tag; ///< (cells)
  std::string overlap_remedy;        ///< what to do where cells overlap; empty if nothing is known
};

/// The node with that tag, -1 if cells use none.
int find_node(const TaggedMesh &draft, std::size_t tag);

/// @throws rpc::Error (bad_mesh) if a coordinate is not finite, a node of a plane mesh is off the plane z = 0, or two are at
///         one place
void check_nodes(const TaggedMesh &draft);

/// A cell whose curved edges bend so far that it is inverted; gmsh's optimizer may straighten it.
class BentCell : public Error
{
public:
  using Error::Error;
};

/// @throws BentCell (bad_mesh)
/// @throws rpc::Error (bad_mesh) if a cell names a node twice, is degenerate, or inverted otherwise
void check_cells(const TaggedMesh &draft);

/// Those of some cells that are degenerate or inverted somewhere.
/// @param coords  (nodes, dim)   @param cells  (cells, nodes per cell)   @param which  cells to look at
std::vector<int> inverted_cells(const Element &element, const std::vector<double> &coords,
                                const std::vector<int> &cells, const std::vector<int> &which);

/// For cells that passed check_cells().
/// @param facets  of the draft's cells
/// @throws rpc::Error (bad_mesh) if cells overlap at a facet, or share the vertices of an edge or face but not its middle
///         node, or not in one order around a face
void check_facets(const TaggedMesh &draft, const Entities &facets);

/// The nodes of a cell's facet, in the order of Element::facets.
std::vector<int> nodes_of_facet(const MeshData &mesh, int cell, int ordinal);

} // namespace rpc::mesh
