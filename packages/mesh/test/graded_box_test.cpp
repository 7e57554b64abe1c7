// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/box.hpp"
#include "rpc/mesh/make_mesh.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

/// Boxes whose cells grow, or shrink, in geometric progression.
namespace graded_box_test
{
namespace
{

using rpc::mesh::BoxOptions;
using rpc::mesh::cell_ends;
using rpc::mesh::coarsened;
using rpc::mesh::Element;
using rpc::mesh::Shape;

BoxOptions layer(const int cells, const double ratio, const Element &element = {3, 1})
{
  BoxOptions box{{0, 0, -1}, {1, 1, 2}, {16, 16, cells}, element};
  box.expansion = {1, 1, ratio};
  rpc::mesh::grade(box);
  return box;
}

std::vector<double> lengths(const BoxOptions &box, const int direction)
{
  const auto ends = cell_ends(box, direction);
  std::vector<double> length;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) length.push_back(ends[k + 1] - ends[k]);
  return length;
}

TEST(GradedBox, LengthsAreInGeometricProgression)
{
  for (const double ratio : {8., 0.1, 1.0001}) {
    const auto box = layer(20, ratio);
    const auto length = lengths(box, 2);
    ASSERT_EQ(length.size(), 20U);
    EXPECT_NEAR(length.back() / length.front(), ratio, 1e-10 * ratio);
    for (std::size_t k = 1; k + 1 < length.size(); ++k)
      EXPECT_NEAR(length[k] * length[k], length[k - 1] * length[k + 1], 1e-12);
    EXPECT_EQ(box.ends[2].front(), -1);
    EXPECT_EQ(box.ends[2].back(), 2);
    EXPECT_TRUE(box.ends[0].empty());
  }
  EXPECT_TRUE(layer(20, 1).ends[2].empty()) << "equal cells keep their formula";
}

TEST(GradedBox, NodesLieWhereCellsEndAndInTheirMiddles)
{
  for (const Element &element : rpc::mesh::all_elements()) {
    if (element.dim == 2) continue;
    BoxOptions box = layer(9, 5, element);
    box.cells[0] = box.cells[1] = 4;
    const auto coords = rpc::to_host(make_box(box, Tpetra::getDefaultComm()).coords);
    std::vector<double> places = cell_ends(box, 2);
    for (std::size_t k = 0; element.order == 2 && k < 9; ++k) places.push_back(0.5 * (places[k] + places[k + 1]));
    for (std::size_t n = 0; n < coords.extent(0); ++n)
      EXPECT_TRUE(
          std::any_of(places.begin(), places.end(), [&](const double z) { return std::abs(z - coords(n, 2)) < 1e-14; }))
          << element.name() << ": " << coords(n, 2);
  }
}

/// Cells longer than 1.7 times the shortest ones stay, so that stretched cells become square ones first.
TEST(GradedBox, CoarserOnesJoinShortCellsInPairs)
{
  for (const double ratio : {16., 1 / 16., 1.2}) {
    auto box = layer(33, ratio);
    while (const auto coarse = coarsened(box)) {
      const double longest_short = 1.7 * std::min(box.node_distance(0), box.node_distance(2)) + 1e-12;
      const auto fine = cell_ends(box, 2), kept = cell_ends(*coarse, 2);
      EXPECT_TRUE(std::includes(fine.begin(), fine.end(), kept.begin(), kept.end()));
      ASSERT_EQ(coarse->cells[2] + 1, static_cast<int>(kept.size()));
      for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
        const auto first = std::find(fine.begin(), fine.end(), kept[k]),
                   last = std::find(first, fine.end(), kept[k + 1]);
        EXPECT_LE(last - first, 3);
        for (auto end = first; last - first > 1 && end != last; ++end) EXPECT_LE(end[1] - end[0], longest_short);
      }
      EXPECT_TRUE(coarse->cells[0] < box.cells[0] || coarse->cells[2] < box.cells[2]);
      if (box.cells[0] == 1) break;
      box = *coarse;
    }
    EXPECT_LE(box.cells[0] * box.cells[1] * box.cells[2], 8) << ratio;
  }
}

TEST(GradedBox, OrderTwoBecomesOrderOneOnTheSameCells)
{
  const auto box = layer(8, 1.5, {3, 2});
  const auto coarse = coarsened(coarsened(box).value());
  ASSERT_TRUE(coarse);
  EXPECT_EQ(coarsened(box)->ends[2], box.ends[2]);
}

TEST(GradedBox, FewerCellsAreGradedAnew)
{
  const rpc::mesh::MeshOptions options = layer(16, 4);
  const auto coarse = std::get<BoxOptions>(*rpc::mesh::coarser(options, 2));
  EXPECT_EQ(coarse.cells[2], 8);
  const auto length = lengths(coarse, 2);
  ASSERT_EQ(length.size(), 8U);
  EXPECT_NEAR(length.back() / length.front(), 4, 1e-12);
}

TEST(GradedBox, DistancesAreThoseOfTheShortestAndTheLongestCells)
{
  const auto box = layer(3, 4); // 3/7, 6/7, 12/7
  EXPECT_NEAR(box.cell_length(2), 12. / 7, 1e-14);
  EXPECT_NEAR(box.node_distance(2), 6. / 7, 1e-14);
  EXPECT_NEAR(rpc::mesh::stretch(box), 12. / 7 * 16, 1e-12);
}

} // namespace
} // namespace graded_box_test
