// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/distribute.hpp"

#include "expect_error.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

namespace distribute_test
{
namespace
{

using rpc::GO;
using rpc::LO;
using rpc::mesh::BoxOptions;
using rpc::mesh::distribute;
using rpc::mesh::Element;
using rpc::mesh::make_box;
using rpc::mesh::Mesh;
using rpc::mesh::MeshData;
using rpc::mesh::Shape;
using rpc::mesh::Side;
using rpc::mesh::SideData;

rpc::RCP<const rpc::Comm> world()
{
  return Tpetra::getDefaultComm();
}

/// A box as a whole mesh: its numbers are those that make_box() gives as ids, its left half is a block of its own.
MeshData whole_box(const Element &element, const double left, const int columns, const int rows)
{
  BoxOptions options{{left, -1}, {left + columns, 1}, {columns, rows}, element};
  const int dim = element.dim;
  if (dim == 3) {
    options.lower.push_back(0);
    options.upper.push_back(3);
    options.cells.push_back(2);
  }
  const Mesh box = make_box(options, world()->split(world()->getRank(), 0));
  const auto coords = rpc::to_host(box.coords);
  const auto cells = rpc::to_host(box.cells);
  MeshData whole;
  whole.element = element;
  whole.coords.resize(coords.size());
  whole.cells.resize(cells.size());
  whole.blocks = {"left", "right"};
  whole.block.resize(box.num_cells());
  for (LO n = 0; n < box.num_local_nodes(); ++n)
    for (int d = 0; d < dim; ++d) whole.coords[dim * box.node_id(n) + d] = coords(n, d);
  for (LO c = 0; c < box.num_cells(); ++c) {
    for (int a = 0; a < element.num_nodes(); ++a)
      whole.cells[element.num_nodes() * box.cell_id(c) + a] = static_cast<int>(box.node_id(cells(c, a)));
    whole.block[box.cell_id(c)] = coords(cells(c, 0), 0) < left + columns / 2. ? 0 : 1;
  }
  for (const Side &side : box.sides) {
    SideData data{side.name, {}, {}};
    const auto cell = rpc::to_host(side.cell);
    const auto ordinal = rpc::to_host(side.ordinal);
    for (std::size_t f = 0; f < cell.extent(0); ++f) {
      data.cell.push_back(static_cast<int>(box.cell_id(cell(f))));
      data.ordinal.push_back(ordinal(f));
    }
    whole.sides.push_back(data);
  }
  whole.points = {{"ends", {0, whole.num_nodes() - 1}}, {"second", {1}}};
  return whole;
}

/// Two meshes of the same sides and blocks as one, though they share no node.
MeshData beside(MeshData a, const MeshData &b)
{
  const int num_nodes = a.num_nodes(), num_cells = a.num_cells();
  a.coords.insert(a.coords.end(), b.coords.begin(), b.coords.end());
  a.block.insert(a.block.end(), b.block.begin(), b.block.end());
  for (const int node : b.cells) a.cells.push_back(num_nodes + node);
  for (std::size_t s = 0; s < a.sides.size(); ++s) {
    for (const int cell : b.sides[s].cell) a.sides[s].cell.push_back(num_cells + cell);
    a.sides[s].ordinal.insert(a.sides[s].ordinal.end(), b.sides[s].ordinal.begin(), b.sides[s].ordinal.end());
  }
  return a;
}

/// A distributed mesh next to the whole one, which every rank of a test has.
struct Dealt {
  const MeshData &whole;
  Mesh mesh;
  rpc::HostView<LO **> cells;
  std::vector<int> node_id;              // of each local node
  std::vector<int> cell_id;              // of each local cell, -1 if there is no cell of these nodes
  std::vector<int> cell_owner;           // of each cell of the whole mesh
  std::map<std::vector<int>, int> known; // the whole mesh's cells by their nodes

  explicit Dealt(const MeshData &all)
      : whole(all), mesh(distribute(world()->getRank() == 0 ? all : MeshData{}, world())),
        cells("cells", mesh.cells.extent(0), mesh.cells.extent(1))
  {
    Kokkos::deep_copy(cells, rpc::to_host(mesh.cells));
    rpc::Vector id(mesh.owned_nodes), id_overlap(mesh.overlap_nodes());
    for (LO n = 0; n < mesh.num_owned_nodes(); ++n) id.replaceLocalValue(n, static_cast<double>(mesh.node_id(n)));
    id_overlap.doImport(id, rpc::Import(mesh.owned_nodes, mesh.overlap_nodes()), Tpetra::INSERT);
    const auto ids = id_overlap.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LO n = 0; n < mesh.num_local_nodes(); ++n) node_id.push_back(static_cast<int>(ids(n, 0)));
    for (int c = 0; c < whole.num_cells(); ++c) known[nodes_of(c)] = c;
    for (LO c = 0; c < mesh.num_cells(); ++c) {
      std::vector<int> nodes;
      for (std::size_t a = 0; a < cells.extent(1); ++a) nodes.push_back(node_id[cells(c, a)]);
      const auto found = known.find(nodes);
      cell_id.push_back(found == known.end() ? -1 : found->second);
    }
    std::vector<int> mine(whole.num_cells(), 0);
    for (LO c = 0; c < mesh.num_owned_cells; ++c) mine[mesh.cell_id(c)] = world()->getRank();
    cell_owner.resize(mine.size());
    Teuchos::reduceAll(*world(), Teuchos::REDUCE_SUM, static_cast<int>(mine.size()), mine.data(), cell_owner.data());
  }
  std::vector<int> nodes_of(const int cell) const
  {
    const int width = whole.element.num_nodes();
    return {whole.cells.begin() + width * cell, whole.cells.begin() + width * (cell + 1)};
  }
  std::set<int> owned_nodes() const { return {node_id.begin(), node_id.begin() + mesh.num_owned_nodes()}; }
};

template <class Check>
void for_each_mesh(const Check &check)
{
  for (const Element &element :
       {Element{2, 1}, Element{2, 2}, Element{2, 1, Shape::simplex}, Element{2, 2, Shape::simplex}, Element{3, 1}}) {
    const int ranks = world()->getSize();
    const int cells = element.shape == Shape::simplex ? (ranks + 1) / 2 : ranks; // one for each rank, if even
    const std::vector<std::pair<std::string, MeshData>> meshes = {
        {"tiny", whole_box(element, 0, cells, 1)},
        {"plate", whole_box(element, 0, 5, 3)}, // on 3 ranks, facets whose nodes belong to other ranks than their cell
        {"two parts", beside(whole_box(element, 0, 4, 3), whole_box(element, 10, 3, 5))}};
    for (const auto &[name, whole] : meshes) {
      SCOPED_TRACE(std::to_string(element.dim) + "D " + element.name() + " " + name);
      check(Dealt(whole));
    }
  }
}

/// How often each id in [0, n) occurs over all ranks.
template <class Ids>
std::vector<int> occurrences(const Ids &ids, const int n)
{
  std::vector<int> mine(n, 0), all(n, 0);
  for (std::size_t k = 0; k < ids.size(); ++k) {
    EXPECT_TRUE(0 <= ids[k] && ids[k] < n) << ids[k];
    if (0 <= ids[k] && ids[k] < n) ++mine[ids[k]];
  }
  Teuchos::reduceAll(*world(), Teuchos::REDUCE_SUM, n, mine.data(), all.data());
  return all;
}

TEST(Distribute, EachNodeAndCellIsOwnedOnceAndEachRankOwnsACell)
{
  for_each_mesh([](const Dealt &dealt) {
    const int num_nodes = dealt.whole.num_nodes(), num_cells = dealt.whole.num_cells();
    EXPECT_EQ(occurrences(dealt.mesh.node_id.list(), num_nodes), std::vector<int>(num_nodes, 1));
    EXPECT_EQ(occurrences(dealt.mesh.cell_id.list(), num_cells), std::vector<int>(num_cells, 1));
    EXPECT_EQ(static_cast<LO>(dealt.mesh.node_id.extent(0)), dealt.mesh.num_owned_nodes());
    EXPECT_EQ(static_cast<LO>(dealt.mesh.cell_id.extent(0)), dealt.mesh.num_owned_cells);
    EXPECT_GT(dealt.mesh.num_owned_cells, 0);
  });
}

TEST(Distribute, PointsGoToTheRanksThatOwnTheirNodes)
{
  for_each_mesh([](const Dealt &dealt) {
    ASSERT_EQ(dealt.mesh.points.size(), dealt.whole.points.size());
    for (std::size_t k = 0; k < dealt.whole.points.size(); ++k) {
      EXPECT_EQ(dealt.mesh.points[k].name, dealt.whole.points[k].name);
      std::vector<int> ids;
      for (const LO node : dealt.mesh.points[k].node) {
        ASSERT_LT(node, dealt.mesh.num_owned_nodes());
        ids.push_back(dealt.node_id[node]);
      }
      std::vector<int> expected(dealt.whole.num_nodes(), 0);
      for (const int node : dealt.whole.points[k].node) expected[node] = 1;
      EXPECT_EQ(occurrences(ids, dealt.whole.num_nodes()), expected);
    }
  });
}

TEST(Distribute, CutIsEven)
{
  const MeshData whole = whole_box(Element{2, 1}, 0, 20, 30);
  const Dealt dealt(whole);
  EXPECT_NEAR(dealt.mesh.num_owned_cells, 600. / world()->getSize(), 0.05 * 600);
}

TEST(Distribute, NodeBelongsToTheLowestRankAroundIt)
{
  for_each_mesh([](const Dealt &dealt) {
    std::map<int, int> lowest;
    for (int c = 0; c < dealt.whole.num_cells(); ++c)
      for (const int node : dealt.nodes_of(c)) {
        const auto at = lowest.emplace(node, dealt.cell_owner[c]).first;
        at->second = std::min(at->second, dealt.cell_owner[c]);
      }
    for (LO n = 0; n < dealt.mesh.num_local_nodes(); ++n)
      EXPECT_EQ(n < dealt.mesh.num_owned_nodes(), lowest[dealt.node_id[n]] == world()->getRank());
  });
}

TEST(Distribute, GlobalIndicesAreConsecutiveAndGhostsAscend)
{
  for_each_mesh([](const Dealt &dealt) {
    const auto overlap_nodes = dealt.mesh.overlap_nodes();
    const rpc::Map &owned = *dealt.mesh.owned_nodes, &overlap = *overlap_nodes;
    const LO num_owned = dealt.mesh.num_owned_nodes();
    GO end = 0;
    Teuchos::scan(*world(), Teuchos::REDUCE_SUM, GO(num_owned), Teuchos::outArg(end));
    EXPECT_TRUE(owned.isContiguous());
    for (LO n = 0; n < num_owned; ++n) {
      EXPECT_EQ(owned.getGlobalElement(n), end - num_owned + n);
      EXPECT_EQ(overlap.getGlobalElement(n), end - num_owned + n);
    }
    for (LO n = num_owned; n < dealt.mesh.num_local_nodes(); ++n) {
      EXPECT_FALSE(owned.isNodeGlobalElement(overlap.getGlobalElement(n)));
      if (n > num_owned) {
        EXPECT_LT(overlap.getGlobalElement(n - 1), overlap.getGlobalElement(n));
      }
    }
    if (world()->getSize() == 1) {
      EXPECT_EQ(overlap_nodes, dealt.mesh.owned_nodes);
    }
  });
}

TEST(Distribute, LocalNodesLieWhereTheWholeMeshHasThem)
{
  for_each_mesh([](const Dealt &dealt) {
    const auto coords = rpc::to_host(dealt.mesh.coords);
    ASSERT_EQ(static_cast<LO>(coords.extent(0)), dealt.mesh.num_local_nodes());
    for (LO n = 0; n < dealt.mesh.num_local_nodes(); ++n)
      for (int d = 0; d < dealt.mesh.dim(); ++d)
        EXPECT_EQ(coords(n, d), dealt.whole.coords[dealt.mesh.dim() * dealt.node_id[n] + d]);
  });
}

TEST(Distribute, CellsKeepTheirNodesAndBlocks)
{
  for_each_mesh([](const Dealt &dealt) {
    EXPECT_EQ(dealt.mesh.element, dealt.whole.element);
    EXPECT_EQ(dealt.mesh.blocks, dealt.whole.blocks);
    const auto block = rpc::to_host(dealt.mesh.block);
    ASSERT_EQ(static_cast<LO>(block.extent(0)), dealt.mesh.num_cells());
    for (LO c = 0; c < dealt.mesh.num_cells(); ++c) {
      ASSERT_GE(dealt.cell_id[c], 0);
      EXPECT_EQ(block(c), dealt.whole.block[dealt.cell_id[c]]);
      if (c < dealt.mesh.num_owned_cells) {
        EXPECT_EQ(dealt.cell_id[c], dealt.mesh.cell_id(c));
      }
    }
  });
}

TEST(Distribute, LocalCellsAreTheOwnedOnesAndThoseThatTouchAnOwnedNode)
{
  for_each_mesh([](const Dealt &dealt) {
    const std::set<int> owned = dealt.owned_nodes();
    std::set<int> expected;
    for (int c = 0; c < dealt.whole.num_cells(); ++c) {
      const std::vector<int> nodes = dealt.nodes_of(c);
      if (dealt.cell_owner[c] == world()->getRank() ||
          std::any_of(nodes.begin(), nodes.end(), [&](const int node) { return owned.count(node) > 0; }))
        expected.insert(c);
    }
    EXPECT_EQ(std::set<int>(dealt.cell_id.begin(), dealt.cell_id.end()), expected);
    EXPECT_EQ(dealt.cell_id.size(), expected.size()); // each once
  });
}

TEST(Distribute, LocalNodesAreThoseOfLocalCellsEachOnce)
{
  for_each_mesh([](const Dealt &dealt) {
    std::set<int> expected;
    for (const int cell : dealt.cell_id)
      for (const int node : dealt.nodes_of(cell)) expected.insert(node);
    EXPECT_EQ(std::set<int>(dealt.node_id.begin(), dealt.node_id.end()), expected);
    EXPECT_EQ(dealt.node_id.size(), expected.size());
  });
}

using Facet = std::pair<int, int>; // cell id, ordinal

std::set<Facet> facets_of(const Dealt &dealt, const Side &side)
{
  const auto cell = rpc::to_host(side.cell);
  const auto ordinal = rpc::to_host(side.ordinal);
  std::set<Facet> facets;
  for (std::size_t f = 0; f < cell.extent(0); ++f) facets.emplace(dealt.cell_id[cell(f)], ordinal(f));
  EXPECT_EQ(facets.size(), cell.extent(0)); // each once
  return facets;
}

TEST(Distribute, SidesHoldTheFacetsOfOwnedCellsAndThoseThatTouchAnOwnedNode)
{
  for_each_mesh([](const Dealt &dealt) {
    const std::set<int> owned = dealt.owned_nodes();
    ASSERT_EQ(dealt.mesh.sides.size(), dealt.whole.sides.size());
    for (std::size_t s = 0; s < dealt.whole.sides.size(); ++s) {
      const SideData &whole = dealt.whole.sides[s];
      SCOPED_TRACE(whole.name);
      std::set<Facet> expected;
      for (std::size_t f = 0; f < whole.cell.size(); ++f) {
        bool here = dealt.cell_owner[whole.cell[f]] == world()->getRank();
        for (const int a : dealt.whole.element.facets()[whole.ordinal[f]])
          here = here || owned.count(dealt.nodes_of(whole.cell[f])[a]) > 0;
        if (here) expected.emplace(whole.cell[f], whole.ordinal[f]);
      }
      EXPECT_EQ(dealt.mesh.sides[s].name, whole.name);
      EXPECT_EQ(facets_of(dealt, dealt.mesh.sides[s]), expected);
    }
  });
}

TEST(Distribute, EachFacetOfASideHasAnOwnedCellOnOneRank)
{
  for_each_mesh([](const Dealt &dealt) {
    for (std::size_t s = 0; s < dealt.whole.sides.size(); ++s) {
      SCOPED_TRACE(dealt.whole.sides[s].name);
      std::vector<int> facets; // a cell has at most one facet on a box's side
      for (const auto &[cell, ordinal] : facets_of(dealt, dealt.mesh.sides[s]))
        if (dealt.cell_owner[cell] == world()->getRank()) facets.push_back(cell);
      std::vector<int> expected(dealt.whole.num_cells(), 0);
      for (const int cell : dealt.whole.sides[s].cell) expected[cell] = 1;
      EXPECT_EQ(occurrences(facets, dealt.whole.num_cells()), expected);
    }
  });
}

TEST(Distribute, FacetsHaveTheNodesOfTheirCells)
{
  for_each_mesh([](const Dealt &dealt) {
    for (const Side &side : dealt.mesh.sides) {
      const auto facets = rpc::to_host(side.facets);
      const auto cell = rpc::to_host(side.cell);
      const auto ordinal = rpc::to_host(side.ordinal);
      ASSERT_EQ(static_cast<int>(facets.extent(1)), dealt.mesh.element.num_facet_nodes());
      for (std::size_t f = 0; f < facets.extent(0); ++f)
        for (std::size_t a = 0; a < facets.extent(1); ++a)
          EXPECT_EQ(facets(f, a), dealt.cells(cell(f), dealt.mesh.element.facets()[ordinal(f)][a]));
    }
  });
}

TEST(Distribute, NeighboursLieCloseToEachOther)
{
  const MeshData strip = whole_box(Element{2, 1}, 0, 60, 3); // the ids of a cell's nodes are up to 62 apart
  const Dealt dealt(strip);
  LO widest = 0;
  for (LO c = 0; c < dealt.mesh.num_cells(); ++c)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        if (std::max(dealt.cells(c, a), dealt.cells(c, b)) < dealt.mesh.num_owned_nodes())
          widest = std::max(widest, std::abs(dealt.cells(c, a) - dealt.cells(c, b)));
  EXPECT_LE(widest, 8); // two levels of the 4 nodes across
}

TEST(Distribute, CellsFollowTheirNodes)
{
  for_each_mesh([](const Dealt &dealt) {
    const auto lowest = [&](const LO cell) {
      LO node = dealt.cells(cell, 0);
      for (std::size_t a = 1; a < dealt.cells.extent(1); ++a) node = std::min(node, dealt.cells(cell, a));
      return node;
    };
    for (LO c = 1; c < dealt.mesh.num_cells(); ++c)
      if (c != dealt.mesh.num_owned_cells) {
        EXPECT_LE(lowest(c - 1), lowest(c));
      }
  });
}

TEST(Distribute, FewerCellsThanRanksAreABadMeshOnEveryRank)
{
  const int ranks = world()->getSize();
  if (ranks == 1) GTEST_SKIP() << "one rank can always have the whole mesh";
  const MeshData whole = whole_box(Element{2, 1}, 0, ranks - 1, 1);
  rpc::test::expect_error(
      rpc::ExitCode::bad_mesh,
      {std::to_string(ranks - 1) + " cells cannot be divided among " + std::to_string(ranks), "fewer ranks"},
      [&] { distribute(world()->getRank() == 0 ? whole : MeshData{}, world()); });
}

} // namespace
} // namespace distribute_test
