// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/mesh/element.hpp"

#include <memory>

namespace rpc::bound
{

/// Symmetric stresses without divergence on a reference cell, piecewise polynomials of degree k on the triangles into which lines from
/// the centre to the vertices split it, with tractions that agree across these lines.                        doc/theory.md (13.6)
///
/// A stress is a list of coefficients (triangle, component xx yy xy, monomial of the place relative to the centre). In an affine cell
/// x = F X + c it is the stress F s F^T / det F: continuity and divergence stay, and a traction by length times that length is F times
/// that of s. Tables are for such stresses; columns are those that belong to the Legendre coefficients of tractions (side, degree,
/// component), then the inner stresses, which have no tractions. Tractions that are not in balance lead to those nearest that are.
struct ReferenceStress {
  int sides = 0, degree = 0;
  int monomials = 0; ///< (k + 1)(k + 2)/2
  int tractions = 0; ///< 2 (k + 1) sides
  int inner = 0;     ///< inner stresses
  int columns() const { return tractions + inner; }
  int coefficients() const { return 3 * sides * monomials; }

  DeviceView<double **> stress;  ///< (coefficients, columns)
  DeviceView<double ***> energy; ///< (6, columns, columns) int s_c t_d, symmetric, of components cd = 00 11 22 01 02 12
  DeviceView<double ***> moment; ///< (3, 2, columns) int s_c X_l, with X relative to the centre
  DeviceView<double ***> value;  ///< (sides, points, monomials) in the triangle at each side
  DeviceView<double **> weight;  ///< (sides, points) of integrals over the reference cell
  DeviceView<double ****> gradient;      ///< (sides, points, nodes, 2) of the element's shape functions, by X
  DeviceView<double ****> side_gradient; ///< (sides, 3 points, nodes, 2) the same at Gauss points along each side
  DeviceView<double *> side_point, side_weight; ///< (3) these points on [0, 1] and their weights

  static constexpr int most_tractions = 24, most_columns = 32;
  static constexpr int degree_of_loads = 4; ///< of polynomials that stand for tractions along a facet
};

/// The tables of a plane element of the order k, triangles and quadrilaterals. Made once.
/// @throws rpc::Error (internal_error) if the stresses do not have the dimension that they must have
ReferenceStress reference_stress(const mesh::Element &element);

/// Stresses of degree_of_loads that belong to the tractions of one side beyond degree k: (coefficients; sides * (loads - k) * 2) and the
/// integrals of their products.
struct LiftedLoads {
  int columns = 0;
  DeviceView<double ***> energy; ///< (6, columns, columns), column (side, degree - k - 1, component)
};
LiftedLoads lifted_loads(const mesh::Element &element);

} // namespace rpc::bound
