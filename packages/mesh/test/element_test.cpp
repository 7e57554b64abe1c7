// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/element.hpp"

#include "expect_error.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>

namespace element_test
{
namespace
{

using rpc::mesh::all_elements;
using rpc::mesh::Element;
using rpc::mesh::Shape;
using Nodes = std::vector<std::vector<int>>;

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
  const Element hexahedron{3, 2};
  const auto &hex = hexahedron.lattice();
  EXPECT_EQ(Nodes(hex.begin(), hex.begin() + 8),
            (Nodes{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}}));
  for (std::size_t a = 0; a < around.size(); ++a)
    for (int d = 0; d < 3; ++d)
      EXPECT_EQ(2 * hex[8 + a][d], hex[around[a][0]][d] + hex[around[a][1]][d]) << "node " << 8 + a;
  const Element quadrilateral{2, 2};
  const auto &quad = quadrilateral.lattice();
  for (int a = 0; a < 4; ++a)
    for (int d = 0; d < 2; ++d) EXPECT_EQ(2 * quad[4 + a][d], quad[a][d] + quad[(a + 1) % 4][d]) << "node " << 4 + a;
  EXPECT_EQ(quad[8], (std::vector<int>{1, 1}));
}

TEST(Element, NodesOfTrianglesAreNumberedAsInExodus)
{
  EXPECT_EQ((Element{2, 1, Shape::simplex}.lattice()), (Nodes{{0, 0}, {1, 0}, {0, 1}}));
  const Element simplex{2, 2, Shape::simplex};
  const auto &triangle = simplex.lattice();
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
        EXPECT_EQ(is_vertex(element, facet[a]), a < element.facet().num_vertices());
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
      const bool triangle = element.facet().shape == Shape::simplex;
      const auto s = tangent(1), t = element.dim == 3 ? tangent(triangle ? 2 : 3) : std::array<int, 3>{};
      std::array<int, 3> normal{s[1], -s[0], 0};
      if (element.dim == 3) normal = {s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2], s[0] * t[1] - s[1] * t[0]};
      int outward = 0; // from the mean of the vertices to the facet, times their number
      for (int a = 0; a < element.num_vertices(); ++a)
        for (int d = 0; d < element.dim; ++d) outward += normal[d] * (x0[d] - lattice[a][d]);
      EXPECT_EQ(outward,
                element.order * element.num_vertices() / (element.shape == Shape::simplex ? element.dim + 1 : 2));
      const Element side = element.facet();
      const Nodes &own = side.lattice(); // with (1, 0) along s and (0, 1) along t
      for (std::size_t a = 0; a < facet.size(); ++a)
        for (int d = 0; d < element.dim; ++d)
          EXPECT_EQ(lattice[facet[a]][d], x0[d] + own[a][0] * s[d] + (element.dim == 3 ? own[a][1] * t[d] : 0));
    }
  }
}

TEST(Element, EveryEdgeOfAFacetIsAnEdgeAndFacetsAreWhatTheyAreSaidToBe)
{
  for (const Element &element : all_elements()) {
    SCOPED_TRACE(text_of(element));
    std::map<std::set<int>, int> facets_at; // nodes of an edge
    const Element side = element.facet();
    for (const auto &facet : element.facets())
      for (const auto &edge : side.edges()) {
        std::set<int> nodes;
        for (const int a : edge) nodes.insert(facet[a]);
        ++facets_at[nodes];
      }
    EXPECT_EQ(facets_at.size(), element.edges().size());
    for (const auto &edge : element.edges()) {
      ASSERT_EQ(static_cast<int>(edge.size()), element.edge().num_nodes());
      EXPECT_EQ(facets_at[std::set(edge.begin(), edge.end())], element.dim - 1); // a surface of facets without a gap
      for (int d = 0; d < element.dim && element.order == 2; ++d)
        EXPECT_EQ(2 * element.lattice()[edge[2]][d], element.lattice()[edge[0]][d] + element.lattice()[edge[1]][d]);
    }
    // vertices - edges + facets: 0 for a polygon's boundary, whose edges are its facets, 2 for a polyhedron's
    const int edges = static_cast<int>(element.edges().size());
    EXPECT_EQ(element.num_vertices() - edges + (element.dim == 3 ? element.num_facets() : 0), element.dim == 3 ? 2 : 0);
  }
}

TEST(Element, FacesOfP1TetrahedraAreTrianglesAndEdgesOfP2TrianglesAreNot)
{
  const Element face = Element{3, 1, Shape::simplex}.facet(), edge = Element{2, 2, Shape::simplex}.facet();
  EXPECT_EQ(face.num_nodes(), edge.num_nodes());
  EXPECT_TRUE((face == Element{2, 1, Shape::simplex}));
  EXPECT_TRUE((edge == Element{1, 2}));
  EXPECT_FALSE(face == edge);
}

TEST(Element, NodesOfTetrahedraAreNumberedAsInExodus)
{
  // TETRA10 has its further nodes in the middle of these edges, and its sides have these vertices.
  const Nodes edges = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  const Element element{3, 2, Shape::simplex};
  EXPECT_EQ((Element{3, 1, Shape::simplex}.edges()), edges);
  for (int e = 0; e < 6; ++e) EXPECT_EQ(element.edges()[e], (std::vector<int>{edges[e][0], edges[e][1], 4 + e}));
  EXPECT_EQ((Element{3, 1, Shape::simplex}.facets()), (Nodes{{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}}));
  EXPECT_EQ(element.facets(), (Nodes{{0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 2, 1, 6, 5, 4}}));
}

TEST(Element, NodesFindTheirPlacesInGmshsOrder)
{
  // Where gmsh has its nodes: vertices, then the vertices around the middle of an edge, face or cell.
  const Nodes triangle = {{0}, {1}, {2}, {0, 1}, {1, 2}, {2, 0}};
  const Nodes quadrilateral = {{0}, {1}, {2}, {3}, {0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}};
  const Nodes tetrahedron = {{0}, {1}, {2}, {3}, {0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
  const Nodes hexahedron = {{0},    {1},    {2},    {3},    {4},    {5},    {6},    {7},    {0, 1},
                            {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7},
                            {5, 6}, {6, 7}, {0, 2}, {0, 5}, {0, 7}, {1, 6}, {2, 7}, {4, 6}, {0, 6}};
  const auto gmsh_nodes = [&](const Element &element) {
    const bool simplex = element.shape == Shape::simplex;
    return element.dim == 2 ? (simplex ? triangle : quadrilateral) : (simplex ? tetrahedron : hexahedron);
  };
  for (const Element &element : all_elements()) {
    SCOPED_TRACE(text_of(element));
    const auto &place = element.gmsh_place();
    ASSERT_EQ(static_cast<int>(place.size()), element.num_nodes());
    EXPECT_EQ(std::set<int>(place.begin(), place.end()).size(), place.size());
    for (int a = 0; a < element.num_nodes(); ++a) {
      const std::vector<int> around = gmsh_nodes(element)[place[a]];
      for (int d = 0; d < element.dim; ++d) {
        int sum = 0;
        for (const int vertex : around) sum += element.lattice()[vertex][d];
        EXPECT_EQ(static_cast<int>(around.size()) * element.lattice()[a][d], sum) << "node " << a;
      }
    }
  }
}

TEST(Element, TypesOfGmshAreThoseOfItsManual)
{
  const std::vector<int> expected = {2, 9, 3, 10, 4, 11, 5, 12};
  ASSERT_EQ(all_elements().size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const auto element = rpc::mesh::element_of_gmsh_type(expected[k]);
    ASSERT_TRUE(element);
    EXPECT_TRUE(*element == all_elements()[k]);
    EXPECT_EQ(element->gmsh_type(), expected[k]);
    EXPECT_EQ(element->facet().gmsh_type(), element->dim == 3 ? expected[k - 4] : element->order == 1 ? 1 : 8);
  }
  for (const int other : {-1, 0, 1, 6, 8, 15, 16, 99}) EXPECT_FALSE(rpc::mesh::element_of_gmsh_type(other)) << other;
}

TEST(Element, NamesAreThoseOfTheDeckAndOfExodus)
{
  EXPECT_EQ((Element{2, 1}.name()), "Q1");
  EXPECT_EQ((Element{3, 2}.name()), "Q2");
  EXPECT_EQ((Element{2, 1, Shape::simplex}.name()), "P1");
  EXPECT_EQ((Element{2, 2, Shape::simplex}.name()), "P2");
  const std::vector<std::string> expected = {"TRI3", "TRI6", "QUAD4", "QUAD9", "TETRA4", "TETRA10", "HEX8", "HEX27"};
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
  for (const Element &element : all_elements())
    EXPECT_TRUE(rpc::mesh::parse_element(element.name(), element.dim) == element) << text_of(element);
}

TEST(ParseElement, RefusesOthersWithTheListOfThoseThatExist)
{
  using rpc::test::expect_error;
  for (const std::string name : {"Q3", "P0", "P3", "p1", "", "T3"})
    for (const int dim : {2, 3})
      expect_error(rpc::ExitCode::bad_input, {"\"Mesh->Element\"", "P1, P2, Q1, Q2", "\"" + name + "\""},
                   [&] { rpc::mesh::parse_element(name, dim); });
}

} // namespace
} // namespace element_test
