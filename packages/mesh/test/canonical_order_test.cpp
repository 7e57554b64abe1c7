// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/canonical_order.hpp"

#include "expect_error.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/box.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_Core.hpp>
#include <algorithm>
#include <gtest/gtest.h>
#include <set>

namespace canonical_order_test
{
namespace
{

using rpc::Comm;
using rpc::ExitCode;
using rpc::GO;
using rpc::HostView;
using rpc::LO;
using rpc::RCP;
using rpc::mesh::CanonicalOrder;
using rpc::test::expect_error;

/// Rank r of p owns the ids r, r + p, r + 2p, ... below n, the largest first.
HostView<GO *> scattered_ids(const Comm &comm, const GO n)
{
  std::vector<GO> ids;
  for (GO id = comm.getRank(); id < n; id += comm.getSize()) ids.push_back(id);
  std::reverse(ids.begin(), ids.end());
  HostView<GO *> view("ids", ids.size());
  std::copy(ids.begin(), ids.end(), view.data());
  return view;
}

void expect_ordered(const RCP<const Comm> &comm)
{
  const GO n = 1000;
  const auto ids = scattered_ids(*comm, n);
  const CanonicalOrder order(comm, ids, "node");
  EXPECT_EQ(order.size(), n);
  std::vector<double> doubles;
  std::vector<int> pairs;
  for (std::size_t k = 0; k < ids.extent(0); ++k) {
    doubles.push_back(0.5 * ids(k));
    pairs.insert(pairs.end(), {static_cast<int>(ids(k)), -static_cast<int>(ids(k))});
  }
  const auto all_doubles = order.gather(doubles.data());
  const auto all_pairs = order.gather(pairs.data(), 2);
  const auto all_ids = order.gather(ids.data());
  const std::size_t expected = comm->getRank() == 0 ? n : 0;
  ASSERT_EQ(all_doubles.size(), expected);
  ASSERT_EQ(all_pairs.size(), 2 * expected);
  ASSERT_EQ(all_ids.size(), expected);
  for (std::size_t k = 0; k < expected; ++k) {
    EXPECT_EQ(all_doubles[k], 0.5 * k);
    EXPECT_EQ(all_pairs[2 * k], static_cast<int>(k));
    EXPECT_EQ(all_pairs[2 * k + 1], -static_cast<int>(k));
    EXPECT_EQ(all_ids[k], static_cast<GO>(k));
  }
}

TEST(CanonicalOrder, ValuesComeOrderedById)
{
  expect_ordered(Tpetra::getDefaultComm());
}

TEST(CanonicalOrder, SerialCommunicatorWorksToo)
{
  expect_ordered(Teuchos::rcp(new Teuchos::SerialComm<int>));
}

TEST(CanonicalOrder, PiecesFollowEachOtherAndComeBack)
{
  const auto comm = Tpetra::getDefaultComm();
  const GO n = 600'001; // several pieces
  const auto ids = scattered_ids(*comm, n);
  const CanonicalOrder order(comm, ids, "node");
  std::vector<double> values;
  for (std::size_t k = 0; k < ids.extent(0); ++k) values.push_back(0.5 * ids(k));
  std::vector<double> all;
  std::size_t largest = 0;
  order.in_pieces<double>(values.data(), 1, [&](const GO first, const std::vector<double> &piece) {
    EXPECT_EQ(first, static_cast<GO>(all.size()));
    all.insert(all.end(), piece.begin(), piece.end());
    largest = std::max(largest, piece.size());
  });
  EXPECT_EQ(all.size(), comm->getRank() == 0 ? static_cast<std::size_t>(n) : 0);
  EXPECT_LT(largest, static_cast<std::size_t>(n) / 2); // rank 0 never has all
  for (std::size_t k = 0; k < all.size(); ++k) ASSERT_EQ(all[k], 0.5 * k);
  std::vector<double> back(values.size(), -1);
  order.from_pieces(
      [&](const GO first, const GO count) {
        return std::vector<double>(all.begin() + first, all.begin() + first + count);
      },
      back.data());
  EXPECT_EQ(back, values);
}

TEST(CanonicalOrder, AnErrorInAPieceIsThrownOnEveryRank)
{
  const auto comm = Tpetra::getDefaultComm();
  const auto ids = scattered_ids(*comm, 600'001);
  const CanonicalOrder order(comm, ids, "node");
  expect_error(ExitCode::bad_input, "disk full", [&] {
    order.in_pieces<GO>(ids.data(), 1, [](const GO first, const std::vector<GO> &) {
      if (first > 0) throw rpc::Error(ExitCode::bad_input, "disk full");
    });
  });
}

TEST(CanonicalOrder, IdsThatAreNoPermutationAreRefusedOnEveryRank)
{
  const auto comm = Tpetra::getDefaultComm();
  const auto twice = scattered_ids(*comm, 10), beyond = scattered_ids(*comm, 10);
  if (comm->getRank() == 0) {
    twice(0) = twice(1);
    beyond(0) = 10;
  }
  expect_error(ExitCode::internal_error, "node ids must be each of 0 .. 9 once",
               [&] { CanonicalOrder(comm, twice, "node"); });
  expect_error(ExitCode::internal_error, "got 10", [&] { CanonicalOrder(comm, beyond, "node"); });
}

/// 5 x 3 cells on (0,5) x (0,3): a node's id is x + 6 y for Q1.
rpc::mesh::Mesh box(const RCP<const Comm> &comm)
{
  return rpc::mesh::make_box({{0, 0}, {5, 3}, {5, 3}, rpc::mesh::Element{2, 1}}, comm);
}

TEST(OverlapNodeIds, AreKnownOfGhostsToo)
{
  const auto comm = Tpetra::getDefaultComm();
  const auto mesh = box(comm);
  const auto ids = rpc::mesh::overlap_node_ids(mesh);
  const auto coords = rpc::to_host(mesh.coords);
  ASSERT_EQ(static_cast<LO>(ids.extent(0)), mesh.num_local_nodes());
  for (LO n = 0; n < mesh.num_local_nodes(); ++n) EXPECT_NEAR(ids(n), coords(n, 0) + 6 * coords(n, 1), 1e-12);
}

TEST(OwnedFacets, EachFacetOfASideAppearsOnceOverAllRanks)
{
  const auto comm = Tpetra::getDefaultComm();
  const auto mesh = box(comm);
  const auto facets = rpc::mesh::owned_facets(mesh, mesh.side("bottom", "test"), rpc::mesh::overlap_node_ids(mesh));
  const auto all = rpc::gathered_by_root(*comm, facets.data(), facets.extent(0) * facets.extent(1));
  if (comm->getRank() != 0) return;
  ASSERT_EQ(all.size(), 10u);
  std::set<std::pair<GO, GO>> edges;
  for (std::size_t f = 0; f < all.size(); f += 2) edges.insert(std::minmax(all[f], all[f + 1]));
  EXPECT_EQ(edges, (std::set<std::pair<GO, GO>>{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}));
}

} // namespace
} // namespace canonical_order_test
