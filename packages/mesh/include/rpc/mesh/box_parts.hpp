// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/element.hpp"

#include <vector>

namespace rpc::mesh
{

/// Cells of the mesh in one cell of a box' lattice: (parts, nodes per cell, dim) places of their nodes on the lattice {0..order}^dim.
using BoxParts = std::vector<Element::Table>;

/// A cell of the lattice is one tensor product, or simplices: two triangles, or six tetrahedra around its diagonal (Kuhn). One
/// follows the edges of the cell from corner to corner, by the directions in one order; neighbours fit, for all cells are divided
/// alike.
BoxParts box_parts(const Element &element);

} // namespace rpc::mesh
