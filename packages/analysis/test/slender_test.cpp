// SPDX-License-Identifier: BSD-3-Clause
#include "clamped_block.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <string>
#include <vector>

/// Boxes with few cells across: a factor of a narrow band takes the place of multigrid.
namespace slender_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr mesh::Shape simplex = mesh::Shape::simplex;

std::unique_ptr<solver::LinearSolver> solver_of(const Block &block, const bool levels_are_asked_for)
{
  return std::make_unique<solver::LinearSolver>(solver::LinearSolverOptions(), block.H, analysis::body_of(block.d),
                                                [&block, levels_are_asked_for] {
                                                  EXPECT_TRUE(levels_are_asked_for) << "in vain";
                                                  return block.levels();
                                                });
}

/// How far entries of K lie from the diagonal by their gids, on all ranks.
double width_of(const Block &block)
{
  const auto K = block.H->base().copy();
  const Map &rows = *K->getRowMap(), &columns = *K->getColMap();
  GO width = 0;
  for (LO row = 0; row < num_local(rows); ++row) {
    CrsMatrix::local_inds_host_view_type column;
    CrsMatrix::values_host_view_type value;
    K->getLocalRowView(row, column, value);
    for (std::size_t j = 0; j < column.size(); ++j)
      width = std::max(width, rows.getGlobalElement(row) - columns.getGlobalElement(column(j)));
  }
  return static_cast<double>(max_all(*rows.getComm(), width));
}

struct Slender {
  mesh::Element element;
  std::vector<int> cells;
  std::vector<double> upper;
  int most_ranks; // multigrid's iterations take less time the more ranks there are, a factor does not
};
// Of about equal sides: a slender body bends so far that the rounding of x leaves more than what is asked for below.
const Slender slender[] = {{{2, 1, simplex}, {700, 1}, {1, 1}, 3}, {{2, 1}, {2, 500}, {1, 2}, 3},
                           {{2, 2}, {200, 1}, {2, 1}, 3},          {{2, 2, simplex}, {1, 200}, {1, 1}, 3},
                           {{3, 1}, {250, 1, 1}, {1, 1, 1}, 3},    {{3, 1, simplex}, {1, 1, 250}, {2, 1, 1}, 3},
                           {{2, 1}, {900, 6}, {2, 1}, 2}};

TEST(SlenderBody, HasTheBandThatItsBoxTells)
{
  for (const auto &[element, cells, upper, most_ranks] : slender) {
    const Block block(element, cells, true, upper);
    const double told = analysis::body_of(block.d).band_width, is = width_of(block);
    if (element.shape == simplex) { // its cells' diagonals may go the shorter way
      EXPECT_LE(is, told) << element.name();
      EXPECT_GE(is, 0.7 * told) << element.name();
    } else {
      EXPECT_EQ(is, told) << element.name();
    }
  }
  EXPECT_EQ(analysis::body_of(Block({2, 1}, {9, 9}, false).d).band_width, 0) << "a mesh from a file";
}

/// With all sets of states, to the same solution as multigrid. Each rank has a factor.
TEST(SlenderBody, IsSolvedByABandFactor)
{
  for (const auto &[element, cells, upper, most_ranks] : slender) {
    SCOPED_TRACE(element.name());
    const Block block(element, cells, true, upper);
    const bool narrow = block.d.mesh->comm().getSize() <= most_ranks;
    const auto solver = solver_of(block, !narrow), meshes = block.solver();
    const Vector b = block.vector(7);
    Vector x(b.getMap()), expected(b.getMap());
    const double longest = *std::max_element(upper.begin(), upper.end());
    for (const double closed : {0., 0.1, 0.15, 0.}) {
      block.close([&](const double at) { return std::fmod(at / longest, 0.3) < closed; });
      const auto result = solver->solve(b, x, 1e-6);
      EXPECT_TRUE(result.converged) << result.reason;
      EXPECT_LT(block.residual(x, b), 1.01e-6);
      if (narrow) {
        EXPECT_LE(result.iterations, 4);
      }
      EXPECT_TRUE(meshes->solve(b, expected, 1e-6).converged);
      EXPECT_LT(relative_difference(x, expected), 1e-4);
    }
    if (!narrow) continue;
    EXPECT_EQ(solver->counts().fallback.rfind("it takes no longer than a few iterations", 0), 0U)
        << solver->counts().fallback;
    EXPECT_EQ(solver->counts().description.rfind("band factor of ", 0), 0U) << solver->counts().description;
  }
}

/// Blocks keep their multigrid, and so does what the deck gives a method for.
TEST(SlenderBody, IsNoBlock)
{
  const Block block(
      {2, 1}, {180, 150, 0}); // on a GPU, whose kernels take some time in any case, smaller ones have a band factor
  const Vector b = block.vector(7);
  Vector x(b.getMap());
  const auto solver = solver_of(block, true);
  EXPECT_TRUE(solver->solve(b, x, 1e-8).converged);
  EXPECT_EQ(solver_path(solver->counts()), "meshes");
  const Slender &thin = slender[0];
  const Block strip(thin.element, thin.cells, true, thin.upper);
  const auto by_deck = strip.solver();
  const Vector c = strip.vector(7);
  Vector y(c.getMap());
  EXPECT_TRUE(by_deck->solve(c, y, 1e-8).converged);
  EXPECT_EQ(solver_path(by_deck->counts()), "meshes");
}

/// A layer of cells longer than it is thick has no coarser mesh: its own factor needs no cycle around it.
TEST(SlenderBody, OfOneThinLayerIsFactoredAtOnce)
{
  const Block plate({3, 1}, {30, 30, 1}, true, {1, 1, 0.01});
  const auto solver = solver_of(plate, false);
  const Vector b = plate.vector(7);
  Vector x(b.getMap());
  const auto result = solver->solve(b, x, 1e-8);
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_LE(result.iterations, 2);
  EXPECT_LT(plate.residual(x, b), 1.01e-8);
  EXPECT_EQ(solver_path(solver->counts()), "sparse factor: the body is one thin layer of cells");
}

} // namespace
} // namespace slender_test
