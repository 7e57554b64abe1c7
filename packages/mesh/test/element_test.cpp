#include "rpc/mesh/element.hpp"

#include "expect_error.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>

namespace
{

using rpc::mesh::Element;
using rpc::mesh::Shape;
using Nodes = std::vector<std::vector<int>>;

std::vector<Element> all_elements()
{
  return {{2, 1}, {2, 2}, {3, 1}, {3, 2}, {2, 1, Shape::simplex}, {2, 2, Shape::simplex}};
}

std::string text_of(const Element &element)
{
  return element.name() + " in " + std::to_string(element.dim) + "D";
}

bool is_vertex(const Element &element, const int node)
{
  const auto &at = element.lattice()[node];
  return std::all_of(at.begin(), at.end(), [&](const int k) { return k == 0 || k == element.order; });
}

TEST(Element, LatticeHasEachPositionOnceVerticesFirst)
{
  for (const Element &element : all_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto &lattice = element.lattice();
    ASSERT_EQ(static_cast<int>(lattice.size()), element.num_nodes());
    EXPECT_EQ(std::set(lattice.begin(), lattice.end()).size(), lattice.size());
    const bool simplex = element.shape == Shape::simplex;
    EXPECT_EQ(element.num_vertices(), simplex ? element.dim + 1 : 1 << element.dim);
    for (int a = 0; a < element.num_nodes(); ++a) {
      ASSERT_EQ(static_cast<int>(lattice[a].size()), element.dim);
      for (const int k : lattice[a]) EXPECT_TRUE(0 <= k && k <= element.order);
      EXPECT_TRUE(!simplex || std::accumulate(lattice[a].begin(), lattice[a].end(), 0) <= element.order);
      EXPECT_EQ(is_vertex(element, a), a < element.num_vertices());
    }
  }
}

TEST(Element, NodesAreNumberedAsInExodus)
{
  EXPECT_EQ((Element{2, 1}.lattice()), (Nodes{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  // Exodus gives the edge and face nodes of HEX27 by the vertices around them, counted from 0.
  const Nodes around = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6},
                        {6, 7}, {7, 4}, {0, 6}, {0, 2}, {4, 6}, {0, 7}, {1, 6}, {0, 5}, {3, 6}};
  const auto &hex = Element{3, 2}.lattice();
  EXPECT_EQ(Nodes(hex.begin(), hex.begin() + 8),
            (Nodes{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}}));
  for (std::size_t a = 0; a < around.size(); ++a)
    for (int d = 0; d < 3; ++d)
      EXPECT_EQ(2 * hex[8 + a][d], hex[around[a][0]][d] + hex[around[a][1]][d]) << "node " << 8 + a;
  const auto &quad = Element{2, 2}.lattice();
  for (int a = 0; a < 4; ++a)
    for (int d = 0; d < 2; ++d) EXPECT_EQ(2 * quad[4 + a][d], quad[a][d] + quad[(a + 1) % 4][d]) << "node " << 4 + a;
  EXPECT_EQ(quad[8], (std::vector<int>{1, 1}));
}

TEST(Element, NodesOfTrianglesAreNumberedAsInExodus)
{
  EXPECT_EQ((Element{2, 1, Shape::simplex}.lattice()), (Nodes{{0, 0}, {1, 0}, {0, 1}}));
  const auto &triangle = Element{2, 2, Shape::simplex}.lattice();
  EXPECT_EQ(Nodes(triangle.begin(), triangle.begin() + 3), (Nodes{{0, 0}, {2, 0}, {0, 2}}));
  for (int a = 0; a < 3; ++a) // TRI6 has its further nodes in the middle of the edges 0-1, 1-2, 2-0
    for (int d = 0; d < 2; ++d) EXPECT_EQ(2 * triangle[3 + a][d], triangle[a][d] + triangle[(a + 1) % 3][d]);
}

TEST(Element, FacetsAreTheSidesOfTheLatticeEachOnce)
{
  for (const Element &element : all_elements()) {
    SCOPED_TRACE(text_of(element));
    ASSERT_EQ(static_cast<int>(element.facets().size()), element.num_facets());
    std::set<std::pair<int, int>> sides; // direction, position; the last direction is that of the coordinates' sum
    for (const auto &facet : element.facets()) {
      ASSERT_EQ(static_cast<int>(facet.size()), element.num_facet_nodes());
      EXPECT_EQ(std::set(facet.begin(), facet.end()).size(), facet.size());
      for (int a = 0; a < element.num_facet_nodes(); ++a)
        EXPECT_EQ(is_vertex(element, facet[a]), a < 1 << (element.dim - 1));
      for (int d = 0; d <= element.dim; ++d) {
        const auto position = [&](const int node) {
          const auto &at = element.lattice()[node];
          return d < element.dim ? at[d] : std::accumulate(at.begin(), at.end(), 0);
        };
        const int first = position(facet[0]);
        if (std::all_of(facet.begin(), facet.end(), [&](const int a) { return position(a) == first; }))
          sides.insert({d, first});
      }
    }
    std::set<std::pair<int, int>> expected;
    const bool simplex = element.shape == Shape::simplex;
    for (int d = 0; d < element.dim; ++d) expected.insert({d, 0});
    for (int d = 0; d < element.dim && !simplex; ++d) expected.insert({d, element.order});
    if (simplex) expected.insert({element.dim, element.order});
    EXPECT_EQ(sides, expected);
  }
}

TEST(Element, FacetsComeInTheOrderOfExodusSides)
{
  EXPECT_EQ((Element{2, 1}.facets()), (Nodes{{0, 1}, {1, 2}, {2, 3}, {3, 0}}));
  EXPECT_EQ((Element{2, 2}.facets()), (Nodes{{0, 1, 4}, {1, 2, 5}, {2, 3, 6}, {3, 0, 7}}));
  EXPECT_EQ((Element{2, 1, Shape::simplex}.facets()), (Nodes{{0, 1}, {1, 2}, {2, 0}}));
  EXPECT_EQ((Element{2, 2, Shape::simplex}.facets()), (Nodes{{0, 1, 3}, {1, 2, 4}, {2, 0, 5}}));
  EXPECT_EQ((Element{3, 1}.facets()),
            (Nodes{{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}}));
}

TEST(Element, FacetNodesWalkTheFacetsOwnLatticeWithTheNormalOutward)
{
  for (const Element &element : all_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto &lattice = element.lattice();
    for (const auto &facet : element.facets()) {
      const auto &x0 = lattice[facet[0]];
      const auto tangent = [&](const int node) {
        std::array<int, 3> t{};
        for (int d = 0; d < element.dim; ++d) t[d] = (lattice[facet[node]][d] - x0[d]) / element.order;
        return t;
      };
      const auto s = tangent(1), t = element.dim == 3 ? tangent(3) : std::array<int, 3>{};
      std::array<int, 3> normal{s[1], -s[0], 0};
      if (element.dim == 3) normal = {s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]};
      int outward = 0; // from the mean of the vertices to the facet, times their number
      for (int a = 0; a < element.num_vertices(); ++a)
        for (int d = 0; d < element.dim; ++d) outward += normal[d] * (x0[d] - lattice[a][d]);
      EXPECT_EQ(outward, element.order * element.num_vertices() / (element.shape == Shape::simplex ? 3 : 2));
      // the facet's lattice, with (1, 0) along s and (0, 1) along t
      const Nodes own =
          element.dim == 3 ? Element{2, element.order}.lattice() : Nodes{{0, 0}, {element.order, 0}, {1, 0}};
      for (std::size_t a = 0; a < facet.size(); ++a)
        for (int d = 0; d < element.dim; ++d)
          EXPECT_EQ(lattice[facet[a]][d], x0[d] + own[a][0] * s[d] + own[a][1] * t[d]);
    }
  }
}

TEST(Element, NamesAreThoseOfTheDeckAndOfExodus)
{
  EXPECT_EQ((Element{2, 1}.name()), "Q1");
  EXPECT_EQ((Element{3, 2}.name()), "Q2");
  EXPECT_EQ((Element{2, 1, Shape::simplex}.name()), "P1");
  EXPECT_EQ((Element{2, 2, Shape::simplex}.name()), "P2");
  const std::vector<std::string> expected = {"QUAD4", "QUAD9", "HEX8", "HEX27", "TRI3", "TRI6"};
  ASSERT_EQ(all_elements().size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(all_elements()[k].exodus_name(), expected[k]);
}

TEST(Element, EqualMeansDimensionOrderAndShape)
{
  for (std::size_t a = 0; a < all_elements().size(); ++a)
    for (std::size_t b = 0; b < all_elements().size(); ++b) EXPECT_EQ(all_elements()[a] == all_elements()[b], a == b);
}

TEST(ParseElement, KnowsTheElementsByTheirNames)
{
  for (const Element &element : all_elements()) {
    if (element.dim == 2 || element.order == 1) {
      EXPECT_TRUE(rpc::mesh::parse_element(element.name(), element.dim) == element) << text_of(element);
    }
  }
}

TEST(ParseElement, RefusesOthersWithTheListOfThoseThatExist)
{
  using rpc::test::expect_error;
  for (const std::string name : {"Q3", "P0", "P3", "p1", "", "T3"})
    expect_error(rpc::ExitCode::bad_input, {"\"Mesh->Element\"", "P1, P2, Q1, Q2", "\"" + name + "\""},
                 [&] { rpc::mesh::parse_element(name, 2); });
  for (const std::string name : {"Q2", "P1", "P2"})
    expect_error(rpc::ExitCode::bad_input, {"\"Mesh->Element\"", "3D", "\"" + name + "\""},
                 [&] { rpc::mesh::parse_element(name, 3); });
}

} // namespace
