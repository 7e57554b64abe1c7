// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/shape_functions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <type_traits>

namespace shape_functions_test
{
namespace
{

using rpc::mesh::all_elements;
using rpc::mesh::Element;
using rpc::mesh::Shape;
using rpc::mesh::ShapeFunctions;

/// All elements of cells, then those of their facets and edges that are none of cells.
std::vector<Element> all_with_edges()
{
  std::vector<Element> elements = all_elements();
  elements.push_back({1, 1});
  elements.push_back({1, 2});
  return elements;
}

/// Calls work(shape functions, element, dim, nodes) for each element, the last two known to the compiler.
template <class Work>
void for_each_element(const Work &work)
{
  for (const Element &element : all_with_edges()) {
    SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim) + "D");
    rpc::mesh::with_shape_functions(element, [&](const auto &functions) {
      using Functions = std::decay_t<decltype(functions)>;
      EXPECT_EQ(Functions::order, element.order);
      EXPECT_EQ(Functions::simplex, element.shape == Shape::simplex);
      EXPECT_EQ(Functions::vertices, element.num_vertices());
      EXPECT_EQ(Functions::nodes, element.num_nodes());
      work(functions, element, std::integral_constant<int, Functions::dim>(),
           std::integral_constant<int, Functions::nodes>());
    });
  }
}

/// Some points of a reference cell without any symmetry.
template <int Dim>
std::vector<std::array<double, Dim>> points(const bool simplex)
{
  std::vector<std::array<double, Dim>> all;
  for (int k = 0; k < 5; ++k) {
    std::array<double, Dim> X;
    for (int d = 0; d < Dim; ++d) {
      const double t = 0.5 + 0.45 * std::sin(1 + 3.7 * k + 2.3 * d);
      X[d] = simplex ? t / Dim : 2 * t - 1;
    }
    all.push_back(X);
  }
  return all;
}

template <class Functions, int Dim>
void evaluate(const Functions &functions, const std::array<double, Dim> &at, double (&N)[Functions::nodes],
              double (&dN)[Functions::nodes][Dim])
{
  double X[Dim];
  std::copy(at.begin(), at.end(), X);
  functions.evaluate(X, N, dN);
}

TEST(ShapeFunctions, AreOneAtTheirNodeAndZeroAtTheOthers)
{
  for_each_element([](const auto &functions, const Element &, const auto dim, const auto nodes) {
    for (int b = 0; b < nodes; ++b) {
      double X[dim], N[nodes], dN[nodes][dim];
      functions.node(b, X);
      functions.evaluate(X, N, dN);
      for (int a = 0; a < nodes; ++a) EXPECT_EQ(N[a], a == b ? 1 : 0);
    }
  });
}

TEST(ShapeFunctions, SumToOneAndTheirGradientsToZero)
{
  for_each_element([](const auto &functions, const Element &, const auto dim, const auto nodes) {
    for (const auto &at : points<dim>(functions.simplex)) {
      double N[nodes], dN[nodes][dim], sum = 0, slope[dim] = {};
      evaluate<std::decay_t<decltype(functions)>, dim>(functions, at, N, dN);
      for (int a = 0; a < nodes; ++a) {
        sum += N[a];
        for (int d = 0; d < dim; ++d) slope[d] += dN[a][d];
      }
      EXPECT_NEAR(sum, 1, 1e-14);
      for (int d = 0; d < dim; ++d) EXPECT_NEAR(slope[d], 0, 1e-13);
    }
  });
}

TEST(ShapeFunctions, InterpolatePolynomialsOfTheirOrderExactly)
{
  for_each_element([](const auto &functions, const Element &element, const auto dim, const auto nodes) {
    const auto f = [&](const double *X) {
      double sum = 0.3, product = 1;
      for (int d = 0; d < dim; ++d) {
        sum += (d + 1) * X[d];
        product *= 1 + 0.2 * (d + 1) * X[d];
      }
      // of the degree `order` in all coordinates together, and for tensor products in each
      return std::pow(sum, element.order) + (functions.simplex ? 0 : std::pow(product, element.order));
    };
    for (const auto &at : points<dim>(functions.simplex)) {
      double N[nodes], dN[nodes][dim], value = 0;
      evaluate<std::decay_t<decltype(functions)>, dim>(functions, at, N, dN);
      for (int a = 0; a < nodes; ++a) {
        double X[dim];
        functions.node(a, X);
        value += N[a] * f(X);
      }
      EXPECT_NEAR(value, f(at.data()), 1e-13 * (1 + std::abs(value)));
    }
  });
}

TEST(ShapeFunctions, GradientsAreTheLimitsOfDifferences)
{
  for_each_element([](const auto &functions, const Element &element, const auto dim, const auto nodes) {
    // Along a line the functions are polynomials of this degree; central differences of degree 2 are exact.
    const int degree = element.order * (functions.simplex ? 1 : int(dim));
    const double direction[3] = {0.6, -0.5, 0.7};
    double worst[3] = {};
    const double h[3] = {0.1, 0.05, 0.025};
    for (const auto &at : points<dim>(functions.simplex))
      for (int k = 0; k < 3; ++k) {
        double N[nodes], before[nodes], after[nodes], dN[nodes][dim], unused[nodes][dim];
        auto low = at, high = at;
        for (int d = 0; d < dim; ++d) {
          low[d] -= h[k] * direction[d];
          high[d] += h[k] * direction[d];
        }
        using Functions = std::decay_t<decltype(functions)>;
        evaluate<Functions, dim>(functions, at, N, dN);
        evaluate<Functions, dim>(functions, low, before, unused);
        evaluate<Functions, dim>(functions, high, after, unused);
        for (int a = 0; a < nodes; ++a) {
          double slope = 0;
          for (int d = 0; d < dim; ++d) slope += direction[d] * dN[a][d];
          worst[k] = std::max(worst[k], std::abs((after[a] - before[a]) / (2 * h[k]) - slope));
        }
      }
    if (degree <= 2) {
      EXPECT_LT(worst[0], 1e-13);
    } else {
      EXPECT_NEAR(worst[0] / worst[1], 4, 0.2);
      EXPECT_NEAR(worst[1] / worst[2], 4, 0.05);
    }
  });
}

TEST(ShapeFunctions, OnAFacetAreThoseOfTheFacetsElement)
{
  for (const Element &element : all_elements()) {
    SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim) + "D");
    rpc::mesh::with_shape_functions(element, [&](const auto &of_cell) {
      rpc::mesh::with_shape_functions(element.facet(), [&](const auto &of_facet) {
        using Cell = std::decay_t<decltype(of_cell)>;
        using Facet = std::decay_t<decltype(of_facet)>;
        if constexpr (Cell::dim == Facet::dim + 1) {
          for (const auto &facet : element.facets()) {
            ASSERT_EQ(static_cast<int>(facet.size()), int(Facet::nodes));
            for (const auto &at : points<Facet::dim>(Facet::simplex)) {
              double N[Cell::nodes], dN[Cell::nodes][Cell::dim], M[Facet::nodes], dM[Facet::nodes][Facet::dim];
              evaluate<Facet, Facet::dim>(of_facet, at, M, dM);
              double X[Cell::dim] = {};
              for (int a = 0; a < Facet::nodes; ++a) {
                double node[Cell::dim];
                of_cell.node(facet[a], node);
                for (int d = 0; d < Cell::dim; ++d) X[d] += M[a] * node[d];
              }
              of_cell.evaluate(X, N, dN);
              double elsewhere = 0;
              for (int a = 0; a < Cell::nodes; ++a) {
                const auto place = std::find(facet.begin(), facet.end(), a);
                if (place == facet.end())
                  elsewhere = std::max(elsewhere, std::abs(N[a]));
                else
                  EXPECT_NEAR(N[a], M[place - facet.begin()], 1e-14);
              }
              EXPECT_LT(elsewhere, 1e-15);
            }
          }
        } else {
          ADD_FAILURE() << "a facet must have a dimension less";
        }
      });
    });
  }
}

TEST(ShapeFunctions, ClampingLeavesPointsOfTheCellAndMovesAllOthersIntoIt)
{
  for_each_element([](const auto &functions, const Element &, const auto dim, auto) {
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    const bool simplex = functions.simplex;
    for (const double x : {-3., -0.4, 0., 0.3, 0.7, 1., 5., nan, inf, -inf})
      for (const double y : {-7., -1., 0., 0.1, 1., 1.5, nan, inf, -inf})
        for (const double z : {0.2, -2., 3., nan, inf}) {
          const double before[3] = {x, y, z};
          double X[dim], sum = 0;
          bool inside = true;
          for (int d = 0; d < dim; ++d) {
            X[d] = before[d];
            sum += X[d];
            inside = inside && X[d] >= (simplex ? 0 : -1) && X[d] <= 1;
          }
          inside = inside && !(simplex && sum > 1);
          functions.clamp(X);
          sum = 0;
          for (int d = 0; d < dim; ++d) {
            if (inside) {
              EXPECT_EQ(X[d], before[d]);
            }
            EXPECT_GE(X[d], simplex ? 0 : -1);
            EXPECT_LE(X[d], 1);
            sum += X[d];
          }
          EXPECT_LE(simplex ? sum : 0, 1 + 1e-15) << x << " " << y << " " << z;
        }
  });
}

TEST(ShapeFunctions, ClampingFindsTheNearestPointOfASimplex)
{
  double beside_edge[2] = {0.9, 0.7};
  ShapeFunctions<2, 3>().clamp(beside_edge);
  EXPECT_NEAR(beside_edge[0], 0.6, 1e-15);
  EXPECT_NEAR(beside_edge[1], 0.4, 1e-15);
  double beside_face[3] = {0.9, 0.7, 0.5};
  ShapeFunctions<3, 4>().clamp(beside_face);
  EXPECT_NEAR(beside_face[0], 0.9 - 1.1 / 3, 1e-15);
  EXPECT_NEAR(beside_face[1], 0.7 - 1.1 / 3, 1e-15);
  EXPECT_NEAR(beside_face[2], 0.5 - 1.1 / 3, 1e-15);
  double below_edge[3] = {0.9, 0.7, -3};
  ShapeFunctions<3, 10>().clamp(below_edge);
  EXPECT_NEAR(below_edge[0], 0.6, 1e-15);
  EXPECT_NEAR(below_edge[1], 0.4, 1e-15);
  EXPECT_EQ(below_edge[2], 0);
}

TEST(ShapeFunctions, BernsteinCoefficientsEncloseTheFunction)
{
  for_each_element([](const auto &functions, const Element &, const auto dim, const auto nodes) {
    double x[nodes], b[nodes];
    for (int k = 0; k < 50; ++k) {
      for (int a = 0; a < nodes; ++a) x[a] = std::sin(1 + 12.3 * k + 45.6 * a);
      functions.bernstein(x, b);
      const double low = *std::min_element(b, b + nodes), high = *std::max_element(b, b + nodes);
      for (int s = 0; s <= 20; ++s)
        for (int t = 0; t <= 20; ++t) {
          double X[dim], N[nodes], dN[nodes][dim], value = 0;
          for (int d = 0; d < dim; ++d) X[d] = -1 + 0.1 * (d == 0 ? s : d == 1 ? t : (s + t) % 21);
          functions.clamp(X);
          functions.evaluate(X, N, dN);
          for (int a = 0; a < nodes; ++a) value += N[a] * x[a];
          EXPECT_GT(value, low - 1e-14);
          EXPECT_LT(value, high + 1e-14);
        }
    }
    for (int a = 0; a < nodes; ++a) {
      double X[dim];
      functions.node(a, X);
      x[a] = 0;
      for (int d = 0; d < dim; ++d) x[a] += (d + 1) * X[d];
    }
    functions.bernstein(x, b);
    for (int a = 0; a < nodes; ++a)
      EXPECT_NEAR(b[a], x[a], 1e-15 * 4); // those of affine functions are the nodal values
  });
}

} // namespace
} // namespace shape_functions_test
