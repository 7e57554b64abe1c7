// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"

#include <string>

namespace rpc::mesh
{

/// Divides the cells of a body that has several kinds of them, or wedges or pyramids, into triangles or tetrahedra of the same order, and
/// quadrilaterals of its sides and of its geometry likewise. A note tells how many cells became simplices; the simplices keep their cell's tag.
///
/// A cell in space is cut from its vertex with the smallest tag, and each quadrilateral face along the diagonal at its own smallest one, so
/// that both cells at a face, and the side there, are cut alike (Dompierre et al. 1999, How to subdivide pyramids, prisms and hexahedra
/// into tetrahedra). A quadrilateral of a plane body is cut along its shorter diagonal. With order 2 the middles of faces and cells, which lie
/// on the diagonals, become middles of edges: no node is new.
/// @param where  beginning of messages
/// @param made   whether gmsh has made them of a .geo: the note tells what makes one kind
/// @throws rpc::Error (bad_mesh) if cells are of several orders, name a node that there is not, do not fit at a face, or cannot be
///         divided since parts of them would be turned over
void divide_mixed_cells(const std::string &where, GmshContents &contents, bool made);

} // namespace rpc::mesh
