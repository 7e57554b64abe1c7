// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"
#include "rpc/mesh/size_field.hpp"

#include <memory>
#include <vector>

/// Nested refinement: each cell is halved in all directions, or those that a field of sizes tells. doc/theory.md, section 2
namespace rpc::mesh
{

/// A mesh with each cell of another one divided: triangles and quadrilaterals into 4, tetrahedra and hexahedra into 8. In a tetrahedron
/// the inner four share the shortest of three possible diagonals.
///
/// Each rank divides the cells that it has; cells belong to the rank of their parent. A new node belongs to the rank of the vertex with the
/// lowest id among those of the edge, face or cell in whose middle it lies: that rank has all cells around it. Ids do not depend on
/// the number of ranks: nodes of the coarse mesh keep theirs, children of a cell follow each other. New nodes lie in the
/// middle, of curved cells by their map (2.16); those of the boundary on its shape, where the mesh knows it (Mesh::geometry).
/// Sides, blocks, points and geometry go along. The result's Mesh::parents leads to the coarse mesh. Collective.
/// @throws rpc::Error on every rank: bad_input where the mesh cannot fit in memory or in a rank's numbers, bad_mesh where a cell would be inverted
Mesh refined(const std::shared_ptr<const Mesh> &coarse);

/// Halves triangles or tetrahedra that are larger than a field of sizes asks for: as a rule in all directions, at their longest edge where that
/// would make them too small. Neighbours are halved as far as needed to fit, longest edges first, so that angles stay bounded. All else as in
/// refined(); cells that stay are their own children.                                              doc/theory.md (2.18)
///
/// A cell, by its vertices, is small enough if its cell_size() is at most 2^(1/(2 dim)) times what the field asks for at its centre, so that the mesh
/// has about expected_cells(). Cells are halved level by level. A level is the parent of the next one, but for those that have hardly more nodes
/// than their own parent: they are left out. Collective.
/// @param sizes  the same on all ranks
/// @throws rpc::Error on every rank, as refined() does; bad_input where cells are no triangles or tetrahedra
std::shared_ptr<const Mesh> refined_to(std::shared_ptr<const Mesh> mesh, const SizeField &sizes);

/// Values of a parent's shape functions at the nodes of its children: (kinds of children, see Parents::kind; nodes of the child; nodes of the
/// parent). Rounding is 0.
using ChildWeights = std::vector<std::vector<std::vector<double>>>;
/// @param coarse, fine  of one shape and dimension; orders may differ
ChildWeights child_weights(const Element &coarse, const Element &fine, const ChildVertices &vertices);

} // namespace rpc::mesh
