// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/box.hpp"

#include "box_lattice.hpp"
#include "expect_error.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

namespace box_test
{
namespace
{

using namespace rpc::test;
using rpc::ExitCode;
using rpc::GO;
using rpc::LO;
using rpc::mesh::BoxOptions;
using rpc::mesh::Element;
using rpc::mesh::make_box;

/// How often each id in [0, n) occurs over all ranks.
template <class Ids>
std::vector<int> occurrences(const Ids &ids, const GO n)
{
  std::vector<int> mine(n, 0), all(n, 0);
  for (std::size_t k = 0; k < ids.extent(0); ++k) {
    EXPECT_TRUE(0 <= ids(k) && ids(k) < n) << ids(k);
    if (0 <= ids(k) && ids(k) < n) ++mine[ids(k)];
  }
  Teuchos::reduceAll(*Tpetra::getDefaultComm(), Teuchos::REDUCE_SUM, static_cast<int>(n), mine.data(), all.data());
  return all;
}

TEST(Box, EachNodeAndCellIdOccursOnceOverAllRanks)
{
  for_each_box([](const Made &made) {
    EXPECT_EQ(made.mesh.owned_nodes->getGlobalNumElements(), std::size_t(made.lattice.num_nodes()));
    EXPECT_EQ(occurrences(made.mesh.node_id.list(), made.lattice.num_nodes()),
              std::vector<int>(made.lattice.num_nodes(), 1));
    EXPECT_EQ(occurrences(made.mesh.cell_id.list(), made.lattice.num_cells()),
              std::vector<int>(made.lattice.num_cells(), 1));
    EXPECT_EQ(static_cast<LO>(made.mesh.node_id.extent(0)), made.mesh.num_owned_nodes());
    EXPECT_EQ(static_cast<LO>(made.mesh.cell_id.extent(0)), made.mesh.num_owned_cells);
  });
}

TEST(Box, NodesAndCellsLieWhereTheirIdsSay)
{
  for_each_box([](const Made &made) {
    for (LO n = 0; n < made.mesh.num_owned_nodes(); ++n) {
      EXPECT_EQ(made.mesh.node_id(n), made.node_id(n));
      const Position at = made.lattice.position(made.mesh.node_id(n), made.lattice.order, 1);
      for (int d = 0; d < made.mesh.dim(); ++d)
        EXPECT_NEAR(made.coords(n, d), made.lattice.coordinate(at[d], d), 4e-16 * 8); // 8 > any coordinate
    }
    for (LO c = 0; c < made.mesh.num_owned_cells; ++c)
      EXPECT_EQ(made.mesh.cell_id(c), made.lattice.cell_id(made.cell[c]));
  });
}

TEST(Box, EndsOfTheBoxAreMetExactly)
{
  const BoxOptions box{{0.1, -0.7}, {0.3, 1. / 3}, {7, 4}, Element{2, 1}};
  const Made made(box);
  for (LO n = 0; n < made.mesh.num_local_nodes(); ++n) {
    for (int d = 0; d < 2; ++d) {
      const GO at = made.node[n][d];
      if (at == 0 || at == box.cells[d]) {
        EXPECT_EQ(made.coords(n, d), at == 0 ? box.lower[d] : box.upper[d]);
      }
    }
  }
}

TEST(Box, GlobalIndicesAreConsecutiveAndOwnedNodesComeFirstInTheOverlap)
{
  for_each_box([](const Made &made) {
    const rpc::Comm &comm = made.mesh.comm();
    const LO num_owned = made.mesh.num_owned_nodes();
    GO end = 0;
    Teuchos::scan(comm, Teuchos::REDUCE_SUM, GO(num_owned), Teuchos::outArg(end));
    ASSERT_LE(num_owned, made.mesh.num_local_nodes());
    for (LO n = 0; n < num_owned; ++n) {
      EXPECT_EQ(made.mesh.owned_nodes->getGlobalElement(n), end - num_owned + n);
      EXPECT_EQ(made.mesh.node_gid(n), end - num_owned + n);
    }
    for (LO n = num_owned; n < made.mesh.num_local_nodes(); ++n)
      EXPECT_FALSE(made.mesh.owned_nodes->isNodeGlobalElement(made.mesh.node_gid(n)));
  });
}

TEST(Box, GhostNodesLieWhereTheirOwnersHaveThem)
{
  for_each_box([](const Made &made) {
    rpc::Vector id(made.mesh.owned_nodes), id_overlap(made.mesh.overlap_nodes());
    for (LO n = 0; n < made.mesh.num_owned_nodes(); ++n)
      id.replaceLocalValue(n, static_cast<double>(made.mesh.node_id(n)));
    id_overlap.doImport(id, rpc::Import(made.mesh.owned_nodes, made.mesh.overlap_nodes()), Tpetra::INSERT);
    const auto ids = id_overlap.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LO n = 0; n < made.mesh.num_local_nodes(); ++n) EXPECT_EQ(ids(n, 0), made.node_id(n)) << "node " << n;
  });
}

TEST(Box, LocalCellsAreThoseThatTouchAnOwnedNodeAndNoOthers)
{
  for_each_box([](const Made &made) {
    std::set<GO> owned, touching, local;
    for (LO n = 0; n < made.mesh.num_owned_nodes(); ++n) owned.insert(made.node_id(n));
    for (GO c = 0; c < made.lattice.num_cells(); ++c)
      for (const GO node : made.lattice.nodes_of(made.lattice.cell(c)))
        if (owned.count(node) > 0) touching.insert(c);
    const int parts = made.lattice.parts;
    std::set<GO> expected; // the parts of one cell of the lattice go together
    for (const GO c : touching)
      for (int part = 0; part < parts; ++part) expected.insert(c - c % parts + part);
    for (const Cell &cell : made.cell) local.insert(made.lattice.cell_id(cell));
    EXPECT_EQ(local, expected);
    EXPECT_EQ(local.size(), made.cell.size()); // each once
  });
}

/// Area or volume, from the vertices: those of a parallelogram, a parallelepiped, or half and a sixth of these.
double measure_of(const Made &made, const LO cell)
{
  const int dim = made.mesh.dim();
  const bool simplex = made.lattice.simplex;
  const auto edge = [&](const int vertex, const int d) {
    return made.coords(made.cells(cell, vertex), d) - made.coords(made.cells(cell, 0), d);
  };
  const std::array<int, 3> ends = simplex ? std::array<int, 3>{1, 2, 3} : std::array<int, 3>{1, 3, 4};
  if (dim == 2) {
    const double area = edge(ends[0], 0) * edge(ends[1], 1) - edge(ends[0], 1) * edge(ends[1], 0);
    return simplex ? area / 2 : area;
  }
  double volume = 0;
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    volume += edge(ends[0], d) * (edge(ends[1], e) * edge(ends[2], f) - edge(ends[1], f) * edge(ends[2], e));
  }
  return simplex ? volume / 6 : volume;
}

TEST(Box, CellsHaveEqualPositiveMeasuresThatSumToTheBox)
{
  for_each_box([](const Made &made) {
    double mine = 0, whole = 1;
    for (int d = 0; d < made.mesh.dim(); ++d) whole *= made.box.upper[d] - made.box.lower[d];
    for (LO c = 0; c < made.mesh.num_cells(); ++c) {
      const double measure = measure_of(made, c);
      EXPECT_NEAR(measure, whole / static_cast<double>(made.lattice.num_cells()), 1e-13 * whole) << "cell " << c;
      if (c < made.mesh.num_owned_cells) mine += measure;
    }
    EXPECT_NEAR(rpc::sum_all(made.mesh.comm(), mine), whole, 1e-13 * whole);
  });
}

TEST(Box, GoesToFewerRanksWhereItHasFewNodes)
{
  const auto comm = Tpetra::getDefaultComm();
  const int ranks = comm->getSize();
  const BoxOptions box{{0, 0}, {2, 1}, {9, 4}, Element{2, 1}}; // 50 nodes
  EXPECT_EQ(rpc::mesh::divided(box, ranks, 1).blocks, ranks);
  EXPECT_EQ(rpc::mesh::divided(box, ranks, 25).blocks, std::min(ranks, 2));
  EXPECT_EQ(rpc::mesh::divided(box, ranks, 26).blocks, 1);
  EXPECT_EQ(rpc::mesh::divided(box, ranks, 1000).blocks, 1);
  EXPECT_EQ(rpc::mesh::divided(box, 11, 1).blocks, 10); // no direction has 11 cells
  const auto mesh = make_box(rpc::mesh::divided(box, ranks, 1000), comm);
  EXPECT_EQ(mesh.num_owned_nodes(), comm->getRank() == 0 ? 50 : 0);
  EXPECT_EQ(mesh.num_local_nodes(), mesh.num_owned_nodes());
  EXPECT_EQ(mesh.num_cells(), comm->getRank() == 0 ? 36 : 0);
  auto too_many = box;
  too_many.blocks = ranks + 1;
  expect_error(ExitCode::internal_error, {"blocks"}, [&] { make_box(too_many, comm); });
}

TEST(Box, TetrahedraOfACellShareItsDiagonalAndNothingElse)
{
  // Each point of the cell lies in the tetrahedron of the order of its coordinates.
  for (int part = 0; part < 6; ++part) {
    std::vector<int> order{0, 1, 2};
    for (int k = 0; k < part; ++k) std::next_permutation(order.begin(), order.end());
    for (const Position &vertex : Lattice::tetrahedron(part))
      EXPECT_TRUE(vertex[order[0]] >= vertex[order[1]] && vertex[order[1]] >= vertex[order[2]]) << part;
  }
}

TEST(Box, IsOneBlock)
{
  for_each_box([](const Made &made) {
    EXPECT_EQ(made.mesh.blocks, std::vector<std::string>{"body"});
    const auto block = rpc::to_host(made.mesh.block);
    ASSERT_EQ(static_cast<LO>(block.extent(0)), made.mesh.num_cells());
    for (LO c = 0; c < made.mesh.num_cells(); ++c) EXPECT_EQ(block(c), 0);
  });
}

TEST(Box, CellNodesFollowTheElementsLattice)
{
  for_each_box([](const Made &made) {
    for (LO c = 0; c < made.mesh.num_cells(); ++c)
      for (int a = 0; a < made.mesh.element.num_nodes(); ++a)
        EXPECT_EQ(made.node[made.cells(c, a)], made.lattice.node_of(made.cell[c], a));
  });
}

TEST(Box, LocalNodesAreThoseOfLocalCellsEachOnce)
{
  for_each_box([](const Made &made) {
    std::set<GO> of_cells, local;
    for (const Cell &cell : made.cell) of_cells.merge(made.lattice.nodes_of(cell));
    for (LO n = 0; n < made.mesh.num_local_nodes(); ++n) local.insert(made.node_id(n));
    EXPECT_EQ(local, of_cells);
    EXPECT_EQ(static_cast<LO>(local.size()), made.mesh.num_local_nodes());
  });
}

TEST(Box, BlocksShareAsFewFacesAsPossible)
{
  const auto comm = Tpetra::getDefaultComm();
  if (comm->getSize() == 1) GTEST_SKIP() << "one rank shares nothing";
  for (const bool tall : {false, true}) {
    const Made made({{0, 0}, {1, 1}, {tall ? 4 : 40, tall ? 40 : 4}, Element{2, 1}});
    const GO ghosts = rpc::sum_all(*comm, GO(made.mesh.num_local_nodes() - made.mesh.num_owned_nodes()));
    EXPECT_EQ(ghosts,
              2 * 5 * (comm->getSize() - 1)); // cut across the short direction: 5 nodes wide, seen from both sides
  }
}

TEST(Box, MoreRanksThanTheCellsCanServeIsABadMeshOnEveryRank)
{
  const auto comm = Tpetra::getDefaultComm();
  if (comm->getSize() == 1) GTEST_SKIP() << "one rank can always have the whole box";
  const std::string ranks = std::to_string(comm->getSize()) + " ranks";
  expect_error(ExitCode::bad_mesh, {"1 x 1 cells", ranks.c_str(), "fewer ranks"}, [&] {
    make_box({{0, 0}, {1, 1}, {1, 1}, Element{2, 1}}, comm);
  });
  expect_error(ExitCode::bad_mesh, {"1 x 1 x 1 cells"}, [&] {
    make_box({{0, 0, 0}, {1, 1, 1}, {1, 1, 1}, Element{3, 1}}, comm);
  });
}

TEST(Box, TheMeshKnowsIt)
{
  const Made made({{1, 2}, {4, 3}, {8, 4}, Element{2, 1}});
  ASSERT_TRUE(made.mesh.box);
  EXPECT_EQ(made.mesh.box->cells, (std::vector<int>{8, 4}));
}

TEST(Diameter, IsTheDiagonalWhereverTheBoxLies)
{
  for (const double shift : {0., 100., -100.}) {
    const Made flat({{shift, shift}, {shift + 4, shift + 3}, {8, 4}, Element{2, 1}});
    EXPECT_NEAR(rpc::mesh::diameter(flat.mesh), 5, 1e-13);
    const Made solid({{shift, shift, shift}, {shift + 2, shift + 3, shift + 6}, {2, 2, 4}, Element{3, 1}});
    EXPECT_NEAR(rpc::mesh::diameter(solid.mesh), 7, 1e-13);
  }
}

} // namespace
} // namespace box_test
