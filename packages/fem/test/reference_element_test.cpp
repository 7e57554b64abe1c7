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
#endif

namespace
{

using rpc::to_host;
using rpc::fem::BasisTable;
using rpc::fem::tabulate;
using rpc::mesh::Element;
using Places = std::vector<std::vector<int>>;

/// One table on the host, with the nodes of its shape functions and the degree that its rule promises.
struct Table {
  std::string name;
  int order, degree; // degree: exact to, in each direction
  Places lattice;    // of the nodes, {0 .. order}^d
  rpc::HostView<double **> value;
  rpc::HostView<double ***> gradient;
  rpc::HostView<double *> weight;
  std::vector<std::vector<double>> point; // on [-1, 1]^d, sum_a N_a x_a

  Table(const std::string &title, const Element &element, const BasisTable &table, const Places &nodes, const int exact)
      : name(title + " of " + element.name() + " in " + std::to_string(element.dim) + "D"), order(element.order),
        degree(exact), lattice(nodes), value("value", table.value.extent(0), table.value.extent(1)),
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
  double node(const int a, const int k) const { return -1 + 2. * lattice[a][k] / order; }
};

/// A facet's own nodes: ends then middle, or those of a quadrilateral.
Places facet_lattice(const Element &element)
{
  if (element.dim == 3) return Element{2, element.order}.lattice();
  return element.order == 1 ? Places{{0}, {1}} : Places{{0}, {2}, {1}};
}

std::vector<Element> all_elements()
{
  return {{2, 1}, {2, 2}, {3, 1}, {3, 2}};
}

std::vector<Table> all_tables()
{
  std::vector<Table> tables;
  for (const Element &element : all_elements()) {
    const auto reference = tabulate(element);
    const int p = element.order; // n Gauss points are exact to 2n - 1, n Lobatto points to 2n - 3
    tables.emplace_back("cell", element, reference.cell, element.lattice(), 2 * (p + 1) - 1);
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

/// The rule's error on x_k^power, relative to the volume 2^d.
double error_on(const Table &table, const int k, const int power)
{
  double sum = 0;
  for (int q = 0; q < table.num_points(); ++q) sum += table.weight(q) * std::pow(table.point[q][k], power);
  const double exact = power % 2 == 1 ? 0 : 1. / (power + 1); // mean over [-1, 1]
  return std::abs(sum / (1 << table.dim()) - exact);
}

TEST(Quadrature, IsExactToThePromisedDegreeInEachDirection)
{
  for (const Table &table : all_tables()) {
    SCOPED_TRACE(table.name);
    // all products x^i y^j z^k with exponents up to the degree
    const int n = table.degree + 1, monomials = static_cast<int>(std::lround(std::pow(n, table.dim())));
    for (int m = 0; m < monomials; ++m) {
      double sum = 0, exact = 1;
      for (int k = 0, rest = m; k < table.dim(); ++k, rest /= n) exact *= rest % n % 2 == 1 ? 0 : 2. / (rest % n + 1);
      for (int q = 0; q < table.num_points(); ++q) {
        double term = table.weight(q);
        for (int k = 0, rest = m; k < table.dim(); ++k, rest /= n) term *= std::pow(table.point[q][k], rest % n);
        sum += term;
      }
      EXPECT_NEAR(sum, exact, 1e-14 * (1 << table.dim())) << "monomial " << m;
    }
  }
}

TEST(Quadrature, IsNotExactOneDegreeAbove)
{
  for (const Table &table : all_tables()) {
    SCOPED_TRACE(table.name);
    for (int k = 0; k < table.dim(); ++k) EXPECT_GT(error_on(table, k, table.degree + 1), 1e-3);
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
    EXPECT_NEAR(sum, 1 << table.dim(), 1e-14 * (1 << table.dim()));
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
    if (table.dim() == 2 && table.order == 1)
      expect_agreement<Intrepid2::Basis_HGRAD_QUAD_C1_FEM<HostDevice, double, double>>(table);
    else if (table.dim() == 2)
      expect_agreement<Intrepid2::Basis_HGRAD_QUAD_C2_FEM<HostDevice, double, double>>(table);
    else if (table.order == 1)
      expect_agreement<Intrepid2::Basis_HGRAD_HEX_C1_FEM<HostDevice, double, double>>(table);
    else
      expect_agreement<Intrepid2::Basis_HGRAD_HEX_C2_FEM<HostDevice, double, double>>(table);
  }
  EXPECT_EQ(compared, 8);
#else
  GTEST_SKIP() << "this Trilinos has no Intrepid2";
#endif
}

} // namespace
