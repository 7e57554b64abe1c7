#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/mesh/element.hpp"

/// Shape functions at any point of a reference cell, on host and device.
namespace rpc::fem
{

/// The Lagrange polynomials of order 1 or 2 on [-1, 1], node by node from -1 to 1, and their slopes.
struct Lagrange {
  double value[3], slope[3];
};
KOKKOS_INLINE_FUNCTION Lagrange lagrange(const int order, const double x)
{
  if (order == 1) return {{(1 - x) / 2, (1 + x) / 2, 0}, {-0.5, 0.5, 0}};
  return {{x * (x - 1) / 2, (1 + x) * (1 - x), (x + 1) / 2 * x},
          {x / 2 - (1 - x) / 2, (1 - x) - (1 + x), x / 2 + (x + 1) / 2}};
}

/// Shape functions of P1 (3 nodes) or P2 (6) at a point of the triangle 0 <= X, 0 <= Y, X + Y <= 1, and their gradients
/// by X and Y.
template <int Nodes>
KOKKOS_INLINE_FUNCTION void triangle_shapes(const double (&X)[2], double (&N)[Nodes], double (&dN)[Nodes][2])
{
  const double slope[3][2] = {{-1, -1}, {1, 0}, {0, 1}}; // of the barycentric coordinates
  const double L[3] = {1 - X[0] - X[1], X[0], X[1]};
  for (int a = 0; a < 3; ++a) {
    N[a] = Nodes == 3 ? L[a] : L[a] * (2 * L[a] - 1);
    for (int g = 0; g < 2; ++g) dN[a][g] = slope[a][g] * (Nodes == 3 ? 1 : 4 * L[a] - 1);
    if constexpr (Nodes == 6) {
      const int b = (a + 1) % 3; // the node in the middle of edge a
      N[3 + a] = 4 * L[a] * L[b];
      for (int g = 0; g < 2; ++g) dN[3 + a][g] = 4 * (L[a] * slope[b][g] + L[b] * slope[a][g]);
    }
  }
}

/// x, or the end of [low, high] next to it; low for a NaN.
KOKKOS_INLINE_FUNCTION double within(const double low, const double x, const double high)
{
  return x > low ? (x < high ? x : high) : low;
}

/// The element of so many nodes, to be evaluated at points X of its reference cell: [-1, 1]^Dim, or for simplices the
/// triangle of 0 <= X, 0 <= Y, X + Y <= 1.
template <int Dim, int Nodes>
struct ShapeFunctions {
  static constexpr bool simplex = Dim == 2 && (Nodes == 3 || Nodes == 6);
  static constexpr int order = Nodes == Dim + 1 || Nodes == 1 << Dim ? 1 : 2;
  int place[Nodes][Dim]; // of the nodes, in the order of Element::lattice

  explicit ShapeFunctions(const mesh::Element &element)
  {
    const auto &lattice = element.lattice();
    for (int a = 0; a < Nodes; ++a)
      for (int d = 0; d < Dim; ++d) place[a][d] = lattice[a][d];
  }

  /// N(a), and dN(a, i) by reference coordinates.
  KOKKOS_INLINE_FUNCTION void evaluate(const double (&X)[Dim], double (&N)[Nodes], double (&dN)[Nodes][Dim]) const
  {
    if constexpr (simplex) {
      triangle_shapes(X, N, dN);
    } else {
      Lagrange along[Dim];
      for (int d = 0; d < Dim; ++d) along[d] = lagrange(order, X[d]);
      for (int a = 0; a < Nodes; ++a) {
        N[a] = 1;
        for (int i = 0; i < Dim; ++i) dN[a][i] = 1;
        for (int d = 0; d < Dim; ++d) {
          const double value = along[d].value[place[a][d]], slope = along[d].slope[place[a][d]];
          N[a] *= value;
          for (int i = 0; i < Dim; ++i) dN[a][i] *= i == d ? slope : value;
        }
      }
    }
  }

  KOKKOS_INLINE_FUNCTION void centre(double (&X)[Dim]) const
  {
    for (int d = 0; d < Dim; ++d) X[d] = simplex ? 1. / 3 : 0;
  }

  /// X becomes the point of the reference cell next to it; whatever X is, it is a point of the cell then.
  KOKKOS_INLINE_FUNCTION void clamp(double (&X)[Dim]) const
  {
    const double beyond = simplex ? (X[0] + X[1] - 1) / 2 : 0;
    for (int d = 0; d < Dim; ++d) X[d] = within(simplex ? 0 : -1, beyond > 0 ? X[d] - beyond : X[d], 1);
  }

  /// Coefficients of a function with nodal values x in the Bernstein basis: on the cell it takes no values outside theirs.
  KOKKOS_INLINE_FUNCTION void bernstein(const double (&x)[Nodes], double (&b)[Nodes]) const
  {
    for (int a = 0; a < Nodes; ++a) {
      b[a] = x[a];
      if constexpr (simplex && order == 2) {
        if (a >= 3) b[a] = 2 * x[a] - (x[a - 3] + x[(a - 2) % 3]) / 2;
      } else if constexpr (order == 2) {
        b[a] = 0; // in each direction: the ends' own values, 2 middle - (first + last) / 2 for the middle
        for (int c = 0; c < Nodes; ++c) {
          double factor = 1;
          for (int d = 0; d < Dim; ++d) {
            const bool same = place[c][d] == place[a][d];
            factor *= place[a][d] == 1 ? (same ? 2 : -0.5) : (same ? 1 : 0);
          }
          b[a] += factor * x[c];
        }
      }
    }
  }
};

} // namespace rpc::fem
