// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh_data.hpp"

#include <array>
#include <string>
#include <vector>

/// What can be told of a file with a body before there is a deck.
namespace rpc::mesh
{

/// Facets of a boundary, or cells of a block.
struct PartSummary {
  std::string name;   ///< of a side or block; of a surface of a geometry what it lies on: "plane", "sphere"
  int tag = 0;        ///< of a surface its number
  int count = 0;      ///< facets or cells
  double measure = 0; ///< [m^dim], [m^(dim - 1)]
  std::array<double, 3> centroid{};       ///< [m]
  std::array<double, 3> normal{};         ///< mean of the outward unit normal; shorter than 1 where the part is bent
  std::array<double, 3> lower{}, upper{}; ///< corners of the box around it [m]
};

struct MeshSummary {
  Element element;
  int num_nodes = 0, num_cells = 0;
  std::vector<PartSummary> blocks, sides, surfaces;        ///< surfaces of a geometry, in the plane curves
  PartSummary body, boundary;                              ///< all cells, and all facets of the boundary
  double least_edge = 0, mean_edge = 0, greatest_edge = 0; ///< of cells, between vertices [m]
  /// Of cells: the least determinant at a vertex of the directions of its edges, 1 for regular ones (Verdict's scaled Jacobian).
  double least_quality = 0, mean_quality = 0;
};

MeshSummary summary_of(const MeshData &mesh);

} // namespace rpc::mesh
