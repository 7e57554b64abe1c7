// SPDX-License-Identifier: BSD-3-Clause
#include "beside_inverse.hpp"
#include "revolution_tables.hpp"

#include <cmath>
#include <gtest/gtest.h>

// What bounds of bodies of revolution are made of, doc/bounds.md (13.10a) - (13.10d).

namespace revolution_test
{
namespace
{

using namespace rpc;
using namespace rpc::bound;

TEST(BesideInverse, StaysOnItsSideOfOneOverRAndIsAPolynomial)
{
  for (const double b : {1.1, 2., 10.}) {
    const double a = 1;
    double above_worst = 0;
    for (int i = 0; i <= 1000; ++i) {
      const double x = a + (b - a) * i / 1000;
      EXPECT_GE(beside_inverse(x, a, b, true), (1 - 1e-15) / x);
      EXPECT_LE(beside_inverse(x, a, b, false), (1 + 1e-15) / x);
      above_worst = std::max(above_worst, x * beside_inverse(x, a, b, true) - 1);
    }
    EXPECT_LT(above_worst, b > 3 ? 0.2 : 1e-5);
    // Degree 7: the differences of order 8 vanish.
    for (const bool above : {true, false}) {
      double difference = 0, binomial = 1;
      for (int i = 0; i <= 8; ++i) {
        difference += (i % 2 == 0 ? 1 : -1) * binomial * beside_inverse(a + (b - a) * i / 8, a, b, above);
        binomial *= (8. - i) / (i + 1);
      }
      EXPECT_NEAR(difference, 0, 1e-12);
    }
  }
}

TEST(RevolutionTables, HaveTheStressesOfAnyDivergenceAndIntegratePolynomials)
{
  const struct {
    int order;
    mesh::Shape shape;
    int columns, inner;
  } elements[] = {{1, mesh::Shape::simplex, 15, 3},
                  {2, mesh::Shape::simplex, 36, 18},
                  {1, mesh::Shape::tensor, 21, 5},
                  {2, mesh::Shape::tensor, 49, 25}};
  for (const auto &of : elements) {
    mesh::Element element;
    element.dim = 2;
    element.order = of.order;
    element.shape = of.shape;
    SCOPED_TRACE(element.name());
    const RevolutionTables t = revolution_tables(element);
    EXPECT_EQ(t.columns, of.columns);
    EXPECT_EQ(t.inner, of.inner);
    const auto weight = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), t.weight);
    const auto place = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), t.place);
    const bool simplex = of.shape == mesh::Shape::simplex;
    const double area = simplex ? 0.5 : 4, square = simplex ? 1. / 36 : 4. / 3; // int 1, int x^2
    for (int e = 0; e < RevolutionTables::arrangements; ++e) {
      double sum = 0, of_square = 0;
      for (std::size_t s = 0; s < weight.extent(1); ++s)
        for (int q = 0; q < t.points; ++q) {
          sum += weight(e, s, q);
          of_square += weight(e, s, q) * std::pow(place(e, s, q, 0), 2);
        }
      EXPECT_NEAR(sum, area, 1e-14);
      EXPECT_NEAR(of_square, square, 1e-13);
    }
  }
}

} // namespace
} // namespace revolution_test
