// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/topology.hpp"

#include "block_mesh.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace topology_test
{
namespace
{

using namespace rpc;
using mesh::all_elements;
using mesh::edges_of;
using mesh::Element;
using mesh::Entities;
using mesh::facets_of;
using mesh::Shape;
using test::block;

RCP<const Comm> world()
{
  return Tpetra::getDefaultComm();
}

/// Nodes that are vertices of cells.
int num_vertices(const mesh::MeshData &data)
{
  std::set<int> vertices;
  const int width = data.element.num_nodes();
  for (std::size_t k = 0; k < data.cells.size(); ++k)
    if (static_cast<int>(k % width) < data.element.num_vertices()) vertices.insert(data.cells[k]);
  return static_cast<int>(vertices.size());
}

class Blocks : public testing::TestWithParam<Element>
{
protected:
  mesh::MeshData data = block(GetParam(), {3, 2, 2});
  Entities facets = facets_of(data.element, data.cells), edges = edges_of(data.element, data.cells);
};

TEST_P(Blocks, ObeyEulersFormula)
{
  const int faces = GetParam().dim == 3 ? facets.size() : data.num_cells(),
            cells = GetParam().dim == 3 ? data.num_cells() : 0;
  EXPECT_EQ(num_vertices(data) - edges.size() + faces - cells, 1);
}

TEST_P(Blocks, HaveFacetsOfTwoCellsInsideAndOfOneOnTheBoundary)
{
  const Element element = GetParam();
  const bool simplex = element.shape == Shape::simplex;
  int boundary = 0;
  for (int f = 0; f < facets.size(); ++f) {
    ASSERT_TRUE(facets.num_cells_at(f) == 1 || facets.num_cells_at(f) == 2);
    bool at_end = false; // all its vertices on one side of the block
    for (int d = 0; d < element.dim; ++d)
      for (const double end : {0., d == 0 ? 3. : 2.}) {
        const auto first = facets.vertices.begin() + facets.num_vertices * f;
        at_end = at_end || std::all_of(first, first + facets.num_vertices,
                                       [&](const int n) { return data.coords[element.dim * n + d] == end; });
      }
    EXPECT_EQ(facets.num_cells_at(f) == 1, at_end);
    boundary += at_end ? 1 : 0;
  }
  const int squares = 2 * (3 * 2 + 3 * 2 + 2 * 2);
  EXPECT_EQ(boundary, element.dim == 2 ? 2 * (3 + 2) : squares * (simplex ? 2 : 1));
}

TEST_P(Blocks, NumberFacetsAndEdgesByTheirVertices)
{
  for (const auto &[entities, table] :
       {std::pair(&facets, &data.element.facets()), std::pair(&edges, &data.element.edges())}) {
    const int width = data.element.num_nodes();
    std::vector<std::vector<int>> lists;
    for (int e = 0; e < entities->size(); ++e) {
      const auto first = entities->vertices.begin() + entities->num_vertices * e;
      lists.emplace_back(first, first + entities->num_vertices);
      EXPECT_TRUE(std::is_sorted(lists.back().begin(), lists.back().end()));
      std::vector<int> reversed(lists.back().rbegin(), lists.back().rend());
      EXPECT_EQ(entities->find(reversed), e);
      ASSERT_GT(entities->num_cells_at(e), 0);
      for (int k = 0; k < entities->num_cells_at(e); ++k) {
        const int cell = entities->cell(e, k), ordinal = entities->ordinal(e, k);
        EXPECT_EQ(entities->of_cell[entities->per_cell * cell + ordinal], e);
        std::set<int> nodes;
        for (int v = 0; v < entities->num_vertices; ++v) nodes.insert(data.cells[width * cell + (*table)[ordinal][v]]);
        EXPECT_EQ(nodes, std::set<int>(lists.back().begin(), lists.back().end()));
        EXPECT_TRUE(k == 0 || cell > entities->cell(e, k - 1));
      }
    }
    EXPECT_TRUE(std::is_sorted(lists.begin(), lists.end()));
    EXPECT_EQ(std::set(lists.begin(), lists.end()).size(), lists.size());
    EXPECT_EQ(entities->of_cell.size(), std::size_t(entities->per_cell) * data.num_cells());
    EXPECT_FALSE(entities->find(std::vector<int>(entities->num_vertices, -1)));
    EXPECT_FALSE(entities->find(std::vector<int>(entities->num_vertices, data.num_nodes())));
  }
}

/// Whether one list is the other one turned around in a circle, starting anywhere.
bool runs_against(const std::vector<int> &a, const std::vector<int> &b)
{
  const std::size_t n = a.size();
  for (std::size_t start = 0; start < n; ++start) {
    bool same = true;
    for (std::size_t k = 0; k < n; ++k) same = same && a[k] == b[(start + n - k) % n];
    if (same) return true;
  }
  return false;
}

TEST_P(Blocks, HaveNeighboursThatSeeTheirFacetFromOppositeSidesWithTheSameNodes)
{
  const Element element = GetParam();
  const int width = element.num_nodes();
  int compared = 0;
  for (int f = 0; f < facets.size(); ++f) {
    if (facets.num_cells_at(f) == 1) continue;
    std::vector<int> vertices[2];
    std::set<int> nodes[2];
    for (int k = 0; k < 2; ++k) {
      const auto &local = element.facets()[facets.ordinal(f, k)];
      for (std::size_t a = 0; a < local.size(); ++a) {
        const int node = data.cells[width * facets.cell(f, k) + local[a]];
        nodes[k].insert(node);
        if (static_cast<int>(a) < facets.num_vertices) vertices[k].push_back(node);
      }
    }
    EXPECT_TRUE(runs_against(vertices[0], vertices[1]));
    EXPECT_EQ(nodes[0], nodes[1]);
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

TEST_P(Blocks, ListTheCellsOfEachNode)
{
  const Lists lists = mesh::node_to_cells(data.element, data.cells, data.num_nodes());
  ASSERT_EQ(lists.size(), data.num_nodes());
  const int width = data.element.num_nodes();
  std::size_t entries = 0;
  for (int n = 0; n < data.num_nodes(); ++n) {
    EXPECT_TRUE(std::is_sorted(lists.first(n), lists.last(n)));
    entries += lists.size_of(n);
    for (const int *cell = lists.first(n); cell != lists.last(n); ++cell) {
      const auto first = data.cells.begin() + width * *cell;
      EXPECT_NE(std::find(first, first + width, n), first + width);
    }
  }
  EXPECT_EQ(entries, data.cells.size());
}

INSTANTIATE_TEST_SUITE_P(Elements, Blocks, testing::ValuesIn(all_elements()), [](const auto &info) {
  return info.param.name() + "in" + std::to_string(info.param.dim) + "D";
});

TEST(Entities, OfOneCellAreItsOwn)
{
  for (const Element &element : all_elements()) {
    std::vector<int> cells(element.num_nodes());
    std::iota(cells.begin(), cells.end(), 0);
    const Entities facets = facets_of(element, cells), edges = edges_of(element, cells);
    EXPECT_EQ(facets.size(), element.num_facets());
    EXPECT_EQ(edges.size(), static_cast<int>(element.edges().size()));
    for (int f = 0; f < facets.size(); ++f) EXPECT_EQ(facets.num_cells_at(f), 1);
  }
}

TEST(Entities, OfNoCellsAreNone)
{
  for (const Element &element : all_elements()) {
    EXPECT_EQ(facets_of(element, {}).size(), 0);
    EXPECT_FALSE(edges_of(element, {}).find({0, 1}));
  }
}

TEST(Entities, OfTwoTetrahedraShareOneFace)
{
  const Entities facets = facets_of({3, 1, Shape::simplex}, {0, 1, 2, 3, 1, 2, 3, 4});
  EXPECT_EQ(facets.size(), 7);
  const auto shared = facets.find({3, 1, 2});
  ASSERT_TRUE(shared);
  ASSERT_EQ(facets.num_cells_at(*shared), 2);
  EXPECT_EQ(facets.cell(*shared, 0), 0);
  EXPECT_EQ(facets.ordinal(*shared, 0), 1); // nodes 1, 2, 3 of the first one
  EXPECT_EQ(facets.cell(*shared, 1), 1);
  EXPECT_EQ(facets.ordinal(*shared, 1), 3); // its nodes 0, 2, 1
  EXPECT_FALSE(facets.find({0, 1, 4}));
}

/// Boxes of the elements that there are boxes of, distributed.
std::vector<mesh::BoxOptions> boxes()
{
  return {{{0, 0}, {4, 3}, {5, 4}, {2, 1}},
          {{0, 0}, {4, 3}, {4, 3}, {2, 2}},
          {{0, 0}, {4, 3}, {4, 5}, {2, 1, Shape::simplex}},
          {{0, 0}, {4, 3}, {3, 4}, {2, 2, Shape::simplex}},
          {{0, 0, 0}, {4, 3, 2}, {4, 3, 3}, {3, 1}}};
}

TEST(Topology, OwnsEachFacetAndEdgeOnceWithAllCellsAroundIt)
{
  for (const mesh::BoxOptions &box : boxes()) {
    SCOPED_TRACE(box.element.name() + " in " + std::to_string(box.element.dim) + "D");
    const mesh::Mesh whole = mesh::make_box(box, world()->split(world()->getRank(), 0)),
                     part = mesh::make_box(box, world());
    const mesh::Topology expected = mesh::topology(whole), topology = mesh::topology(part);
    const auto count = [](const std::vector<char> &owns) {
      return static_cast<GO>(std::accumulate(owns.begin(), owns.end(), 0));
    };
    EXPECT_EQ(count(expected.owns_facet), expected.facets.size());
    EXPECT_EQ(sum_all(*world(), count(topology.owns_facet)), expected.facets.size());
    EXPECT_EQ(sum_all(*world(), count(topology.owns_edge)), expected.edges.size());
    GO cells_at_facets = 0, cells_at_edges = 0, boundary = 0, expected_boundary = 0;
    for (int f = 0; f < topology.facets.size(); ++f) {
      if (!topology.owns_facet[f]) continue;
      cells_at_facets += topology.facets.num_cells_at(f);
      boundary += topology.on_boundary(f) ? 1 : 0;
    }
    for (int e = 0; e < topology.edges.size(); ++e)
      if (topology.owns_edge[e]) cells_at_edges += topology.edges.num_cells_at(e);
    for (int f = 0; f < expected.facets.size(); ++f) expected_boundary += expected.on_boundary(f) ? 1 : 0;
    EXPECT_EQ(sum_all(*world(), cells_at_facets), GO(expected.facets.of_cell.size()));
    EXPECT_EQ(sum_all(*world(), cells_at_edges), GO(expected.edges.of_cell.size()));
    EXPECT_EQ(sum_all(*world(), boundary), expected_boundary);
  }
}

TEST(Topology, HasTheFacetsOfTheSides)
{
  for (const mesh::BoxOptions &box : boxes()) {
    const mesh::Mesh mesh = mesh::make_box(box, world());
    const mesh::Topology topology = mesh::topology(mesh);
    int on_sides = 0, on_boundary = 0;
    for (const mesh::Side &side : mesh.sides) {
      const auto nodes = to_host(side.facets);
      for (std::size_t f = 0; f < nodes.extent(0); ++f) {
        std::vector<int> vertices;
        for (int v = 0; v < topology.facets.num_vertices; ++v) vertices.push_back(nodes(f, v));
        const auto facet = topology.facets.find(vertices);
        ASSERT_TRUE(facet);
        EXPECT_EQ(topology.facets.num_cells_at(*facet), 1);
        on_sides += topology.owns_facet[*facet];
      }
    }
    for (int f = 0; f < topology.facets.size(); ++f) on_boundary += topology.owns_facet[f] && topology.on_boundary(f);
    EXPECT_EQ(on_sides, on_boundary);
  }
}

} // namespace
} // namespace topology_test
