#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace
{

using rpc::mesh::BoxOptions;
using rpc::mesh::Element;
using rpc::mesh::make_box;
using rpc::mesh::Shape;

TEST(HalvedBox, HasHalfTheCellsAndItsNodesAreAmongTheFinerOnes)
{
  const auto coarse = rpc::mesh::halved({{0, 0, 0}, {6, 4, 2}, {15, 10, 5}, Element{3, 2, Shape::simplex}});
  ASSERT_TRUE(coarse);
  EXPECT_EQ(coarse->cells, (std::vector<int>{7, 5, 2}));
  EXPECT_EQ(coarse->last, (std::vector<double>{1.5, 1, 1.5}));
  EXPECT_TRUE(coarse->element == (Element{3, 1, Shape::simplex}));
  EXPECT_EQ(coarse->upper, (std::vector<double>{6, 4, 2}));
}

TEST(HalvedBox, StretchedCellsBecomeSquareFirst)
{
  BoxOptions box{{0, 0}, {8, 1}, {8, 64}, Element{2, 1}}; // cells of 1 x 1/64
  for (const int across : {32, 16, 8, 4}) {
    box = *rpc::mesh::halved(box);
    EXPECT_EQ(box.cells, (std::vector<int>{8, across}));
  }
  box.cells = {8, 1};
  box = *rpc::mesh::halved(box);
  EXPECT_EQ(box.cells, (std::vector<int>{4, 1})) << "a direction of one cell stays";
}

/// Each coordinate of a coarse node is one of the finer box, level after level.
TEST(HalvedBox, MakesNestedMeshesOfAnyNumbersOfCells)
{
  const int ranks = Tpetra::getDefaultComm()->getSize();
  for (const int cells : {2, 3, 5, 7, 11, 23, 63, 65}) {
    if (cells < ranks) continue;
    BoxOptions box{{-1, 2}, {1, 4}, {cells, cells}, Element{2, 1}};
    const auto places = [](const BoxOptions &options) {
      const auto coords = rpc::to_host(make_box(options, Tpetra::getDefaultComm()).coords);
      std::vector<double> found;
      for (std::size_t n = 0; n < coords.extent(0); ++n) found.push_back(coords(n, 0));
      return found;
    };
    auto finer = places(box);
    while (const auto coarse = rpc::mesh::halved(box)) {
      EXPECT_LE(coarse->last[0], 2) << cells;
      EXPECT_GE(coarse->last[0], 1) << cells;
      if (coarse->cells[0] < ranks) break;
      const auto coarser = places(*coarse);
      if (ranks == 1) {
        for (const double x : coarser)
          EXPECT_TRUE(std::any_of(finer.begin(), finer.end(), [x](const double y) { return std::abs(x - y) < 1e-14; }))
              << cells << ": " << x;
      }
      box = *coarse;
      finer = coarser;
    }
  }
}

TEST(HalvedBox, IsNoneOfOneCell)
{
  EXPECT_FALSE(rpc::mesh::halved({{0, 0}, {1, 2}, {1, 1}, Element{2, 1}}));
}

} // namespace
