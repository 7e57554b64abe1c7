// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/exchange.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

namespace exchange_test
{
namespace
{

/// Rank r sends r + to rows to each rank `to`, none to the last one: (from, to, number).
TEST(Exchange, RowsArriveInOrderAndAnswersReturnToThem)
{
  const auto comm = Tpetra::getDefaultComm();
  const int rank = comm->getRank(), ranks = comm->getSize();
  std::vector<int> counts(ranks);
  std::vector<double> rows;
  for (int to = 0; to < ranks; ++to) {
    counts[to] = to + 1 == ranks && ranks > 1 ? 0 : rank + to;
    for (int n = 0; n < counts[to]; ++n) rows.insert(rows.end(), {double(rank), double(to), double(n)});
  }
  const rpc::Exchange exchange(*comm, counts);
  EXPECT_EQ(3 * exchange.num_sent(), static_cast<int>(rows.size()));
  const auto got = exchange.forward(rows, 3);
  ASSERT_EQ(static_cast<int>(got.size()), 3 * exchange.num_received());
  std::vector<std::pair<int, int>> senders;
  for (int from = 0; from < ranks; ++from)
    if (const int count = rank + 1 == ranks && ranks > 1 ? 0 : from + rank; count > 0)
      senders.emplace_back(from, count);
  EXPECT_EQ(exchange.senders(), senders);
  std::size_t at = 0;
  for (int from = 0; from < ranks; ++from)
    for (int n = 0; n < (rank + 1 == ranks && ranks > 1 ? 0 : from + rank); ++n, at += 3) {
      EXPECT_EQ(got[at], from);
      EXPECT_EQ(got[at + 1], rank);
      EXPECT_EQ(got[at + 2], n);
    }
  EXPECT_EQ(at, got.size());
  std::vector<double> answers;
  for (std::size_t n = 0; n < got.size(); n += 3) answers.push_back(100 * got[n] + 10 * got[n + 1] + got[n + 2]);
  const auto returned = exchange.back(answers, 1);
  ASSERT_EQ(3 * returned.size(), rows.size());
  for (std::size_t n = 0; n < returned.size(); ++n)
    EXPECT_EQ(returned[n], 100 * rows[3 * n] + 10 * rows[3 * n + 1] + rows[3 * n + 2]);
}

TEST(Exchange, OfNothingIsNothing)
{
  const auto comm = Tpetra::getDefaultComm();
  const rpc::Exchange exchange(*comm, std::vector<int>(comm->getSize(), 0));
  EXPECT_TRUE(exchange.forward({}, 2).empty());
  EXPECT_TRUE(exchange.back({}, 5).empty());
}

} // namespace
} // namespace exchange_test
