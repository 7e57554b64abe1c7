// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/element.hpp"
#include "rpc/mesh/geometry.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace rpc::mesh
{

/// A body's size must be within these, or products of lengths would leave the doubles [m].
constexpr double least_size = 1e-50, greatest_size = 1e50;

/// Characters of the name of a side or block; an Exodus file holds no more.
constexpr std::size_t longest_name = 255;

/// A named part of the boundary of a whole mesh, each facet once.
struct SideData {
  std::string name;
  std::vector<int> cell;    ///< (facets) cell that the facet belongs to, 0-based
  std::vector<int> ordinal; ///< (facets) which facet of that cell, see Element::facets
};

/// Named nodes of a whole mesh that are no side: the corners of a box, physical points of gmsh.
struct PointData {
  std::string name;
  std::vector<int> node; ///< 0-based, ascending
};

/// A whole mesh on one rank, as a generator or a file gives it: plain arrays, row by row. distribute() deals it out.
///
/// All nodes are used by cells, none twice; every cell belongs to one block. Numbers are 0-based and become
/// Mesh::node_id and Mesh::cell_id.
struct MeshData {
  Element element;
  std::vector<double> coords;      ///< (nodes, dim) [m]
  std::vector<int> cells;          ///< (cells, nodes per cell)
  std::vector<std::string> blocks; ///< names of the parts of the body, at least one
  std::vector<int> block;          ///< (cells) index into blocks
  std::vector<SideData> sides;
  std::vector<PointData> points;
  std::vector<BoundaryPart> geometry; ///< what facets lie on, where it was asked for
  std::string geometry_file;          ///< the .geo by which gmsh tells points of shapes without closed formulas
  std::vector<std::string> notes;     ///< what was mended, or left out, of a file

  int num_nodes() const { return static_cast<int>(coords.size()) / element.dim; }
  int num_cells() const { return static_cast<int>(cells.size()) / element.num_nodes(); }
};

} // namespace rpc::mesh
