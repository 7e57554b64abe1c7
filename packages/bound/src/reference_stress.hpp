// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/mesh/element.hpp"

#include <memory>

namespace rpc::bound
{

/// (pairs, columns, columns) Each pair in one piece.
using EnergyTable = Kokkos::View<double ***, Kokkos::LayoutRight, Device>;

/// Symmetric stresses without divergence on a reference cell, piecewise polynomials of degree k on the triangles or tetrahedra that the
/// centre makes with its facets, with tractions that agree where these parts meet.                          doc/bounds.md (13.6)
///
/// A stress is a list of coefficients (part, component xx yy xy or xx yy zz yz xz xy, monomial of the place relative to the centre). In an
/// affine cell x = F X + c it is the stress F s F^T / |det F|: continuity and divergence stay, and a traction times the size of its facet
/// is F times that of s. Tables are for such stresses; columns are those that belong to the coefficients of tractions (side, polynomial of
/// FacetPolynomials, component), then the inner stresses, which have no tractions. Tractions that are not in balance lead to those nearest
/// that are. Facet s of a tetrahedron lies opposite vertex s and begins at its first vertex.
struct ReferenceStress {
  int dim = 2, sides = 0, degree = 0;
  int monomials = 0; ///< (k + 1)(k + 2)/2 in the plane, (k + 1)(k + 2)(k + 3)/6 in space
  int tractions = 0; ///< 2 (k + 1) sides in the plane, 6 (k + 1)(k + 2) in space
  int inner = 0;     ///< inner stresses
  KOKKOS_INLINE_FUNCTION int columns() const { return tractions + inner; }
  int coefficients() const { return dim * (dim + 1) / 2 * sides * monomials; }

  DeviceView<double **> stress; ///< (coefficients, columns)
  /// (columns, coefficients) The same, each column in one piece.
  Kokkos::View<double **, Kokkos::LayoutRight, Device> by_column;
  /// (pairs, columns, columns) int s_c t_d, symmetric, of components cd = 00 11 .. 01 02 .. 12 ..
  EnergyTable energy;
  /// (pairs, rows of the lower triangle) The same in space.
  Kokkos::View<double **, Kokkos::LayoutRight, Device> lower_energy;
  DeviceView<double ***> moment;    ///< (components, dim, columns) int s_c X_l, with X relative to the centre
  DeviceView<double ***> value;     ///< (sides, points, monomials) in the part at each side
  DeviceView<double **> weight;     ///< (sides, points) of integrals over the reference cell
  DeviceView<double ****> gradient; ///< (sides, points, nodes, dim) of the element's shape functions, by X
  DeviceView<double ****>
      side_gradient; ///< (sides, points, nodes, dim) the same at the points of facet_rule(dim, 3) on each side
  DeviceView<double *> side_point, side_weight; ///< of the second vertex at these points, and their weights

  static constexpr int most_tractions = 24, most_columns = 32; ///< in the plane
  static constexpr int most_columns_in_space = 90;
  static constexpr int degree_of_loads = 4, degree_of_loads_in_space = 3; ///< of polynomials that stand for tractions
  static int degree_of_loads_in(const int dim) { return dim == 2 ? degree_of_loads : degree_of_loads_in_space; }
};

/// The tables of an element of the order k: triangles, quadrilaterals and tetrahedra. Made once.
/// @throws rpc::Error (internal_error) if the stresses do not have the dimension that they must have
ReferenceStress reference_stress(const mesh::Element &element);

/// Stresses of degree_of_loads that belong to the tractions of one side beyond degree k, and the integrals of
/// their products.
struct LiftedLoads {
  int columns = 0;
  EnergyTable energy; ///< (pairs, columns, columns), column (side, polynomial beyond degree k, component)
};
LiftedLoads lifted_loads(const mesh::Element &element);

} // namespace rpc::bound
