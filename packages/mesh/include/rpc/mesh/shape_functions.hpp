// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/error.hpp"
#include "rpc/core/kokkos.hpp"
#include "rpc/mesh/element.hpp"

/// The shape functions of all elements at any point of the reference cell, on host and device: the only place that has
/// their formulas.
namespace rpc::mesh
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

/// x, or the end of [low, high] next to it; low for a NaN.
KOKKOS_INLINE_FUNCTION double within(const double low, const double x, const double high)
{
  return x > low ? (x < high ? x : high) : low;
}

/// An element that is known to the compiler. Dimension and number of nodes together tell it: a face of a P1 tetrahedron has
/// (2, 3), an edge of a P2 triangle (1, 3).
template <int Dim, int Nodes>
struct StaticElement {
  static constexpr bool simplex = Dim > 1 && (Nodes == Dim + 1 || Nodes == (Dim + 1) * (Dim + 2) / 2);
  static constexpr int vertices = simplex ? Dim + 1 : 1 << Dim;
  static constexpr int order = Nodes == vertices ? 1 : 2;
  static_assert(simplex || Nodes == vertices ||
                    Nodes == (Dim == 1   ? 3
                              : Dim == 2 ? 9
                                         : 27),
                "there is no such element");

  static Element element() { return {Dim, order, simplex ? Shape::simplex : Shape::tensor}; }
};

/// Shape functions of an element, to be evaluated at points X of its reference cell.
template <int Dim, int Nodes>
struct ShapeFunctions {
  static constexpr int dim = Dim, nodes = Nodes;
  static constexpr bool simplex = StaticElement<Dim, Nodes>::simplex;
  static constexpr int order = StaticElement<Dim, Nodes>::order;
  static constexpr int vertices = StaticElement<Dim, Nodes>::vertices;
  int place[Nodes][Dim]; // of the nodes, as Element::lattice has them

  ShapeFunctions()
  {
    const Element element = StaticElement<Dim, Nodes>::element();
    const auto &lattice = element.lattice();
    for (int a = 0; a < Nodes; ++a)
      for (int d = 0; d < Dim; ++d) place[a][d] = lattice[a][d];
  }

  /// N(a), and dN(a, i) by reference coordinates.
  KOKKOS_INLINE_FUNCTION void evaluate(const double (&X)[Dim], double (&N)[Nodes], double (&dN)[Nodes][Dim]) const
  {
    if constexpr (simplex) {
      double L[Dim + 1]; // barycentric coordinates, that of vertex a by X_(a-1)
      L[0] = 1 - X[0];
      for (int d = 1; d < Dim; ++d) L[0] -= X[d];
      for (int d = 0; d < Dim; ++d) L[d + 1] = X[d];
      for (int a = 0; a < vertices; ++a) {
        N[a] = order == 1 ? L[a] : L[a] * (2 * L[a] - 1);
        for (int g = 0; g < Dim; ++g) dN[a][g] = slope(a, g) * (order == 1 ? 1 : 4 * L[a] - 1);
      }
      for (int edge = 0; edge < Nodes - vertices; ++edge) {
        const int a = end_of(edge, 0), b = end_of(edge, 1);
        N[vertices + edge] = 4 * L[a] * L[b];
        for (int g = 0; g < Dim; ++g) dN[vertices + edge][g] = 4 * (L[a] * slope(b, g) + L[b] * slope(a, g));
      }
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

  /// X = the place of a node.
  KOKKOS_INLINE_FUNCTION void node(const int a, double (&X)[Dim]) const
  {
    for (int d = 0; d < Dim; ++d) {
      const double t = double(place[a][d]) / order;
      X[d] = simplex ? t : 2 * t - 1;
    }
  }

  KOKKOS_INLINE_FUNCTION void centre(double (&X)[Dim]) const
  {
    for (int d = 0; d < Dim; ++d) X[d] = simplex ? 1. / (Dim + 1) : 0;
  }

  /// X becomes the point of the reference cell next to it.
  KOKKOS_INLINE_FUNCTION void clamp(double (&X)[Dim]) const
  {
    for (int d = 0; d < Dim; ++d) X[d] = within(simplex ? 0 : -1, X[d], simplex ? X[d] : 1);
    for (int round = 0; round < Dim && simplex; ++round) {
      double beyond = -1; // of the plane on which coordinates sum to 1
      int positive = 0;
      for (int d = 0; d < Dim; ++d) {
        beyond += X[d];
        positive += X[d] > 0 ? 1 : 0;
      }
      for (int d = 0; d < Dim && beyond > 0; ++d) X[d] = within(0, X[d] - beyond / positive, 1);
    }
  }

  /// Coefficients of a function with nodal values x in the Bernstein basis: on the cell it takes no values outside theirs.
  KOKKOS_INLINE_FUNCTION void bernstein(const double (&x)[Nodes], double (&b)[Nodes]) const
  {
    for (int a = 0; a < Nodes; ++a) {
      b[a] = x[a];
      if constexpr (simplex && order == 2) {
        if (a >= vertices) b[a] = 2 * x[a] - (x[end_of(a - vertices, 0)] + x[end_of(a - vertices, 1)]) / 2;
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

private:
  /// Of a vertex' barycentric coordinate by X_g.
  static KOKKOS_INLINE_FUNCTION double slope(const int vertex, const int g)
  {
    return vertex == 0 ? -1 : (vertex == g + 1 ? 1 : 0);
  }
  /// The vertices at the ends of a simplex' edge, in the order of Element::edges: around the first triangle, then to vertex 3.
  static KOKKOS_INLINE_FUNCTION int end_of(const int edge, const int end)
  {
    if (edge < 3) return (edge + end) % 3;
    return end == 0 ? edge - 3 : 3;
  }
};

/// Values of a mixed element's shape functions.
template <int Dim>
struct MixedShapeFunctions {
  static constexpr int most = Dim == 2 ? 6 : 18; ///< nodes
  int nodes = 0;
  int order[Dim];       // in each direction
  int place[most][Dim]; // (nodes) as Element::lattice has them

  explicit MixedShapeFunctions(const Element &element) : nodes(element.num_nodes())
  {
    for (int d = 0; d < Dim; ++d) order[d] = element.order_along(d);
    for (int a = 0; a < nodes; ++a)
      for (int d = 0; d < Dim; ++d) place[a][d] = element.lattice()[a][d];
  }
  /// N(a) at a point X of the reference cell, 0 beyond the last node.
  KOKKOS_INLINE_FUNCTION void evaluate(const double (&X)[Dim], double (&N)[most]) const
  {
    Lagrange along[Dim];
    for (int d = 0; d < Dim; ++d) along[d] = lagrange(order[d], X[d]);
    for (int a = 0; a < most; ++a) {
      N[a] = a < nodes ? 1 : 0;
      for (int d = 0; d < Dim && a < nodes; ++d) N[a] *= along[d].value[place[a][d]];
    }
  }
};

/// Calls work(Dim, Nodes) with both as compile-time constants, for elements of cells. A new element is a new line here, or in
/// with_facet_extents() for elements of facets alone.
/// @throws rpc::Error (internal_error) for mixed elements
template <class Work>
void with_static_extents(const Element &element, Work &&work)
{
  using std::integral_constant;
  using Two = integral_constant<int, 2>;
  using Three = integral_constant<int, 3>;
  const bool simplex = element.shape == Shape::simplex;
  if (element.mixed())
    throw Error(ExitCode::internal_error, "mesh: kernels do not know the mixed element " + element.name());
  if (element.dim == 2 && element.order == 1)
    return simplex ? work(Two(), integral_constant<int, 3>()) : work(Two(), integral_constant<int, 4>());
  if (element.dim == 2 && element.order == 2)
    return simplex ? work(Two(), integral_constant<int, 6>()) : work(Two(), integral_constant<int, 9>());
  if (element.dim == 3 && element.order == 1)
    return simplex ? work(Three(), integral_constant<int, 4>()) : work(Three(), integral_constant<int, 8>());
  if (element.dim == 3 && element.order == 2)
    return simplex ? work(Three(), integral_constant<int, 10>()) : work(Three(), integral_constant<int, 27>());
  throw Error(ExitCode::internal_error, "mesh: no cells are of order " + std::to_string(element.order) + " in " +
                                            std::to_string(element.dim) + "D");
}

/// Calls work(shape functions) for any element, of cells, facets or edges.
template <class Work>
void with_shape_functions(const Element &element, Work &&work)
{
  if (element.dim > 1)
    return with_static_extents(element, [&](const auto dim, const auto nodes) { work(ShapeFunctions<dim, nodes>()); });
  if (element.order == 1) return work(ShapeFunctions<1, 2>());
  return work(ShapeFunctions<1, 3>());
}

} // namespace rpc::mesh
