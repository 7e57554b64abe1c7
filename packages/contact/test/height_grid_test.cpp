// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/height_grid.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace height_grid_test
{
namespace
{

using namespace rpc;
using contact::HeightGrid;
using contact::HeightTable;
using contact::Interpolation;

using Function = std::function<double(double, double)>;

/// Heights of a function on columns x rows places, the first one at 0.
HeightTable table_of(const Function &h, const int columns, const int rows, const double dx, const double dy)
{
  HeightTable table{columns, rows, {}, {dx, dy}};
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) table.height.push_back(h(i * dx, j * dy));
  return table;
}

double wavy(const double x, const double y)
{
  return 0.1 * std::sin(2 * x + 0.3) * std::cos(3 * y) + 0.05 * x * y;
}

/// Rough on the scale of the grid, periodic with 1 along x and 0.6 along y.
HeightGrid rough(const Interpolation interpolation, const bool periodic)
{
  std::mt19937 random(7);
  const auto noise = [&](double, double) { return 0.04 * (double(random()) / double(std::mt19937::max()) - 0.5); };
  return HeightGrid(table_of(noise, 10, 6, 0.1, 0.1), interpolation, periodic);
}

TEST(HeightGrid, BicubicMeetsParabolasUpToTheEdgesAndTheirSlopes)
{
  const auto h = [](const double x, const double y) { return 1 + x - 2 * y + 0.5 * x * x - x * y + 0.7 * y * y; };
  const HeightGrid grid(table_of(h, 5, 4, 0.25, 0.5), Interpolation::bicubic, false);
  for (const double x : {0., 0.1, 0.6, 0.93, 1.})
    for (const double y : {0., 0.2, 0.8, 1.5}) {
      const auto at = grid.at(x, y);
      EXPECT_NEAR(at.height, h(x, y), 1e-14);
      EXPECT_NEAR(at.slope[0], 1 + x - y, 1e-13);
      EXPECT_NEAR(at.slope[1], -2 - x + 1.4 * y, 1e-13);
    }
}

TEST(HeightGrid, ErrorsFallWithTheThirdPowerOfTheSpacingAndOfBilinearOnesWithTheSecond)
{
  for (const auto &[interpolation, least] : {std::pair{Interpolation::bicubic, 7.}, {Interpolation::bilinear, 3.7}}) {
    double before = 0;
    for (const int n : {16, 32, 64}) {
      const HeightGrid grid(table_of(wavy, n + 1, n + 1, 1. / n, 1. / n), interpolation, false);
      double most = 0;
      for (int k = 0; k < 1000; ++k) {
        const double x = std::fmod(0.618034 * k, 1), y = std::fmod(0.754878 * k, 1);
        most = std::max(most, std::abs(grid.at(x, y).height - wavy(x, y)));
      }
      if (before > 0) {
        EXPECT_GT(before / most, least) << n;
      }
      before = most;
    }
  }
}

TEST(HeightGrid, SlopesOfBicubicOnesAreContinuousAndAreTheDerivatives)
{
  const HeightGrid grid = rough(Interpolation::bicubic, true);
  constexpr double d = 1e-6;
  for (int k = 0; k < 200; ++k) {
    const double x = 0.0125 * k, y = 0.05 * (k % 13); // many of them at edges of cells
    for (int c = 0; c < 2; ++c) {
      const double dx = c == 0 ? d : 0, dy = c == 1 ? d : 0;
      EXPECT_NEAR(grid.at(x, y).slope[c], (grid.at(x + dx, y + dy).height - grid.at(x - dx, y - dy).height) / (2 * d),
                  2e-5);
      EXPECT_NEAR(grid.at(x - dx, y - dy).slope[c], grid.at(x + dx, y + dy).slope[c], 1e-4);
    }
  }
}

TEST(HeightGrid, PeriodicOnesRepeatAndOthersEnd)
{
  const HeightGrid endless = rough(Interpolation::bicubic, true), ends = rough(Interpolation::bicubic, false);
  EXPECT_NEAR(endless.extent()[0], 1, 1e-15);
  EXPECT_NEAR(endless.extent()[1], 0.6, 1e-15);
  EXPECT_NEAR(ends.extent()[0], 0.9, 1e-15);
  for (const double x : {-0.03, 0.41, 0.97}) {
    EXPECT_NEAR(endless.at(x, 0.59).height, endless.at(x - 3, 0.59 + 1.2).height, 1e-14);
    const Point from{x, 0.2, 0.5}, moved{x + 5, 0.2 - 1.8, 0.5};
    const auto near = endless.nearest(from), there = endless.nearest(moved);
    EXPECT_NEAR(near.point[2], there.point[2], 1e-9);
    EXPECT_NEAR(near.point[0] + 5, there.point[0], 1e-8);
    EXPECT_NEAR(*endless.crossing(from, {0.6, 0, -0.8}), *endless.crossing(moved, {0.6, 0, -0.8}), 1e-12);
  }
  EXPECT_TRUE(ends.covers(0.9, 0.5));
  EXPECT_FALSE(ends.covers(0.91, 0.2));
  EXPECT_FALSE(ends.crossing({0.91, 0.2, 1}, {0, 0, -1}));
  EXPECT_FALSE(ends.crossing({0.5, 0.2, 1}, {0.8, 0, -0.6}));     // it leaves the map before
  EXPECT_FALSE(ends.crossing({-0.5, 0.2, -0.1}, {0.8, 0, -0.6})); // from beside, below the edge
  EXPECT_TRUE(ends.crossing({-0.5, 0.2, 0.5}, {0.8, 0, -0.6}));
}

TEST(HeightGrid, AWayCrossesTheSurfaceWhereItFirstMeetsIt)
{
  for (const auto interpolation : {Interpolation::bicubic, Interpolation::bilinear}) {
    const HeightGrid grid = rough(interpolation, true);
    std::mt19937 random(3);
    const auto number = [&] { return double(random()) / double(std::mt19937::max()); };
    for (int k = 0; k < 200; ++k) {
      const Point x{2 * number() - 0.5, number(), 0.08 * number() - 0.03};
      const double turn = 6.2832 * number(), flat = 0.9 * number();
      const Point way{flat * std::cos(turn), flat * std::sin(turn), -std::sqrt(1 - flat * flat)};
      const auto above = [&](const double g) {
        return x[2] + g * way[2] - grid.at(x[0] + g * way[0], x[1] + g * way[1]).height;
      };
      const auto g = grid.crossing(x, way);
      ASSERT_TRUE(g);
      EXPECT_NEAR(above(*g), 0, 1e-12);
      EXPECT_EQ(*g < 0, above(0) < 0);
      for (int part = 1; part < 50; ++part) {
        const double there = above(*g * part / 50);
        EXPECT_GT(*g < 0 ? -there : there, -1e-5) << part; // but for a ridge that it scratches
      }
    }
  }
}

TEST(HeightGrid, TheNearestPointIsThatOfAllOfThemAndTheWayToItIsTheNormal)
{
  for (const auto interpolation : {Interpolation::bicubic, Interpolation::bilinear}) {
    const HeightGrid grid = rough(interpolation, true);
    for (int k = 0; k < 20; ++k) {
      const Point x{std::fmod(0.618034 * k, 1), std::fmod(0.754878 * k, 0.6), 0.1 * k / 20 - 0.03};
      const auto nearest = grid.nearest(x);
      const Point way = difference(nearest.point, x);
      double least = 1;
      for (double a = x[0] - 0.15; a < x[0] + 0.15; a += 0.002)
        for (double b = x[1] - 0.15; b < x[1] + 0.15; b += 0.002)
          least = std::min(least, length(difference({a, b, grid.at(a, b).height}, x)));
      EXPECT_LE(length(way), least * (1 + 1e-9)) << k;
      EXPECT_GT(length(way), least - 0.002) << k;
      if (interpolation == Interpolation::bicubic && length(way) > 1e-6) {
        EXPECT_NEAR(std::abs(inner(way, nearest.normal)) / length(way), 1, 1e-8) << k;
      }
      EXPECT_NEAR(grid.at(nearest.point[0], nearest.point[1]).height, nearest.point[2], 1e-14);
    }
  }
}

TEST(HeightGrid, ABoxIsAtLeastAsFarFromItAsItSays)
{
  const HeightGrid grid = rough(Interpolation::bicubic, false);
  const Box high{{0.2, 0.1, 0.3}, {0.3, 0.2, 0.4}}, low{{0.2, 0.1, -0.3}, {0.3, 0.2, -0.2}},
      beside{{1.2, 0.1, 0}, {1.3, 0.2, 1}};
  EXPECT_GT(grid.clearance(high), 0.3 - 0.03); // overshoots are within the bounds
  EXPECT_LE(grid.clearance(high), 0.3 - grid.at(0.25, 0.15).height);
  EXPECT_EQ(grid.clearance(low), 0);
  EXPECT_NEAR(grid.clearance(beside), 0.3, 1e-12);
  EXPECT_LT(grid.heights().high, 0.03);
}

TEST(HeightGrid, ABoxOverManyPeriodsIsAsFarAsOneOverTwo)
{
  const HeightGrid grid = rough(Interpolation::bicubic, true);
  const double two = grid.clearance({{0.3, 0.2, 0.3}, {2.3, 1.4, 0.4}});
  EXPECT_NEAR(two, 0.3 - grid.heights().high, 1e-15);
  EXPECT_EQ(grid.clearance({{-1e3, -1e3, 0.3}, {1e3, 1e3, 0.4}}), two); // without going through all seven million
  EXPECT_EQ(grid.clearance({{-1e3, 0.2, 0.3}, {1e3, 1.4, 0.4}}), two);
}

TEST(HeightGrid, OfOneRowIsAProfile)
{
  const auto h = [](const double x, double) { return x * x; };
  const HeightGrid grid(table_of(h, 9, 1, 0.25, 0), Interpolation::bicubic, false);
  EXPECT_TRUE(grid.is_profile());
  EXPECT_NEAR(grid.at(0.6, 0).height, 0.36, 1e-14);
  const double g = *grid.crossing({0.7, 0, 1}, {0.6, 0, -0.8});
  EXPECT_NEAR(1 - 0.8 * g, (0.7 + 0.6 * g) * (0.7 + 0.6 * g), 1e-13);
  EXPECT_FALSE(grid.crossing({0.7, 0, 1}, {-0.6, 0, -0.8})); // it leaves the profile above it
  const auto nearest = grid.nearest({1, 0, 3});              // 2 x^3 - 5 x - 1 = 0
  EXPECT_NEAR(2 * std::pow(nearest.point[0], 3) - 5 * nearest.point[0] - 1, 0, 1e-9);
}

TEST(HeightGrid, TellsItsRoughness)
{
  const auto h = [](const double x, const double y) { return 0.01 * std::sin(6.283185307179586 * (3 * x + 4 * y)); };
  const HeightGrid grid(table_of(h, 256, 256, 1. / 256, 1. / 256), Interpolation::bicubic, true);
  EXPECT_NEAR(grid.rms_height(), 0.01 / std::sqrt(2.), 1e-12);
  EXPECT_NEAR(grid.rms_slope(), 0.01 * 6.2832 * 5 / std::sqrt(2.), 1e-3 * 0.2221);
}

} // namespace
} // namespace height_grid_test
