// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/reference_element.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <string>
#include <vector>

#ifdef RPC_TEST_INTREPID2
#include <Intrepid2_HGRAD_HEX_C1_FEM.hpp>
#include <Intrepid2_HGRAD_HEX_C2_FEM.hpp>
#include <Intrepid2_HGRAD_QUAD_C1_FEM.hpp>
#include <Intrepid2_HGRAD_QUAD_C2_FEM.hpp>
#include <Intrepid2_HGRAD_TET_C1_FEM.hpp>
#include <Intrepid2_HGRAD_TET_C2_FEM.hpp>
#include <Intrepid2_HGRAD_TRI_C1_FEM.hpp>
#include <Intrepid2_HGRAD_TRI_C2_FEM.hpp>
#endif

namespace reference_element_test
{
namespace
{

using rpc::to_host;
using rpc::fem::BasisTable;
using rpc::fem::tabulate;
using rpc::mesh::all_elements;
using rpc::mesh::Element;
using rpc::mesh::Shape;

/// One table on the host, with the element of its shape functions and the degree that its rule promises.
struct Table {
  std::string name;
  Element element; // of a cell or facet
  int degree;      // exact to, in each direction; in simplices, in all together
  rpc::HostView<double **> value;
  rpc::HostView<double ***> gradient;
  rpc::HostView<double *> weight;
  std::vector<std::vector<double>> point; // sum_a N_a x_a

  Table(const std::string &title, const Element &of, const BasisTable &table, const int exact)
      : name(title + " of " + of.name() + " in " + std::to_string(of.dim) + "D"), element(of), degree(exact),
        value("value", table.value.extent(0), table.value.extent(1)),
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
  bool simplex() const { return element.shape == Shape::simplex; }
  int dim() const { return element.dim; }
  int num_points() const { return static_cast<int>(weight.extent(0)); }
  int num_nodes() const { return element.num_nodes(); }
  double node(const int a, const int k) const
  {
    const double t = double(element.lattice()[a][k]) / element.order;
    return simplex() ? t : -1 + 2 * t;
  }
  double volume() const { return simplex() ? 1 / std::tgamma(dim() + 1) : 1 << dim(); }
};

std::vector<Table> all_tables()
{
  std::vector<Table> tables;
  for (const Element &element : all_elements()) {
    const int p = element.order;
    const auto reference = tabulate(element);
    const Element facet = element.facet();
    const bool simplex = element.shape == Shape::simplex, triangle = facet.shape == Shape::simplex;
    tables.emplace_back("cell", element, reference.cell, simplex ? 2 * p - 2 : 2 * p + 1);
    tables.emplace_back("cell_load", element, reference.cell_load, simplex ? 2 * p : 2 * p + 1);
    tables.emplace_back("recovery", element, reference.recovery, simplex ? 2 * p - 2 : 2 * p - 1);
    tables.emplace_back("facet", facet, reference.facet, triangle ? 2 * p + 2 : 2 * p + 3);
    tables.emplace_back("facet_nodal", facet, reference.facet_nodal, triangle ? p : 2 * p - 1);
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
    if (table.simplex()) continue; // see below
    SCOPED_TRACE(table.name);
    for (int q = 0; q < table.num_points(); ++q) {
      for (int a = 0; a < table.num_nodes(); ++a) {
        double value = 1;
        std::vector<double> gradient(table.dim(), 1.);
        for (int k = 0; k < table.dim(); ++k) {
          const double x = table.point[q][k], factor = lagrange(table.element.lattice()[a][k], table.element.order, x);
          value *= factor;
          for (int g = 0; g < table.dim(); ++g)
            gradient[g] *= g == k ? lagrange_slope(table.element.lattice()[a][k], table.element.order, x) : factor;
        }
        EXPECT_NEAR(table.value(q, a), value, 1e-14);
        for (int g = 0; g < table.dim(); ++g) EXPECT_NEAR(table.gradient(q, a, g), gradient[g], 1e-14);
      }
    }
  }
}

/// The shape function of a simplex' node: for each barycentric coordinate L that is m/order at the node, the polynomial in L
/// of degree m which is 1 there, and 0 where L is 0/order .. (m - 1)/order.
double simplex_function(const Table &table, const int a, const std::vector<double> &x)
{
  const int order = table.element.order;
  const auto &lattice = table.element.lattice()[a];
  std::vector<double> L = {1 - std::accumulate(x.begin(), x.end(), 0.)};
  std::vector<int> m = {order - std::accumulate(lattice.begin(), lattice.end(), 0)};
  L.insert(L.end(), x.begin(), x.end());
  m.insert(m.end(), lattice.begin(), lattice.end());
  double value = 1;
  for (std::size_t k = 0; k < L.size(); ++k)
    for (int s = 0; s < m[k]; ++s) value *= (order * L[k] - s) / (m[k] - s);
  return value;
}

TEST(ReferenceElement, ShapeFunctionsOfSimplicesAreProductsOverTheBarycentricCoordinates)
{
  const double h = 0.5; // differences of quadratic functions are exact
  int compared = 0;
  for (const Table &table : all_tables()) {
    if (!table.simplex()) continue;
    SCOPED_TRACE(table.name);
    ++compared;
    for (int q = 0; q < table.num_points(); ++q) {
      const std::vector<double> &x = table.point[q];
      for (int a = 0; a < table.num_nodes(); ++a) {
        EXPECT_NEAR(table.value(q, a), simplex_function(table, a, x), 2e-15);
        for (int d = 0; d < table.dim(); ++d) {
          std::vector<double> before = x, after = x;
          before[d] -= h;
          after[d] += h;
          EXPECT_NEAR(table.gradient(q, a, d),
                      (simplex_function(table, a, after) - simplex_function(table, a, before)) / (2 * h), 1e-14);
        }
      }
    }
  }
  EXPECT_EQ(compared, 6 + 10); // triangles' cells; tetrahedra and their facets
}

TEST(ReferenceElement, NumbersOfPointsAreThosePromised)
{
  struct Numbers {
    int cell, cell_load, recovery, facet;
  };
  const std::vector<Numbers> expected = {{1, 3, 1, 3}, {3, 6, 3, 4},   {4, 4, 1, 3}, {9, 9, 4, 4},
                                         {1, 4, 1, 6}, {8, 14, 8, 12}, {8, 8, 1, 9}, {27, 27, 8, 16}};
  ASSERT_EQ(all_elements().size(), expected.size());
  for (std::size_t e = 0; e < expected.size(); ++e) {
    const Element &element = all_elements()[e];
    SCOPED_TRACE(element.name() + " in " + std::to_string(element.dim) + "D");
    const auto reference = tabulate(element);
    EXPECT_EQ(reference.cell.num_points(), expected[e].cell);
    EXPECT_EQ(reference.cell_load.num_points(), expected[e].cell_load);
    EXPECT_EQ(reference.recovery.num_points(), expected[e].recovery);
    EXPECT_EQ(reference.facet.num_points(), expected[e].facet);
    EXPECT_EQ(reference.facet_nodal.num_points(), element.num_facet_nodes());
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
    const Table table("facet_nodal", element.facet(), reference.facet_nodal, 0);
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

/// Its integral over the reference cell; in simplices i! j! k! / (i + j + k + dim)!.
double integral_of(const Table &table, const std::vector<int> &exponent)
{
  double exact = 1;
  if (table.simplex()) {
    for (const int e : exponent) exact *= std::tgamma(e + 1);
    return exact / std::tgamma(std::accumulate(exponent.begin(), exponent.end(), 0) + table.dim() + 1);
  }
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
    if (!table.simplex() || std::accumulate(exponent.begin(), exponent.end(), 0) <= table.degree)
      all.push_back(exponent);
  }
  return all;
}

TEST(ReferenceElement, RulesAreExactToThePromisedDegree)
{
  for (const Table &table : all_tables()) {
    SCOPED_TRACE(table.name);
    for (const auto &exponent : monomials(table))
      EXPECT_NEAR(sum_of(table, exponent), integral_of(table, exponent), 1e-14 * table.volume())
          << testing::PrintToString(exponent);
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
    if (table.simplex() && table.dim() == 2 && table.element.order == 1)
      expect_agreement<Intrepid2::Basis_HGRAD_TRI_C1_FEM<HostDevice, double, double>>(table);
    else if (table.simplex() && table.dim() == 2)
      expect_agreement<Intrepid2::Basis_HGRAD_TRI_C2_FEM<HostDevice, double, double>>(table);
    else if (table.simplex() && table.element.order == 1)
      expect_agreement<Intrepid2::Basis_HGRAD_TET_C1_FEM<HostDevice, double, double>>(table);
    else if (table.simplex())
      expect_agreement<Intrepid2::Basis_HGRAD_TET_C2_FEM<HostDevice, double, double>>(table);
    else if (table.dim() == 2 && table.element.order == 1)
      expect_agreement<Intrepid2::Basis_HGRAD_QUAD_C1_FEM<HostDevice, double, double>>(table);
    else if (table.dim() == 2)
      expect_agreement<Intrepid2::Basis_HGRAD_QUAD_C2_FEM<HostDevice, double, double>>(table);
    else if (table.element.order == 1)
      expect_agreement<Intrepid2::Basis_HGRAD_HEX_C1_FEM<HostDevice, double, double>>(table);
    else
      expect_agreement<Intrepid2::Basis_HGRAD_HEX_C2_FEM<HostDevice, double, double>>(table);
  }
  EXPECT_EQ(compared, 4 * 3 + 4 * 5);
#else
  GTEST_SKIP() << "this Trilinos has no Intrepid2";
#endif
}

} // namespace
} // namespace reference_element_test
