// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/quadrature.hpp"

#include "expect_error.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <string>
#include <vector>

namespace quadrature_test
{
namespace
{

using rpc::mesh::all_elements;
using rpc::mesh::Element;
using rpc::mesh::QuadratureRule;
using rpc::mesh::Shape;

struct Cell {
  std::string name;
  int dim;
  Shape shape;
  int highest; // degree that there is a rule for

  bool simplex() const { return shape == Shape::simplex; }
};

const std::vector<Cell> cells = {{"interval", 1, Shape::tensor, 7},
                                 {"triangle", 2, Shape::simplex, 6},
                                 {"quadrilateral", 2, Shape::tensor, 7},
                                 {"tetrahedron", 3, Shape::simplex, 5},
                                 {"hexahedron", 3, Shape::tensor, 7}};

/// A rule's sum for the monomial of these exponents.
double sum_of(const QuadratureRule &rule, const std::vector<int> &exponent)
{
  double sum = 0;
  for (int q = 0; q < rule.num_points(); ++q) {
    double term = rule.weight[q];
    for (std::size_t d = 0; d < exponent.size(); ++d) term *= std::pow(rule.point[q][d], exponent[d]);
    sum += term;
  }
  return sum;
}

/// Its integral over the reference cell; in simplices i! j! k! / (i + j + k + dim)!.
double integral_of(const bool simplex, const std::vector<int> &exponent)
{
  double exact = 1;
  if (simplex) {
    for (const int e : exponent) exact *= std::tgamma(e + 1);
    return exact / std::tgamma(std::accumulate(exponent.begin(), exponent.end(), 0) + int(exponent.size()) + 1);
  }
  for (const int e : exponent) exact *= e % 2 == 1 ? 0 : 2. / (e + 1);
  return exact;
}
double volume(const bool simplex, const int dim)
{
  return integral_of(simplex, std::vector<int>(dim, 0));
}

/// Exponents of all monomials up to a degree: in each coordinate, or for simplices in all together.
std::vector<std::vector<int>> monomials(const bool simplex, const int dim, const int degree)
{
  std::vector<std::vector<int>> all;
  const int n = degree + 1, products = static_cast<int>(std::lround(std::pow(n, dim)));
  for (int m = 0; m < products; ++m) {
    std::vector<int> exponent;
    for (int k = 0, rest = m; k < dim; ++k, rest /= n) exponent.push_back(rest % n);
    if (!simplex || std::accumulate(exponent.begin(), exponent.end(), 0) <= degree) all.push_back(exponent);
  }
  return all;
}

void expect_exact(const QuadratureRule &rule, const bool simplex, const int dim, const int degree)
{
  for (const auto &exponent : monomials(simplex, dim, degree))
    EXPECT_NEAR(sum_of(rule, exponent), integral_of(simplex, exponent), 1e-14 * volume(simplex, dim))
        << testing::PrintToString(exponent);
}

TEST(Quadrature, IsExactToTheDegreeThatIsAskedFor)
{
  for (const Cell &cell : cells)
    for (int degree = 0; degree <= cell.highest; ++degree) {
      SCOPED_TRACE(cell.name + ", degree " + std::to_string(degree));
      expect_exact(rpc::mesh::quadrature(cell.dim, cell.shape, degree), cell.simplex(), cell.dim, degree);
    }
}

TEST(Quadrature, HasNoMorePointsThanItNeeds)
{
  const auto points = [](const Cell &cell) {
    std::vector<int> number;
    for (int degree = 0; degree <= cell.highest; ++degree)
      number.push_back(rpc::mesh::quadrature(cell.dim, cell.shape, degree).num_points());
    return number;
  };
  EXPECT_EQ(points(cells[0]), (std::vector<int>{1, 1, 2, 2, 3, 3, 4, 4}));
  EXPECT_EQ(points(cells[1]), (std::vector<int>{1, 1, 3, 6, 6, 12, 12}));
  EXPECT_EQ(points(cells[2]), (std::vector<int>{1, 1, 4, 4, 9, 9, 16, 16}));
  EXPECT_EQ(points(cells[3]), (std::vector<int>{1, 1, 4, 8, 14, 14}));
  EXPECT_EQ(points(cells[4]), (std::vector<int>{1, 1, 8, 8, 27, 27, 64, 64}));
}

TEST(Quadrature, PointsLieInsideAndWeightsArePositiveAndSumToTheVolume)
{
  for (const Cell &cell : cells)
    for (int degree = 0; degree <= cell.highest; ++degree) {
      SCOPED_TRACE(cell.name + ", degree " + std::to_string(degree));
      const QuadratureRule rule = rpc::mesh::quadrature(cell.dim, cell.shape, degree);
      ASSERT_EQ(rule.point.size(), rule.weight.size());
      double total = 0;
      for (int q = 0; q < rule.num_points(); ++q) {
        EXPECT_GT(rule.weight[q], 0);
        total += rule.weight[q];
        double sum = 0;
        for (int d = 0; d < 3; ++d) {
          if (d < cell.dim) {
            EXPECT_GT(rule.point[q][d], cell.simplex() ? 0 : -1);
            EXPECT_LT(rule.point[q][d], 1);
          } else {
            EXPECT_EQ(rule.point[q][d], 0);
          }
          sum += rule.point[q][d];
        }
        EXPECT_LT(cell.simplex() ? sum : 0, 1);
      }
      EXPECT_NEAR(total, volume(cell.simplex(), cell.dim), 1e-15 * 8);
    }
}

TEST(Quadrature, IsNotExactFarAboveItsDegree)
{
  for (const Cell &cell : cells) { // a rule that is exact for all degrees would mean that the test cannot fail
    const QuadratureRule rule = rpc::mesh::quadrature(cell.dim, cell.shape, cell.highest);
    std::vector<int> exponent(cell.dim, 0);
    exponent[0] = cell.highest + (cell.simplex() ? 2 : 1);
    const double exact = integral_of(cell.simplex(), exponent);
    EXPECT_GT(std::abs(sum_of(rule, exponent) - exact), 1e-4 * exact) << cell.name;
  }
}

TEST(Quadrature, RefusesDegreesThatItHasNoRuleFor)
{
  for (const Cell &cell : cells)
    rpc::test::expect_error(rpc::ExitCode::internal_error, {"quadrature", "degree"},
                            [&] { rpc::mesh::quadrature(cell.dim, cell.shape, cell.highest + 1); });
}

TEST(Quadrature, OfStiffnessIsExactForProductsOfGradients)
{
  // Gradients have order - 1 in simplices; in tensor products that, and the order in the other coordinates. The nodal forces of a
  // constant stress in a curved simplex are integrals of a gradient times dim - 1 slopes of the coordinates.
  for (const Element &element : all_elements()) {
    const bool simplex = element.shape == Shape::simplex;
    EXPECT_EQ(rpc::mesh::stiffness_degree(element), simplex ? element.dim * (element.order - 1) : 2 * element.order);
    EXPECT_GE(rpc::mesh::stiffness_degree(element), simplex ? 2 * (element.order - 1) : 2 * element.order);
  }
}

TEST(NodalRule, HasItsPointsAtTheNodesAndItsDegree)
{
  const std::vector<Element> elements = {
      {1, 1}, {1, 2}, {2, 1}, {2, 2}, {2, 1, Shape::simplex}, {2, 2, Shape::simplex}};
  for (const Element &element : elements) {
    SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim) + "D");
    const bool simplex = element.shape == Shape::simplex;
    const QuadratureRule rule = rpc::mesh::nodal_rule(element);
    ASSERT_EQ(rule.num_points(), element.num_nodes());
    for (int a = 0; a < element.num_nodes(); ++a)
      for (int d = 0; d < element.dim; ++d) {
        const double t = double(element.lattice()[a][d]) / element.order;
        EXPECT_EQ(rule.point[a][d], simplex ? t : 2 * t - 1);
      }
    expect_exact(rule, simplex, element.dim, simplex ? element.order : 2 * element.order - 1);
    for (int a = 0; a < element.num_nodes(); ++a) {
      const bool carries = !(simplex && element.order == 2 && a < element.num_vertices());
      EXPECT_TRUE(carries ? rule.weight[a] > 0 : rule.weight[a] == 0) << "node " << a;
    }
  }
}

} // namespace
} // namespace quadrature_test
