// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/parallel.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

namespace parallel_test
{
namespace
{

TEST(GatheredByAll, HoldsEachRanksPartInOrderHoweverLong)
{
  const auto comm = Tpetra::getDefaultComm();
  const int rank = comm->getRank();
  const std::vector<double> mine(3 * rank, rank + 0.5); // none on rank 0
  const auto all = rpc::gathered_by_all(*comm, mine);
  std::size_t at = 0;
  for (int from = 0; from < comm->getSize(); ++from)
    for (int k = 0; k < 3 * from; ++k) {
      ASSERT_LT(at, all.size());
      EXPECT_EQ(all[at++], from + 0.5);
    }
  EXPECT_EQ(at, all.size());
}

TEST(GatheredByAll, OfNothingIsNothing)
{
  EXPECT_TRUE(rpc::gathered_by_all(*Tpetra::getDefaultComm(), std::vector<int>{}).empty());
}

TEST(SumBefore, IsThatOfLowerRanks)
{
  const auto comm = Tpetra::getDefaultComm();
  const rpc::GO rank = comm->getRank();
  EXPECT_EQ(rpc::sum_before(*comm, rank + 1), rank * (rank + 1) / 2);
}

TEST(GatheredByRoot, RankZeroGetsValuesInTheOrderOfTheRanks)
{
  const auto comm = Tpetra::getDefaultComm();
  const std::vector<int> mine(comm->getRank() + 1, comm->getRank());
  const auto all = rpc::gathered_by_root(*comm, mine);
  std::vector<int> expected;
  for (int rank = 0; comm->getRank() == 0 && rank < comm->getSize(); ++rank)
    expected.insert(expected.end(), rank + 1, rank);
  EXPECT_EQ(all, expected);
}

TEST(GatheredByRoot, RanksMayHaveNothing)
{
  const auto comm = Tpetra::getDefaultComm();
  const std::vector<rpc::GO> mine(comm->getRank() == comm->getSize() - 1 ? 2 : 0, 7);
  EXPECT_EQ(rpc::gathered_by_root(*comm, mine), std::vector<rpc::GO>(comm->getRank() == 0 ? 2 : 0, 7));
}

TEST(InPieces, TheyFollowEachOtherToTheEnd)
{
  const std::size_t total = (std::size_t(5) << 26) + 3;
  std::size_t next = 0;
  rpc::in_pieces(total, [&](const std::size_t first, const int count) {
    EXPECT_EQ(first, next);
    EXPECT_GT(count, 0);
    next += count;
  });
  EXPECT_EQ(next, total);
  rpc::in_pieces(0, [](std::size_t, int) { FAIL(); });
}

TEST(OverRanks, VectorsAreAddedAndComparedEntryByEntry)
{
  const auto comm = Tpetra::getDefaultComm();
  const int rank = comm->getRank(), ranks = comm->getSize();
  EXPECT_EQ(rpc::summed(*comm, std::vector<int>{rank, 1}), (std::vector<int>{ranks * (ranks - 1) / 2, ranks}));
  EXPECT_EQ(rpc::largest(*comm, std::vector<double>{-1. * rank, 1. * rank}), (std::vector<double>{0, ranks - 1.}));
}

} // namespace
} // namespace parallel_test
