// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/error.hpp"
#include "rpc/core/math.hpp"
#include "rpc/fem/discretization.hpp"
#include "rpc/mesh/shape_functions.hpp"

#include <utility>

/// What kernels over cells and facets share: geometry at a quadrature point, and the choice of static extents.
namespace rpc::fem
{

using mesh::ShapeFunctions;
using mesh::StaticElement;
using mesh::with_static_extents;

using ReadVector = decltype(device_read(std::declval<const Vector &>()));
using WriteVector = decltype(device_write(std::declval<Vector &>()));

/// Determinant and inverse of a small matrix; inverse is undefined if the determinant is 0.
template <int Dim>
KOKKOS_INLINE_FUNCTION double invert(const double (&m)[Dim][Dim], double (&inverse)[Dim][Dim])
{
  if constexpr (Dim == 2) {
    const double det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    const double s = 1 / det;
    inverse[0][0] = s * m[1][1];
    inverse[0][1] = -s * m[0][1];
    inverse[1][0] = -s * m[1][0];
    inverse[1][1] = s * m[0][0];
    return det;
  } else {
    double cofactor[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        cofactor[i][j] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
      }
    const double det = m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1] + m[0][2] * cofactor[0][2];
    const double s = 1 / det;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) inverse[i][j] = s * cofactor[j][i];
    return det;
  }
}

/// Node coordinates of one cell [m].
template <int Dim, int Nodes>
struct CellCoords {
  double x[Nodes][Dim];

  KOKKOS_INLINE_FUNCTION CellCoords(const DeviceView<double **> &coords, const DeviceView<LO **> &places, const LO cell)
  {
    for (int a = 0; a < Nodes; ++a)
      for (int d = 0; d < Dim; ++d) x[a][d] = coords(places(cell, a), d);
  }
};

/// Gradients dN(a, i) [1/m] of the shape functions at a point, and the Jacobian's determinant [m^Dim].           (2.1)
/// @param[out] dN  its first Dim columns
template <int Dim, int Nodes, int Columns>
KOKKOS_INLINE_FUNCTION double physical_gradients(const CellCoords<Dim, Nodes> &cell,
                                                 const DeviceView<double ***> &gradient, const int q,
                                                 double (&dN)[Nodes][Columns])
{
  double jacobian[Dim][Dim] = {}; // dx_i / dX_j
  for (int a = 0; a < Nodes; ++a)
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) jacobian[i][j] += cell.x[a][i] * gradient(q, a, j);
  double inverse[Dim][Dim];
  const double det = invert<Dim>(jacobian, inverse);
  for (int a = 0; a < Nodes; ++a)
    for (int i = 0; i < Dim; ++i) {
      dN[a][i] = 0;
      for (int j = 0; j < Dim; ++j) dN[a][i] += gradient(q, a, j) * inverse[j][i];
    }
  return det;
}

/// at(i) = x_i at a point of a cell [m].
/// @param value  (points, Nodes) shape functions
template <int Dim, int Nodes>
KOKKOS_INLINE_FUNCTION void position(const CellCoords<Dim, Nodes> &cell, const DeviceView<double **> &value,
                                     const int q, double (&at)[Dim])
{
  for (int i = 0; i < Dim; ++i) {
    at[i] = 0;
    for (int a = 0; a < Nodes; ++a) at[i] += value(q, a) * cell.x[a][i];
  }
}

/// Length of the circle that a point of an axisymmetric mesh describes [m]. A rounding of the axis
/// beyond it is 0.
KOKKOS_INLINE_FUNCTION double circle(const double r)
{
  constexpr double two_pi = 6.283185307179586;
  return r > 0 ? two_pi * r : 0;
}

/// Outward normal at a facet's point times the ratio of area to reference area [m^(dim-1)].
template <class Coords, class Facets, class Gradient>
KOKKOS_INLINE_FUNCTION Kokkos::Array<double, 3> area_normal(const Coords &coords, const Facets &facets, const LO facet,
                                                            const Gradient &gradient, const int q)
{
  const int dim = static_cast<int>(coords.extent(1)), nodes = static_cast<int>(facets.extent(1));
  double t[2][3] = {};
  for (int g = 0; g < dim - 1; ++g)
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < dim; ++i) t[g][i] += gradient(q, a, g) * coords(facets(facet, a), i);
  if (dim == 2) return {{t[0][1], -t[0][0], 0}};
  return {{t[0][1] * t[1][2] - t[0][2] * t[1][1], t[0][2] * t[1][0] - t[0][0] * t[1][2],
           t[0][0] * t[1][1] - t[0][1] * t[1][0]}};
}

KOKKOS_INLINE_FUNCTION double norm(const Kokkos::Array<double, 3> &v)
{
  return math::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

} // namespace rpc::fem
