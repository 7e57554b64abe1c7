// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/element.hpp"

#include <array>
#include <vector>

namespace rpc::mesh
{

/// int f ~ sum_q weight_q f(point_q) over a reference cell.
struct QuadratureRule {
  std::vector<std::array<double, 3>> point; ///< (points) coordinates beyond the cell's dimension are 0
  std::vector<double> weight;               ///< (points) > 0; of nodal_rule() >= 0

  int num_points() const { return static_cast<int>(weight.size()); }
};

/// A rule with points inside the reference cell that is exact for polynomials up to a degree: in each coordinate for tensor
/// products (Gauss), in all together for simplices. The first coordinate runs fastest.
/// @param degree  >= 0; at most 7 for tensor products, 6 for triangles, 5 for tetrahedra
/// @throws rpc::Error (internal_error) if there is no rule of that degree
QuadratureRule quadrature(int dim, Shape shape, int degree);

/// Degree for which quadrature() is exact for the stiffness of an affine cell, and in a curved one for the nodal forces of a
/// constant stress: their integrands are polynomials of degree dim (order - 1) in simplices.
int stiffness_degree(const Element &element);

/// The rule with points at an element's nodes, in their order, for intervals, quadrilaterals and triangles.
///
/// Tensor products have Gauss-Lobatto (trapezoid, Simpson). P1 triangles are exact for degree 1. In P2 triangles the
/// middle nodes carry a third of the area each and the vertices nothing: of all rules on these nodes that do not depend
/// on the order of the vertices, only this one is exact for degree 2.
QuadratureRule nodal_rule(const Element &element);

} // namespace rpc::mesh
