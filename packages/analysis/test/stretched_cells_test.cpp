// SPDX-License-Identifier: BSD-3-Clause
#include "clamped_block.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <vector>

/// Multigrid on the meshes of boxes that are thin or whose cells are stretched.
namespace stretched_cells_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using Doubles = std::vector<double>;
using Ints = std::vector<int>;

constexpr mesh::Shape simplex = mesh::Shape::simplex;

std::string text_of(const mesh::Element &element, const Ints &cells, const Doubles &upper)
{
  std::string text = element.name();
  for (int d = 0; d < element.dim; ++d)
    text += (d == 0 ? ", cells " : " x ") + std::to_string(cells[d]) + " of " + std::to_string(upper[d]);
  return text;
}

/// The most iterations to 1e-8 of an unordered right side and an even one.
struct Iterations {
  int elastic = 0, closed = 0;
};
Iterations iterations_on(const mesh::Element &element, const Ints &cells, const Doubles &upper)
{
  const Block block(element, cells, true, upper);
  const auto solver = block.solver();
  Vector even(block.d.owned_dofs);
  const auto fixed = to_host(block.dirichlet.fixed);
  for (LO i = 0; i < num_local(*block.d.owned_dofs); ++i)
    even.replaceLocalValue(i, fixed(i) ? 0 : component_of(element.dim, i) == element.dim - 1 ? -1 : 0.2);
  Iterations most;
  for (const bool closed : {false, true}) {
    if (closed) block.close([&](const double x) { return std::fmod(x / upper[0], 0.3) < 0.15; });
    int &iterations = closed ? most.closed : most.elastic;
    for (const Vector &b : {block.vector(3), even}) {
      Vector x(b.getMap());
      const auto result = solver->solve(b, x, 1e-8);
      EXPECT_TRUE(result.converged) << result.reason;
      iterations = std::max(iterations, result.iterations);
    }
  }
  EXPECT_EQ(solver->counts().preconditioner_setups, 1);
  EXPECT_EQ(solver->counts().fallback, "");
  return most;
}
void expect_few(const mesh::Element &element, const Ints &cells, const Doubles &upper, const int elastic,
                const int closed)
{
  SCOPED_TRACE(text_of(element, cells, upper));
  const Iterations most = iterations_on(element, cells, upper);
  EXPECT_LE(most.elastic, elastic);
  EXPECT_LE(most.closed, closed);
}

TEST(StretchedCells, TakeFewIterationsInThePlane)
{
  for (const double ratio : {1., 4., 16., 64., 1000.}) {
    for (const Doubles &upper : {Doubles{ratio, 1, 1}, Doubles{1, ratio, 1}}) {
      expect_few({2, 1}, {31, 30, 0}, upper, 12, 15);
      expect_few({2, 2}, {15, 16, 0}, upper, 15, 15);
      expect_few({2, 1, simplex}, {30, 30, 0}, upper, 15, 15);
    }
  }
}

TEST(StretchedCells, TakeFewIterationsInSpace)
{
  for (const double ratio : {1., 10., 1000.}) {
    for (const Doubles &upper : {Doubles{1, 1, 1 / ratio}, Doubles{1 / ratio, 1 / ratio, 1}}) {
      expect_few({3, 1}, {9, 8, 9}, upper, 15, 20);
      expect_few({3, 2}, {5, 5, 4}, upper, 15, 20);
    }
  }
  expect_few({3, 2}, {3, 4, 33}, {1, 1, 1}, 15, 20);
}

/// P2 has no mixed elements of its own: Q2's take their place, which is not as good.
TEST(StretchedCells, OfQuadraticTrianglesTakeMore)
{
  for (const double ratio : {4., 16., 64.}) {
    expect_few({2, 2, simplex}, {16, 16, 0}, {ratio, 1, 1}, 25, 25);
    expect_few({2, 2, simplex}, {16, 16, 0}, {1, ratio, 1}, 25, 25);
  }
}

/// One cell thick: the mesh is factored, or that of order 1 across.
TEST(StretchedCells, OfPlatesTakeFewIterations)
{
  for (const double thickness : {0.1, 0.01, 0.001}) {
    expect_few({3, 1}, {14, 14, 1}, {1, 1, thickness}, 15, 20);
    expect_few({3, 1}, {14, 14, 2}, {1, 1, thickness}, 15, 20);
    expect_few({3, 2}, {6, 6, 1}, {1, 1, thickness}, 15, 20);
  }
}

TEST(StretchedCells, OfThinBodiesEndWhereTheyAreFactored)
{
  const auto levels_of = [](const mesh::Element &element, const Ints &cells, const Doubles &upper) {
    return Block(element, cells, true, upper).levels();
  };
  const auto unknowns = [](const solver::MeshLevels &levels) {
    return levels.level.back().stiffness->getDomainMap()->getGlobalNumElements();
  };
  const auto plate = levels_of({3, 1}, {20, 20, 4}, {1, 1, 0.01});
  ASSERT_EQ(plate.level.size(), 2U);
  EXPECT_TRUE(plate.down_to_few);
  EXPECT_EQ(plate.remark, "thin in z: factored at 20 x 20 x 1 cells");
  EXPECT_EQ(unknowns(plate), 21U * 21U * 2U * 3U);

  const auto quadratic = levels_of({3, 2}, {10, 10, 1}, {1, 1, 0.01});
  ASSERT_EQ(quadratic.level.size(), 1U);
  EXPECT_EQ(quadratic.order, 2);
  EXPECT_EQ(quadratic.level[0].order, 2) << "in x and y";
  EXPECT_EQ(unknowns(quadratic), 21U * 21U * 2U * 3U);

  const auto strip = levels_of({2, 1}, {500, 1, 0}, {500, 1, 1});
  ASSERT_EQ(strip.level.size(), 1U) << "the mesh itself";
  EXPECT_EQ(strip.remark, "thin in y: factored at 500 x 1 cells");
  EXPECT_EQ(unknowns(strip), 501U * 2U * 2U);

  const auto block = levels_of({3, 1}, {20, 20, 20}, {1, 1, 1});
  EXPECT_EQ(block.remark, "");
  EXPECT_TRUE(block.down_to_few);
}

/// Bodies of square cells have the levels that they always had: order 1 on the same cells, then half as many cells.
TEST(StretchedCells, LeaveSquareOnesAlone)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const int n = element.order == 1 ? 24 : 12;
    const Block block(element, {2 * n, n, n}, true, {2, 1, 1});
    const auto levels = block.levels();
    EXPECT_EQ(levels.remark, "");
    int cells = n;
    for (std::size_t l = 0; l < levels.level.size(); ++l) {
      if (l > 0 || element.order == 1) cells /= 2;
      EXPECT_EQ(levels.level[l].order, 1);
      const std::size_t nodes = (2 * cells + 1) * (element.dim == 2 ? cells + 1 : (cells + 1) * (cells + 1));
      EXPECT_EQ(levels.level[l].interpolation->getDomainMap()->getGlobalNumElements(), nodes)
          << element.name() << ", level " << l;
    }
  }
}

} // namespace
} // namespace stretched_cells_test
