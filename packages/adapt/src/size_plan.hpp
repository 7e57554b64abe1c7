// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/adapt/new_sizes.hpp"
#include "rpc/mesh/element.hpp"

#include <vector>

namespace rpc::adapt
{

/// Cells of a mesh by a field of sizes that stand for one of an element: in space six tetrahedra for a hexahedron.
inline int cells_per_cell(const mesh::Element &element)
{
  return element.dim == 3 && element.shape == mesh::Shape::tensor ? 6 : 1;
}

/// A mesh with the error of each cell, whole and on the host, rows by id.
struct EstimatedMesh {
  int order = 1;                                 ///< of the elements
  int vertices = 3;                              ///< per cell: 3 or 4, in space 4 or 8
  std::vector<double> coords;                    ///< (nodes, dim) [m]; only vertices matter
  std::vector<int> cells;                        ///< (cells, vertices) nodes, in the plane counter-clockwise
  std::vector<double> squared;                   ///< (cells) eta_T^2 [J]
  int dim = 2;                                   ///< 2 or 3
  std::vector<double> unseen_squared, seen_from; ///< (cells) see ErrorEstimate; empty: nothing is unseen

  int num_cells() const { return static_cast<int>(squared.size()); }
  int num_nodes() const { return static_cast<int>(coords.size()) / dim; }
  const double *at(const int node) const { return &coords[std::size_t(dim) * node]; }
  const int *vertices_of(const int cell) const { return &cells[std::size_t(vertices) * cell]; }
  bool simplices() const { return vertices == dim + 1; }
  int cells_per_cell() const
  {
    return adapt::cells_per_cell({dim, order, simplices() ? mesh::Shape::simplex : mesh::Shape::tensor});
  }
};

/// New cell sizes.
struct SizePlan {
  mesh::SizeField
      field;        ///< the mesh's vertices in the order of their first appearance in its cells, then further points
  double cells = 0; ///< expected number
};

/// See new_sizes().                                                                      doc/theory.md (10.5), (10.6)
SizePlan plan_sizes(const EstimatedMesh &mesh, const SizeRequest &request);

/// The exponent lambda of |u| ~ r^lambda about each vertex at the boundary, as far as the decay of the errors around it shows;
/// the order plus 1 or more where u is smooth, and at all other nodes. (nodes)                                    (10.6)
/// @param negligible  squared error of the whole mesh [J] that is no sign of a singularity
std::vector<double> local_exponents(const EstimatedMesh &mesh, double negligible = 0);

} // namespace rpc::adapt
