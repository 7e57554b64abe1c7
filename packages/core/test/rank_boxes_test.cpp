// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/rank_boxes.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace rank_boxes_test
{
namespace
{

using rpc::Bounds;
using rpc::Point;
using rpc::RankBoxes;

/// Scattered boxes of different sizes, every fifth of them empty.
std::vector<Bounds> scattered(const int count)
{
  std::vector<Bounds> boxes;
  for (int k = 0; k < count; ++k) {
    const Point lower{5 * std::sin(3.1 * k), 5 * std::sin(1.7 * k + 1), 2 * std::sin(0.9 * k)};
    const double size = 1 + std::sin(2.3 * k);
    boxes.push_back({lower, {lower[0] + size, lower[1] + 0.5, lower[2] + 0.2 * size}});
    if (k % 5 == 3) boxes.back() = Bounds::empty();
  }
  return boxes;
}

template <class Walk>
std::vector<int> visited(const Walk &walk)
{
  std::vector<int> ranks;
  walk([&](const int rank) { ranks.push_back(rank); });
  std::sort(ranks.begin(), ranks.end());
  return ranks;
}

TEST(Bounds, HaveANearestAndAFarthestPlace)
{
  const Bounds box{{0, 0, 0}, {2, 1, 0}};
  EXPECT_EQ(box.nearest({1, 0.5, 0}), 0);
  EXPECT_EQ(box.nearest({5, 5, 0}), 9 + 16);
  EXPECT_EQ(box.farthest({5, 5, 0}), 25 + 25);
  EXPECT_TRUE(box.meets_line({5, 0.5, 0}, {-1, 0, 0}));
  EXPECT_TRUE(box.meets_line({3, 2, 0}, {1, 1, 0})); // behind the point
  EXPECT_FALSE(box.meets_line({5, 0.5, 0}, {0, 1, 0}));
  EXPECT_FALSE(box.meets_line({1, 0.5, 1}, {1, 0, 0}));
  EXPECT_TRUE(Bounds::empty().is_empty());
  EXPECT_FALSE(box.is_empty());
}

TEST(RankBoxes, FindWhatALookAtEachFinds)
{
  for (const int count : {1, 2, 3, 40}) {
    const std::vector<Bounds> boxes = scattered(count);
    const RankBoxes tree(boxes);
    for (int k = 0; k < 50; ++k) {
      const Point x{6 * std::sin(1.3 * k), 6 * std::sin(2.9 * k), 3 * std::sin(4.1 * k)};
      const Point direction{std::cos(0.7 * k), std::sin(0.7 * k), 0};
      double least = std::numeric_limits<double>::infinity();
      std::vector<int> near, on_line;
      for (int rank = 0; rank < count; ++rank) {
        if (boxes[rank].is_empty()) continue;
        least = std::min(least, boxes[rank].farthest(x));
        if (boxes[rank].nearest(x) <= 4) near.push_back(rank);
        if (boxes[rank].meets_line(x, direction)) on_line.push_back(rank);
      }
      EXPECT_EQ(tree.least_farthest(x), least);
      EXPECT_EQ(visited([&](const auto &visit) { tree.within(x, 4, visit); }), near);
      EXPECT_EQ(visited([&](const auto &visit) { tree.along(x, direction, visit); }), on_line);
    }
  }
}

TEST(RankBoxes, OfNothingFindNothing)
{
  for (const std::vector<Bounds> &boxes : {std::vector<Bounds>{}, {Bounds::empty(), Bounds::empty()}}) {
    const RankBoxes none(boxes);
    EXPECT_TRUE(std::isinf(none.least_farthest({})));
    none.within({}, std::numeric_limits<double>::infinity(), [](int) { ADD_FAILURE(); });
  }
}

TEST(RankBoxes, AreKnownToAllRanks)
{
  const auto comm = Tpetra::getDefaultComm();
  const double rank = comm->getRank();
  const bool has_none = comm->getRank() == 1;
  const RankBoxes all =
      rpc::rank_boxes(*comm, has_none ? Bounds::empty() : Bounds{{rank, 0, -rank}, {rank + 0.5, 1, 0}});
  ASSERT_EQ(static_cast<int>(all.boxes().size()), comm->getSize());
  for (int r = 0; r < comm->getSize(); ++r) {
    EXPECT_EQ(all.boxes()[r].is_empty(), r == 1);
    if (r == 1) continue;
    EXPECT_EQ(all.boxes()[r].lower, (Point{double(r), 0, -double(r)}));
    EXPECT_EQ(visited([&](const auto &visit) { all.within({r + 0.2, 0.5, 0}, 0, visit); }), std::vector<int>{r});
  }
}

} // namespace
} // namespace rank_boxes_test
