// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh_data.hpp"
#include "rpc/mesh/topology.hpp"

#include <optional>
#include <vector>

/// Sheets of cells of quadrilaterals and hexahedra: what a structured grid calls layers, known from connectivity alone.
namespace rpc::mesh
{

/// Opposite edges of a cell are parallel. Edges that are parallel through any cells form a class; the cells that have them are a sheet, one cell
/// thick. Each cell lies in one sheet for each of its local directions. All edges of a sheet are directed alike.
struct Sheets {
  int dim = 0, count = 0;
  std::vector<int> of_cell;      ///< (cells, dim) sheet whose edges run along the cell's local direction
  std::vector<signed char> sign; ///< (cells, dim) 1 where that is the direction of the sheet's edges, else -1
  std::vector<double> thickness; ///< (sheets) mean length of the cells' edges in it [m]

  int at(const int cell, const int direction) const { return of_cell[std::size_t(dim) * cell + direction]; }
  int sign_at(const int cell, const int direction) const { return sign[std::size_t(dim) * cell + direction]; }
};

/// None where edges of a sheet cannot be directed alike, as in a Moebius strip.
/// @param mesh  of tensor products
std::optional<Sheets> sheets_of(const MeshData &mesh);

/// The direction of a cell's facet, and whether it lies at the upper end.
struct FacetPlace {
  int direction;
  bool upper;
};
/// (facets) Of a tensor product.
std::vector<FacetPlace> facet_places(const Element &element);

} // namespace rpc::mesh
