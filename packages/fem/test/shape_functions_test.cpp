#include "shape_functions.hpp"

#include "bodies.hpp"
#include "kernels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

using namespace rpc;
using namespace rpc::test;

/// Calls work(shape functions, element) for each element that has kernels.
template <class Work>
void for_each_element(const Work &work)
{
  for (const mesh::Element &element : elements()) {
    SCOPED_TRACE(text_of(element));
    fem::with_static_extents(element, [&](const auto dim, const auto nodes) {
      const fem::ShapeFunctions<dim, nodes> shape(element);
      static_assert(decltype(shape)::order == 1 || decltype(shape)::order == 2);
      EXPECT_EQ(shape.order, element.order);
      EXPECT_EQ(shape.simplex, element.shape == mesh::Shape::simplex);
      work(shape, element, dim, nodes);
    });
  }
}

/// Reference coordinates of an element's nodes.
double node(const mesh::Element &element, const int a, const int d)
{
  const double t = double(element.lattice()[a][d]) / element.order;
  return element.shape == mesh::Shape::simplex ? t : -1 + 2 * t;
}

TEST(ShapeFunctions, AreThoseOfTheTables)
{
  for_each_element([](const auto &shape, const mesh::Element &element, const auto dim, const auto nodes) {
    const auto table = fem::tabulate(element).cell_load;
    const auto value = to_host(table.value);
    const auto gradient = to_host(table.gradient);
    for (int q = 0; q < table.num_points(); ++q) {
      double X[dim] = {}, N[nodes], dN[nodes][dim];
      for (int a = 0; a < nodes; ++a)
        for (int d = 0; d < dim; ++d) X[d] += value(q, a) * node(element, a, d);
      shape.evaluate(X, N, dN);
      for (int a = 0; a < nodes; ++a) {
        EXPECT_NEAR(N[a], value(q, a), 1e-15);
        for (int d = 0; d < dim; ++d) EXPECT_NEAR(dN[a][d], gradient(q, a, d), 1e-14);
      }
    }
  });
}

TEST(ShapeFunctions, AreOneAtTheirNodeAndZeroAtTheOthers)
{
  for_each_element([](const auto &shape, const mesh::Element &element, const auto dim, const auto nodes) {
    for (int b = 0; b < nodes; ++b) {
      double X[dim], N[nodes], dN[nodes][dim];
      for (int d = 0; d < dim; ++d) X[d] = node(element, b, d);
      shape.evaluate(X, N, dN);
      for (int a = 0; a < nodes; ++a) EXPECT_EQ(N[a], a == b ? 1 : 0);
    }
  });
}

TEST(ShapeFunctions, ClampingLeavesPointsOfTheCellAndMovesAllOthersIntoIt)
{
  for_each_element([](const auto &shape, const mesh::Element &element, const auto dim, auto) {
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    const bool simplex = element.shape == mesh::Shape::simplex;
    for (const double x : {-3., -0.4, 0., 0.3, 0.7, 1., 5., nan, inf, -inf})
      for (const double y : {-7., -1., 0., 0.1, 1., 1.5, nan, inf, -inf}) {
        const double before[3] = {x, y, 0.2};
        double X[dim];
        bool inside = true;
        for (int d = 0; d < dim; ++d) {
          X[d] = before[d];
          inside = inside && X[d] >= (simplex ? 0 : -1) && X[d] <= 1;
        }
        inside = inside && !(simplex && x + y > 1);
        shape.clamp(X);
        for (int d = 0; d < dim; ++d) {
          if (inside) {
            EXPECT_EQ(X[d], before[d]);
          }
          EXPECT_GE(X[d], simplex ? 0 : -1);
          EXPECT_LE(X[d], 1);
        }
        EXPECT_LE(simplex ? X[0] + X[1] : 0, 1 + 1e-15) << x << " " << y;
      }
  });
  double beside_edge[2] = {0.9, 0.7};
  fem::ShapeFunctions<2, 3>({2, 1, mesh::Shape::simplex}).clamp(beside_edge);
  EXPECT_NEAR(beside_edge[0], 0.6, 1e-15);
  EXPECT_NEAR(beside_edge[1], 0.4, 1e-15);
}

TEST(ShapeFunctions, BernsteinCoefficientsEncloseTheFunction)
{
  for_each_element([](const auto &shape, const mesh::Element &element, const auto dim, const auto nodes) {
    double x[nodes], b[nodes];
    for (int k = 0; k < 50; ++k) {
      for (int a = 0; a < nodes; ++a) x[a] = std::sin(1 + 12.3 * k + 45.6 * a);
      shape.bernstein(x, b);
      double low = b[0], high = b[0];
      for (int a = 1; a < nodes; ++a) {
        low = std::min(low, b[a]);
        high = std::max(high, b[a]);
      }
      for (int s = 0; s <= 20; ++s)
        for (int t = 0; t <= 20; ++t) {
          double X[dim], N[nodes], dN[nodes][dim], value = 0;
          for (int d = 0; d < dim; ++d) X[d] = -1 + 0.1 * (d == 0 ? s : d == 1 ? t : s);
          shape.clamp(X);
          shape.evaluate(X, N, dN);
          for (int a = 0; a < nodes; ++a) value += N[a] * x[a];
          EXPECT_GT(value, low - 1e-14);
          EXPECT_LT(value, high + 1e-14);
        }
    }
    for (int a = 0; a < nodes; ++a) x[a] = node(element, a, 0) + 2 * node(element, a, 1);
    shape.bernstein(x, b);
    for (int a = 0; a < nodes; ++a) EXPECT_NEAR(b[a], x[a], 1e-15); // those of affine functions are the nodal values
  });
}

} // namespace
