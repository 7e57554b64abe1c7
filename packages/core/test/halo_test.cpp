// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/halo.hpp"

#include "rpc/core/dofs.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

namespace halo_test
{
namespace
{

using namespace rpc;

const GO invalid = Teuchos::OrdinalTraits<GO>::invalid();

/// Nodes on a ring; each rank's columns are its own nodes and, `reach` nodes deep, those before and after them.
struct Ring {
  static constexpr int width = 3;
  GO num_nodes;
  RCP<const Map> nodes, columns;
  RCP<const Import> importer;

  /// @param shuffled  the columns in another order than the owned nodes
  Ring(const GO nodes_of_rank, const GO reach, const bool shuffled)
  {
    const auto comm = Tpetra::getDefaultComm();
    num_nodes = nodes_of_rank * comm->getSize();
    nodes = rcp(new Map(num_nodes, nodes_of_rank, 0, comm));
    std::vector<GO> gids;
    const GO first = nodes->getMinGlobalIndex();
    for (GO n = 0; n < nodes_of_rank; ++n) gids.push_back(first + n);
    if (comm->getSize() > 1)
      for (GO n = 1; n <= reach; ++n) {
        gids.push_back((first - n + num_nodes) % num_nodes);
        const GO after = (first + nodes_of_rank - 1 + n) % num_nodes;
        if (after != gids.back()) gids.push_back(after);
      }
    if (shuffled) std::swap(gids.front(), gids[nodes_of_rank - 1]);
    columns = rcp(new Map(invalid, Teuchos::ArrayView<const GO>(gids), 0, comm));
    importer = rcp(new Import(nodes, columns));
  }
  Vector unknowns(const Map &of) const
  {
    std::vector<GO> gids;
    for (LO n = 0; n < num_local(of); ++n)
      for (int k = 0; k < width; ++k) gids.push_back(dof(width, of.getGlobalElement(n), k));
    return Vector(rcp(new Map(invalid, Teuchos::ArrayView<const GO>(gids), 0, of.getComm())));
  }
};

double wave(const GO unknown)
{
  return std::sin(1 + 0.3 * static_cast<double>(unknown));
}

Vector wave_at(const Ring &ring)
{
  Vector x = ring.unknowns(*ring.nodes);
  for (LO i = 0; i < num_local(*x.getMap()); ++i) x.replaceLocalValue(i, wave(x.getMap()->getGlobalElement(i)));
  return x;
}

class HaloOfRing : public testing::TestWithParam<bool>
{
};

TEST_P(HaloOfRing, HasWhatEveryColumnsOwnerHolds)
{
  const Ring ring(5, 2, GetParam());
  const Vector x = wave_at(ring);
  const Halo halo(ring.importer, Ring::width);
  ASSERT_EQ(halo.is_empty(), ring.nodes->getComm()->getSize() == 1 && !GetParam());
  for (int time = 0; time < 3; ++time) { // buffers are used again
    const auto found = halo.at_columns(x).getLocalViewHost(Tpetra::Access::ReadOnly);
    ASSERT_EQ(static_cast<LO>(found.extent(0)), Ring::width * num_local(*ring.columns));
    Kokkos::fence();
    for (LO n = 0; n < num_local(*ring.columns); ++n)
      for (int k = 0; k < Ring::width; ++k)
        EXPECT_EQ(found(dof(Ring::width, n, k), 0), wave(dof<GO>(Ring::width, ring.columns->getGlobalElement(n), k)));
  }
}

/// Each node is a column of its owner, and of two neighbours if it is near their ends.
TEST_P(HaloOfRing, SumsAtTheOwners)
{
  const Ring ring(5, 2, GetParam());
  const int ranks = ring.nodes->getComm()->getSize();
  const Halo halo(ring.importer, Ring::width);
  for (int time = 0; time < 3 && !halo.is_empty(); ++time) {
    Vector y = ring.unknowns(*ring.nodes);
    y.putScalar(99); // does not count
    halo.columns().putScalar(1 + ring.nodes->getComm()->getRank());
    halo.sum_at_owners(y);
    Kokkos::fence();
    const auto found = y.getLocalViewHost(Tpetra::Access::ReadOnly);
    const int rank = ring.nodes->getComm()->getRank(), before = (rank + ranks - 1) % ranks, after = (rank + 1) % ranks;
    for (LO n = 0; n < 5; ++n) {
      double sum = rank + 1;
      if (ranks > 1 && n < 2) sum += before + 1;
      if (ranks > 1 && n >= 3) sum += after + 1;
      for (int k = 0; k < Ring::width; ++k) EXPECT_EQ(found(dof(Ring::width, n, k), 0), sum) << n;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Columns, HaloOfRing, testing::Bool());

TEST(Halo, OfOneRanksNodesIsTheVectorItself)
{
  const Ring ring(4, 1, false);
  const Halo halo;
  EXPECT_TRUE(halo.is_empty());
  EXPECT_EQ(halo.num_messages(), 0);
  const Vector x = wave_at(ring);
  EXPECT_EQ(&halo.at_columns(x), &x);
}

/// By the ghosts' gids as by an Import of them, whatever their order; unknowns as nodes.
TEST(Halo, OfGhostsIsThatOfTheirImport)
{
  const Ring ring(5, 2, false);
  std::vector<GO> ghosts;
  for (LO n = 5; n < num_local(*ring.columns); ++n) ghosts.push_back(ring.columns->getGlobalElement(n));
  const Halo nodes(ring.nodes, ghosts), unknowns(nodes, Ring::width), by_import(ring.importer, Ring::width);
  const int ranks = ring.nodes->getComm()->getSize();
  ASSERT_EQ(nodes.is_empty(), ranks == 1);
  if (ranks == 1) return;
  EXPECT_EQ(nodes.num_messages(), by_import.num_messages());
  EXPECT_EQ(Ring::width * nodes.num_sent(), by_import.num_sent());
  const Vector x = wave_at(ring);
  const auto found = unknowns.at_columns(x).getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto expected = by_import.at_columns(x).getLocalViewHost(Tpetra::Access::ReadOnly);
  ASSERT_EQ(found.extent(0), expected.extent(0));
  for (std::size_t i = 0; i < found.extent(0); ++i) EXPECT_EQ(found(i, 0), expected(i, 0)) << i;
}

/// All nodes on the first rank, from which others have columns: as on the coarse meshes of few unknowns.
TEST(Halo, ReachesRanksWithoutNodesOfTheirOwn)
{
  const auto comm = Tpetra::getDefaultComm();
  const bool first = comm->getRank() == 0;
  const GO num_nodes = 6;
  const auto nodes = rcp(new Map(num_nodes, first ? num_nodes : 0, 0, comm));
  std::vector<GO> gids;
  for (GO n = first ? 0 : 2; n < num_nodes; ++n) gids.push_back(n);
  const auto columns = rcp(new Map(invalid, Teuchos::ArrayView<const GO>(gids), 0, comm));
  const Halo halo(rcp(new Import(nodes, columns)));
  ASSERT_EQ(halo.is_empty(), comm->getSize() == 1);
  if (halo.is_empty()) return;
  EXPECT_EQ(halo.num_messages(), first ? comm->getSize() - 1 : 0);
  EXPECT_EQ(halo.num_sent(), first ? 4U * (comm->getSize() - 1) : 0U);
  Vector x(nodes), y(nodes);
  for (LO n = 0; n < num_local(*nodes); ++n) x.replaceLocalValue(n, 10. + n);
  {
    const auto found = halo.at_columns(x).getLocalViewHost(Tpetra::Access::ReadOnly);
    Kokkos::fence();
    for (std::size_t c = 0; c < gids.size(); ++c) EXPECT_EQ(found(c, 0), 10. + static_cast<double>(gids[c]));
  }
  halo.columns().putScalar(1);
  halo.sum_at_owners(y);
  Kokkos::fence();
  const auto sum = y.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO n = 0; n < num_local(*nodes); ++n) EXPECT_EQ(sum(n, 0), n < 2 ? 1 : comm->getSize());
}

} // namespace
} // namespace halo_test
