// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace coarsened_box_test
{
namespace
{

using rpc::mesh::BoxOptions;
using rpc::mesh::Element;
using rpc::mesh::make_box;
using rpc::mesh::Shape;

TEST(CoarsenedBox, HasHalfTheCellsAndItsNodesAreAmongTheFinerOnes)
{
  const auto coarse = rpc::mesh::coarsened({{0, 0, 0}, {6, 4, 2}, {15, 10, 5}, Element{3, 1, Shape::simplex}});
  ASSERT_TRUE(coarse);
  EXPECT_EQ(coarse->cells, (std::vector<int>{7, 5, 2}));
  EXPECT_EQ(coarse->last, (std::vector<double>{1.5, 1, 1.5}));
  EXPECT_TRUE(coarse->element == (Element{3, 1, Shape::simplex}));
  EXPECT_EQ(coarse->upper, (std::vector<double>{6, 4, 2}));
}

TEST(CoarsenedBox, StretchIsOfNodeDistances)
{
  EXPECT_EQ(rpc::mesh::stretch({{0, 0}, {4, 4}, {4, 4}, Element{2, 1}}), 1);
  EXPECT_EQ(rpc::mesh::stretch({{0, 0}, {4, 12}, {4, 4}, Element{2, 2}}), 3);
  EXPECT_EQ(rpc::mesh::stretch({{0, 0, 0}, {4, 2, 1}, {4, 4, 4}, Element{3, 1, Shape::simplex}}), 4);
}

TEST(CoarsenedBox, StretchedCellsBecomeSquareFirst)
{
  BoxOptions box{{0, 0}, {8, 1}, {8, 64}, Element{2, 1}}; // cells of 1 x 1/64
  for (const int across : {32, 16, 8, 4}) {
    box = *rpc::mesh::coarsened(box);
    EXPECT_EQ(box.cells, (std::vector<int>{8, across}));
  }
  box.cells = {8, 1};
  box = *rpc::mesh::coarsened(box);
  EXPECT_EQ(box.cells, (std::vector<int>{4, 1})) << "a direction of one cell stays";
}

/// Each coordinate of a coarse node is one of the finer box, level after level.
TEST(CoarsenedBox, MakesNestedMeshesOfAnyNumbersOfCells)
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
    while (const auto coarse = rpc::mesh::coarsened(box)) {
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

TEST(CoarsenedBox, OrderTwoBecomesOrderOneOnTheSameCells)
{
  for (const Element &element : rpc::mesh::all_elements()) {
    if (element.order == 1) continue;
    BoxOptions box{{0, 0}, {6, 4}, {15, 13}, element};
    if (element.dim == 3) box = {{0, 0, 0}, {6, 4, 2}, {15, 13, 5}, element};
    const auto coarse = rpc::mesh::coarsened(box);
    ASSERT_TRUE(coarse);
    EXPECT_EQ(coarse->cells, box.cells);
    EXPECT_TRUE(coarse->element == (Element{element.dim, 1, element.shape}));
  }
}

/// Where nodes are closest, first the order, then the cells: until node distances are alike.
TEST(CoarsenedBox, ShortestDistanceBetweenNodesGoesFirst)
{
  BoxOptions box{{0, 0, 0}, {8, 8, 1}, {8, 4, 8}, Element{3, 2}}; // nodes 1/2, 1, 1/16 apart
  const auto becomes = [&box](const std::vector<int> &cells, const std::string &name) {
    box = *rpc::mesh::coarsened(box);
    EXPECT_EQ(box.cells, cells) << name;
    EXPECT_EQ(box.element.name(), name);
  };
  becomes({8, 4, 8}, "Q221");
  becomes({8, 4, 4}, "Q221");
  becomes({8, 4, 2}, "Q221");
  becomes({8, 4, 1}, "Q121");
  EXPECT_EQ(rpc::mesh::thin_direction(box), 2);
  becomes({4, 4, 1}, "Q1"); // wrong for a body so thin, hence thin_direction()
}

/// Cells nearly as long as the body is thick: it goes down to one cell there before the others become longer.
TEST(CoarsenedBox, BecomesThinAcrossFirst)
{
  const auto coarse = rpc::mesh::coarsened({{0, 0, 0}, {6, 6, 0.6}, {6, 6, 1}, Element{3, 2}});
  ASSERT_TRUE(coarse);
  EXPECT_EQ(coarse->element.name(), "Q221");
  EXPECT_EQ(coarse->cells, (std::vector<int>{6, 6, 1}));
  EXPECT_EQ(rpc::mesh::thin_direction(*coarse), 2);
  EXPECT_EQ(rpc::mesh::coarsened({{0, 0}, {6, 2}, {6, 2}, Element{2, 1}})->cells, (std::vector<int>{3, 1}));
}

/// P2 has no mixed elements: Q2 with the same nodes takes its place.
TEST(CoarsenedBox, StretchedQuadraticSimplicesBecomeMixed)
{
  const auto coarse = rpc::mesh::coarsened({{0, 0}, {8, 1}, {8, 8}, Element{2, 2, Shape::simplex}});
  ASSERT_TRUE(coarse);
  EXPECT_EQ(coarse->element.name(), "Q21");
  EXPECT_EQ(coarse->cells, (std::vector<int>{8, 8}));
}

TEST(CoarsenedBox, IsThinWhereOneCellIsLessThickThanTheOthersAreLong)
{
  const auto thin = [](const double thickness, const int cells, const Element &element) {
    return rpc::mesh::thin_direction({{0, 0, 0}, {8, thickness, 16}, {8, cells, 8}, element});
  };
  EXPECT_EQ(thin(1.6, 1, {3, 1}), 1);
  EXPECT_EQ(thin(1.6, 1, {3, 1, Shape::simplex}), 1);
  EXPECT_FALSE(thin(1.8, 1, {3, 1})) << "as thick as cells are long";
  EXPECT_FALSE(thin(0.1, 2, {3, 1})) << "two cells";
  EXPECT_FALSE(thin(0.1, 1, {3, 2})) << "of order 2";
  EXPECT_EQ(thin(0.8, 1, (Element{3, 2}).with_order_one_along({false, true, false})), 1);
  EXPECT_FALSE(thin(0.9, 1, (Element{3, 2}).with_order_one_along({false, true, false})))
      << "nodes are half as far apart";
}

TEST(CoarsenedBox, IsNoneOfOneCell)
{
  EXPECT_FALSE(rpc::mesh::coarsened({{0, 0}, {1, 2}, {1, 1}, Element{2, 1}}));
}

} // namespace
} // namespace coarsened_box_test
