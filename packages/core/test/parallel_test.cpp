#include "rpc/core/parallel.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

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

} // namespace
