// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

namespace rpc::mesh
{

/// Cell sizes that a mesh is to have, given at the nodes of another mesh of about the same body: linear in each of its simplices, which are
/// triangles, in space tetrahedra; outside of all of them (curved boundaries) that of the nearest point.
///
/// A mesh follows it well where sizes grow by up to a fifth of the distance, and in the plane has up to a half more cells where they grow by
/// a half.
struct SizeField {
  std::vector<double> coords; ///< (nodes, dim) [m]
  std::vector<int> simplices; ///< (simplices, dim + 1) nodes, 0-based
  std::vector<double> size;   ///< (nodes) edge lengths [m], > 0
  int dim = 2;                ///< 2 or 3
};

/// Tetrahedra that gmsh makes in a cube whose edges have the size that is asked for: their edges are longer by about a sixth. (Measured on
/// graded meshes of a ball: 4.3 to 6.1.)
inline constexpr double tetrahedra_per_cube = 5;

/// Places of a triangle's or tetrahedron's vertices [m].
template <int dim>
using SimplexVertices = std::array<std::array<double, dim>, dim + 1>;

/// The size of a cell by which a mesh of equal ones has expected_cells() [m]: an edge of a regular triangle of its area, in space the edge of
/// a cube of tetrahedra_per_cube times its volume.
/// @tparam dim  2 or 3
template <int dim>
double cell_size(const SimplexVertices<dim> &vertex);

/// About how many cells a mesh of triangles or tetrahedra has that follows the field: the integral of 4 / (sqrt(3) size^2), in space of
/// tetrahedra_per_cube / size^3.
double expected_cells(const SizeField &field);

/// @param where  what messages begin with
/// @throws rpc::Error (bad_mesh) if sizes are not > 0 and finite, or simplices name nodes that do not exist
void check_sizes(const std::string &where, const SizeField &field);

} // namespace rpc::mesh
