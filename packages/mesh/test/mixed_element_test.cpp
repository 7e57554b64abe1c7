// SPDX-License-Identifier: BSD-3-Clause
#include "expect_error.hpp"
#include "rpc/mesh/box.hpp"
#include "rpc/mesh/shape_functions.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace mixed_element_test
{
namespace
{

using namespace rpc;
using mesh::Element;
using mesh::mixed_elements;

/// Calls check(element, constant of its dimension).
template <class Check>
void for_each_mixed(const Check &check)
{
  for (const Element &element : mixed_elements(2)) check(element, std::integral_constant<int, 2>());
  for (const Element &element : mixed_elements(3)) check(element, std::integral_constant<int, 3>());
}

TEST(MixedElement, HasTheOrderOfEachDirectionInItsName)
{
  std::set<std::string> names;
  for_each_mixed([&](const Element &element, auto) { names.insert(element.name()); });
  EXPECT_EQ(names, (std::set<std::string>{"Q12", "Q21", "Q112", "Q121", "Q211", "Q122", "Q212", "Q221"}));
}

TEST(MixedElement, IsNoneThatADeckCanAskFor)
{
  for_each_mixed([](const Element &element, auto) {
    test::expect_error(ExitCode::bad_input, {"\"Mesh->Element\"", "P1, P2, Q1, Q2"},
                       [&] { mesh::parse_element(element.name(), element.dim); });
    for (const Element &other : mesh::all_elements()) EXPECT_FALSE(other == element);
  });
}

TEST(MixedElement, EndsAsOrderOne)
{
  EXPECT_TRUE((Element{3, 2}.with_order_one_along({true, true, true}) == Element{3, 1}));
  EXPECT_TRUE((Element{2, 2}.with_order_one_along({true, false, false}).with_order_one_along({false, true, false}) ==
               Element{2, 1}));
  EXPECT_TRUE((Element{2, 1}.with_order_one_along({true, false, false}) == Element{2, 1}));
}

TEST(MixedElement, HasTheNodesOfItsLattice)
{
  for_each_mixed([](const Element &element, auto) {
    std::set<std::vector<int>> places;
    int expected = 1;
    for (int d = 0; d < element.dim; ++d) expected *= element.order_along(d) + 1;
    for (const auto &place : element.lattice()) {
      for (int d = 0; d < element.dim; ++d) EXPECT_TRUE(0 <= place[d] && place[d] <= element.order_along(d));
      places.insert(place);
    }
    EXPECT_EQ(element.num_nodes(), expected) << element.name();
    EXPECT_EQ(static_cast<int>(places.size()), expected) << element.name();
    for (int v = 0; v < element.num_vertices(); ++v)
      for (int d = 0; d < element.dim; ++d) EXPECT_EQ(element.lattice()[v][d] % element.order_along(d), 0);
  });
}

TEST(MixedElement, FacetsHaveAllNodesOfASide)
{
  for_each_mixed([](const Element &element, auto) {
    ASSERT_EQ(element.num_facets(), 2 * element.dim);
    std::set<std::pair<int, bool>> sides;
    for (const auto &facet : element.facets())
      for (int d = 0; d < element.dim; ++d)
        for (const bool upper : {false, true}) {
          const int end = upper ? element.order_along(d) : 0;
          const auto on_side = [&](const int a) { return element.lattice()[a][d] == end; };
          if (!std::all_of(facet.begin(), facet.end(), on_side)) continue;
          sides.insert({d, upper});
          int nodes = 0;
          for (int a = 0; a < element.num_nodes(); ++a) nodes += on_side(a);
          EXPECT_EQ(static_cast<int>(facet.size()), nodes) << element.name();
        }
    EXPECT_EQ(static_cast<int>(sides.size()), 2 * element.dim) << element.name();
  });
}

/// 1 at its own node, 0 at others; exact for products of polynomials of each direction's order.
TEST(MixedElement, ShapeFunctionsReproduceTheirPolynomials)
{
  for_each_mixed([](const Element &element, const auto dim) {
    const mesh::MixedShapeFunctions<dim> shape(element);
    const auto f = [&](const double *const x) {
      double product = 1;
      for (int d = 0; d < dim; ++d) product *= 0.7 + (d + 1) * x[d] - (element.order_along(d) - 1) * 1.3 * x[d] * x[d];
      return product;
    };
    double at_node[shape.most] = {}, N[shape.most];
    for (int a = 0; a < element.num_nodes(); ++a) {
      double x[dim];
      for (int d = 0; d < dim; ++d) x[d] = 2. * element.lattice()[a][d] / element.order_along(d) - 1;
      at_node[a] = f(x);
      shape.evaluate(x, N);
      for (int b = 0; b < shape.most; ++b) EXPECT_NEAR(N[b], a == b ? 1 : 0, 1e-15) << element.name();
    }
    for (int k = 0; k < 20; ++k) {
      double x[dim], sum = 0, value = 0;
      for (int d = 0; d < dim; ++d) x[d] = std::sin(1. + 7 * k + 3 * d);
      shape.evaluate(x, N);
      for (int a = 0; a < element.num_nodes(); ++a) {
        sum += N[a];
        value += N[a] * at_node[a];
      }
      EXPECT_NEAR(sum, 1, 1e-14) << element.name();
      EXPECT_NEAR(value, f(x), 1e-13) << element.name();
    }
  });
}

/// Nodes, and where sides and corners are.
TEST(MixedElement, MakesABoxOnAnyRanks)
{
  const auto comm = Tpetra::getDefaultComm();
  for_each_mixed([&](const Element &element, const auto dim) {
    mesh::BoxOptions box{{-1, 2, 0}, {1, 3, 5}, {5, 4, 3}, element, {1.5, 1, 2}};
    for (auto *list : {&box.lower, &box.upper, &box.last}) list->resize(dim);
    box.cells.resize(dim);
    const mesh::Mesh made = mesh::make_box(box, comm);
    GO nodes = 1;
    for (int d = 0; d < dim; ++d) nodes *= box.intervals(d) + 1;
    EXPECT_EQ(static_cast<GO>(made.owned_nodes->getGlobalNumElements()), nodes) << element.name();
    const auto coords = to_host(made.coords);
    for (LO n = 0; n < made.num_owned_nodes(); ++n) {
      GO id = made.node_id(n);
      for (int d = 0; d < dim; ++d) {
        const int order = element.order_along(d);
        const GO at = id % (box.intervals(d) + 1);
        id /= box.intervals(d) + 1;
        const double last = (box.cells[d] - 1), along = double(at) / order;
        const double x = along > last ? last + box.last[d] * (along - last) : along;
        EXPECT_NEAR(coords(n, d), box.lower[d] + x * box.cell_length(d), 1e-14) << element.name();
      }
    }
    for (const mesh::Side &side : made.sides) {
      const std::size_t d = side.name == "left" || side.name == "right"   ? 0
                            : side.name == "bottom" || side.name == "top" ? 1
                                                                          : 2;
      const bool upper = side.name == "right" || side.name == "top" || side.name == "front";
      const auto on_side = made.nodes_of(side.name, "test");
      LO expected = 0;
      for (LO n = 0; n < made.num_owned_nodes(); ++n)
        expected += coords(n, d) == (upper ? box.upper[d] : box.lower[d]) ? 1 : 0;
      EXPECT_EQ(static_cast<LO>(on_side.size()), expected) << element.name() << ", " << side.name;
      for (const LO n : on_side) EXPECT_EQ(coords(n, d), upper ? box.upper[d] : box.lower[d]) << side.name;
    }
  });
}

} // namespace
} // namespace mixed_element_test
