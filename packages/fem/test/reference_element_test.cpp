#include "rpc/fem/reference_element.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#ifdef RPC_TEST_INTREPID2
#include <Intrepid2_HGRAD_HEX_C1_FEM.hpp>
#include <Intrepid2_HGRAD_HEX_C2_FEM.hpp>
#include <Intrepid2_HGRAD_QUAD_C1_FEM.hpp>
#include <Intrepid2_HGRAD_QUAD_C2_FEM.hpp>
#include <Intrepid2_HGRAD_TRI_C1_FEM.hpp>
#include <Intrepid2_HGRAD_TRI_C2_FEM.hpp>
#endif

namespace
{

using rpc::to_host;
using rpc::fem::BasisTable;
using rpc::fem::tabulate;
using rpc::mesh::Element;
using rpc::mesh::Shape;
using Places = std::vector<std::vector<int>>;

/// One table on the host, with the nodes of its shape functions and the degree that its rule promises.
struct Table {
  std::string name;
  bool triangle;     // reference cell: 0 <= x, 0 <= y, x + y <= 1; else [-1, 1]^d
  int order, degree; // degree: exact to, in each direction; in triangles, in both together
  Places lattice;    // of the nodes, {0 .. order}^d
  rpc::HostView<double **> value;
  rpc::HostView<double ***> gradient;
  rpc::HostView<double *> weight;
  std::vector<std::vector<double>> point; // sum_a N_a x_a

  Table(const std::string &title, const Element &element, const BasisTable &table, const Places &nodes, const int exact)
      : name(title + " of " + element.name() + " in " + std::to_string(element.dim) + "D"),
        triangle(element.shape == Shape::simplex && nodes[0].size() == 2), order(element.order), degree(exact),
        lattice(nodes), value("value", table.value.extent(0), table.value.extent(1)),
        gradient("gradient", table.gradient.extent(0), table.gradient.extent(1), table.gradient.extent(2)),
        weight("weight", table.weight.extent(0))
  {
    Kokkos::deep_copy(value, to_host(table.value));
    Kokkos::deep_copy(gradient, to_host(table.gradient));
    Kokkos::deep_copy(weight, to_host(table.weight));
    for (int q = 0; q < num_points(); ++q) {
      point.emplace_back(dim(), 0.);
      for (int a = 0; a < num_nodes(); ++a)
        for (int k = 0; k < dim(); ++k) point[q][k] += value(q, a) * node(a, k);
    }
  }
  int dim() const { return static_cast<int>(lattice[0].size()); }
  int num_points() const { return static_cast<int>(weight.extent(0)); }
  int num_nodes() const { return static_cast<int>(lattice.size()); }
  double node(const int a, const int k) const
  {
    const double t = double(lattice[a][k]) / order;
    return triangle ? t : -1 + 2 * t;
  }
  double volume() const { return triangle ? 0.5 : 1 << dim(); }
};

/// A facet's own nodes: ends then middle, or those of a quadrilateral.
Places facet_lattice(const Element &element)
{
  if (element.dim == 3) return Element{2, element.order}.lattice();
  return element.order == 1 ? Places{{0}, {1}} : Places{{0}, {2}, {1}};
}

std::vector<Element> all_elements()
{
  return {{2, 1}, {2, 2}, {3, 1}, {3, 2}, {2, 1, Shape::simplex}, {2, 2, Shape::simplex}};
}

std::vector<Table> all_tables()
{
  std::vector<Table> tables;
  for (const Element &element : all_elements()) {
    const auto reference = tabulate(element);
    const int p = element.order; // n Gauss points are exact to 2n - 1, n Lobatto points to 2n - 3
    const bool triangle = element.shape == Shape::simplex;
    const int cell = triangle ? p : 2 * (p + 1) - 1, load = triangle ? 2 * p : cell,
              recovery = triangle ? p : 2 * p - 1;
    tables.emplace_back("cell", element, reference.cell, element.lattice(), cell);
    tables.emplace_back("cell_load", element, reference.cell_load, element.lattice(), load);
    tables.emplace_back("recovery", element, reference.recovery, element.lattice(), recovery);
    tables.emplace_back("facet", element, reference.facet, facet_lattice(element), 2 * (p + 2) - 1);
    tables.emplace_back("facet_nodal", element, reference.facet_nodal, facet_lattice(element), 2 * (p + 1) - 3);
  }
  return tables;
}

/// Lagrange polynomials on -1, 1 or -1, 0, 1, written out.
double lagrange(const int i, const int order, const double x)
{
  if (order == 1) return i == 0 ? (1 - x) / 2 : (1 + x) / 2;
  return i == 0 ? x * (x - 1) / 2 : i == 1 ? 1 - x * x : x * (x + 1) / 2;
}
double lagrange_slope(const int i, const int order, const double x)
{
  if (order == 1) return i == 0 ? -0.5 : 0.5;
  return i == 0 ? x - 0.5 : i == 1 ? -2 * x : x + 0.5;
}

TEST(ReferenceElement, ShapeFunctionsAreProductsOfLagrangePolynomials)
{
  for (const Table &table : all_tables()) {
    if (table.triangle) continue; // see below
    SCOPED_TRACE(table.name);
    for (int q = 0; q < table.num_points(); ++q) {
      for (int a = 0; a < table.num_nodes(); ++a) {
        double value = 1;
        std::vector<double> gradient(table.dim(), 1.);
        for (int k = 0; k < table.dim(); ++k) {
          const double x = table.point[q][k], factor = lagrange(table.lattice[a][k], table.order, x);
          value *= factor;
          for (int g = 0; g < table.dim(); ++g)
            gradient[g] *= g == k ? lagrange_slope(table.lattice[a][k], table.order, x) : factor;
        }
        EXPECT_NEAR(table.value(q, a), value, 1e-14);
        for (int g = 0; g < table.dim(); ++g) EXPECT_NEAR(table.gradient(q, a, g), gradient[g], 1e-14);
      }
    }
  }
}

/// The shape function of a triangle's node: for each barycentric coordinate L that is m/order at the node, the polynomial
/// in L of degree m which is 1 there, and 0 where L is 0/order .. (m - 1)/order.
double triangle_shape(const Table &table, const int a, const double x, const double y)
{
  const int i = table.lattice[a][0], j = table.lattice[a][1];
  const double L[3] = {1 - x - y, x, y};
  const int m[3] = {table.order - i - j, i, j};
  double value = 1;
  for (int k = 0; k < 3; ++k)
    for (int s = 0; s < m[k]; ++s) value *= (table.order * L[k] - s) / (m[k] - s);
  return value;
}

TEST(ReferenceElement, ShapeFunctionsOfTrianglesAreProductsOverTheBarycentricCoordinates)
{
  const double h = 0.5; // differences of quadratic functions are exact
  int compared = 0;
  for (const Table &table : all_tables()) {
    if (!table.triangle) continue;
    SCOPED_TRACE(table.name);
    ++compared;
    for (int q = 0; q < table.num_points(); ++q) {
      const double x = table.point[q][0], y = table.point[q][1];
      for (int a = 0; a < table.num_nodes(); ++a) {
        EXPECT_NEAR(table.value(q, a), triangle_shape(table, a, x, y), 1e-15);
        EXPECT_NEAR(table.gradient(q, a, 0),
                    (triangle_shape(table, a, x + h, y) - triangle_shape(table, a, x - h, y)) / (2 * h), 1e-14);
        EXPECT_NEAR(table.gradient(q, a, 1),
                    (triangle_shape(table, a, x, y + h) - triangle_shape(table, a, x, y - h)) / (2 * h), 1e-14);
      }
    }
  }
  EXPECT_EQ(compared, 6);
}

TEST(ReferenceElement, NumbersOfPointsAreThosePromised)
{
  for (const Element &element : all_elements()) {
    SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim) + "D");
    const auto reference = tabulate(element);
    const int p = element.order;
    const auto power = [&](const int n) { return static_cast<int>(std::lround(std::pow(n, element.dim))); };
    const bool triangle = element.shape == Shape::simplex;
    EXPECT_EQ(reference.cell.num_points(), triangle ? (p == 1 ? 1 : 3) : power(p + 1));
    EXPECT_EQ(reference.cell_load.num_points(), triangle ? (p == 1 ? 3 : 6) : power(p + 1));
    EXPECT_EQ(reference.recovery.num_points(), triangle ? (p == 1 ? 1 : 3) : power(p));
    EXPECT_TRUE(reference.element == element);
  }
}

TEST(ReferenceElement, ShapeFunctionsSumToOneAndTheirGradientsToZero)
{
  for (const Table &table : all_tables()) {
    SCOPED_TRACE(table.name);
    for (int q = 0; q < table.num_points(); ++q) {
      double sum = 0;
      for (int a = 0; a < table.num_nodes(); ++a) sum += table.value(q, a);
      EXPECT_NEAR(sum, 1, 1e-14);
      for (int g = 0; g < table.dim(); ++g) {
        double slope = 0;
        for (int a = 0; a < table.num_nodes(); ++a) slope += table.gradient(q, a, g);
        EXPECT_NEAR(slope, 0, 1e-14);
      }
    }
  }
}

TEST(ReferenceElement, NodalRuleHasItsPointsAtTheNodesInTheirOrder)
{
  for (const Element &element : all_elements()) {
    const auto reference = tabulate(element);
    const Table table("facet_nodal", element, reference.facet_nodal, facet_lattice(element), 0);
    SCOPED_TRACE(table.name);
    ASSERT_EQ(table.num_points(), table.num_nodes());
    for (int q = 0; q < table.num_points(); ++q)
      for (int a = 0; a < table.num_nodes(); ++a) EXPECT_EQ(table.value(q, a), q == a ? 1 : 0);
  }
}

/// A rule's sum for x^i y^j z^k.
double sum_of(const Table &table, const std::vector<int> &exponent)
{
  double sum = 0;
  for (int q = 0; q < table.num_points(); ++q) {
    double term = table.weight(q);
    for (int k = 0; k < table.dim(); ++k) term *= std::pow(table.point[q][k], exponent[k]);
    sum += term;
  }
  return sum;
}

/// Its integral over the reference cell; in triangles i! j! / (i + j + 2)!.
double integral_of(const Table &table, const std::vector<int> &exponent)
{
  if (table.triangle)
    return std::tgamma(exponent[0] + 1) * std::tgamma(exponent[1] + 1) / std::tgamma(exponent[0] + exponent[1] + 3);
  double exact = 1;
  for (const int e : exponent) exact *= e % 2 == 1 ? 0 : 2. / (e + 1);
  return exact;
}

/// Exponents of all monomials that a rule promises to integrate exactly.
std::vector<std::vector<int>> monomials(const Table &table)
{
  std::vector<std::vector<int>> all;
  const int n = table.degree + 1, products = static_cast<int>(std::lround(std::pow(n, table.dim())));
  for (int m = 0; m < products; ++m) {
    std::vector<int> exponent;
    for (int k = 0, rest = m; k < table.dim(); ++k, rest /= n) exponent.push_back(rest % n);
    if (!table.triangle || exponent[0] + exponent[1] <= table.degree) all.push_back(exponent);
  }
  return all;
}

TEST(Quadrature, IsExactToThePromisedDegree)
{
  for (const Table &table : all_tables()) {
    SCOPED_TRACE(table.name);
    for (const auto &exponent : monomials(table))
      EXPECT_NEAR(sum_of(table, exponent), integral_of(table, exponent), 1e-14 * table.volume())
          << testing::PrintToString(exponent);
  }
}

TEST(Quadrature, IsNotExactOneDegreeAbove)
{
  for (const Table &table : all_tables()) {
    SCOPED_TRACE(table.name);
    for (int k = 0; k < table.dim(); ++k) {
      std::vector<int> exponent(table.dim(), 0);
      exponent[k] = table.degree + 1;
      const double exact = integral_of(table, exponent), error = std::abs(sum_of(table, exponent) - exact);
      EXPECT_GT(error, 1e-3 * (table.triangle ? exact : table.volume()));
    }
  }
}

TEST(Quadrature, PointsLieInsideOfTheTriangle)
{
  for (const Table &table : all_tables()) {
    for (int q = 0; q < table.num_points() && table.triangle; ++q) {
      EXPECT_GT(table.point[q][0], 0) << table.name;
      EXPECT_GT(table.point[q][1], 0) << table.name;
      EXPECT_LT(table.point[q][0] + table.point[q][1], 1) << table.name;
    }
  }
}

TEST(Quadrature, WeightsArePositiveAndSumToTheVolume)
{
  for (const Table &table : all_tables()) {
    SCOPED_TRACE(table.name);
    double sum = 0;
    for (int q = 0; q < table.num_points(); ++q) {
      EXPECT_GT(table.weight(q), 0);
      sum += table.weight(q);
    }
    EXPECT_NEAR(sum, table.volume(), 1e-14 * table.volume());
  }
}

#ifdef RPC_TEST_INTREPID2
/// Shape functions and gradients of a table against an Intrepid2 basis, whose nodes are found by their coordinates.
template <class Basis>
void expect_agreement(const Table &table)
{
  SCOPED_TRACE(table.name);
  using HostDevice = Kokkos::DefaultHostExecutionSpace::device_type;
  using View = Kokkos::DynRankView<double, HostDevice>;
  const Basis basis;
  const int nodes = table.num_nodes(), points = table.num_points(), dim = table.dim();
  ASSERT_EQ(static_cast<int>(basis.getCardinality()), nodes);
  View at("at", nodes, dim), point("point", points, dim), value("value", nodes, points),
      gradient("gradient", nodes, points, dim);
  basis.getDofCoords(at);
  for (int q = 0; q < points; ++q)
    for (int k = 0; k < dim; ++k) point(q, k) = table.point[q][k];
  basis.getValues(value, point, Intrepid2::OPERATOR_VALUE);
  basis.getValues(gradient, point, Intrepid2::OPERATOR_GRAD);
  for (int a = 0; a < nodes; ++a) {
    int theirs = -1;
    for (int b = 0; b < nodes; ++b) {
      bool same = true;
      for (int k = 0; k < dim; ++k) same = same && std::abs(at(b, k) - table.node(a, k)) < 1e-12;
      if (same) theirs = b;
    }
    ASSERT_GE(theirs, 0) << "node " << a;
    for (int q = 0; q < points; ++q) {
      EXPECT_NEAR(table.value(q, a), value(theirs, q), 1e-14);
      for (int g = 0; g < dim; ++g) EXPECT_NEAR(table.gradient(q, a, g), gradient(theirs, q, g), 1e-14 * 4);
    }
  }
}
#endif

TEST(ReferenceElement, AgreesWithIntrepid2)
{
#ifdef RPC_TEST_INTREPID2
  using HostDevice = Kokkos::DefaultHostExecutionSpace::device_type;
  int compared = 0;
  for (const Table &table : all_tables()) {
    if (table.dim() == 1) continue; // too simple to need a witness
    ++compared;
    if (table.triangle && table.order == 1)
      expect_agreement<Intrepid2::Basis_HGRAD_TRI_C1_FEM<HostDevice, double, double>>(table);
    else if (table.triangle)
      expect_agreement<Intrepid2::Basis_HGRAD_TRI_C2_FEM<HostDevice, double, double>>(table);
    else if (table.dim() == 2 && table.order == 1)
      expect_agreement<Intrepid2::Basis_HGRAD_QUAD_C1_FEM<HostDevice, double, double>>(table);
    else if (table.dim() == 2)
      expect_agreement<Intrepid2::Basis_HGRAD_QUAD_C2_FEM<HostDevice, double, double>>(table);
    else if (table.order == 1)
      expect_agreement<Intrepid2::Basis_HGRAD_HEX_C1_FEM<HostDevice, double, double>>(table);
    else
      expect_agreement<Intrepid2::Basis_HGRAD_HEX_C2_FEM<HostDevice, double, double>>(table);
  }
  EXPECT_EQ(compared, 22);
#else
  GTEST_SKIP() << "this Trilinos has no Intrepid2";
#endif
}

} // namespace
