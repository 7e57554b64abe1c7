// SPDX-License-Identifier: BSD-3-Clause
#include "factor/matrix_changes.hpp"

#include "factor/direct_solver.hpp"
#include "grid.hpp"
#include "rpc/core/parallel.hpp"

#include <gtest/gtest.h>

// What has changed in a matrix since it was factored, and the solver that follows it.

namespace matrix_changes_test
{
namespace
{

using namespace rpc;
using solver::DirectSolver;
using Update = solver::CoarsestSolver::Update;

/// A grid whose entries change, on any rank.
struct Changing {
  test::Grid grid;
  HostView<double *> before;

  explicit Changing(const int n) : grid(n) { keep(); }
  void keep()
  {
    const auto values = grid.A->getLocalMatrixDevice().values;
    before = HostView<double *>("before", values.extent(0));
    Kokkos::deep_copy(before, values);
  }
  /// Adds to the entry, and to its mirror image, where this rank has the row.
  void add(const GO row, const GO column, const double value) const
  {
    grid.A->resumeFill();
    for (const auto &[i, j] : {std::pair(row, column), std::pair(column, row)}) {
      if (grid.map->isNodeGlobalElement(i))
        grid.A->sumIntoGlobalValues(i, Teuchos::tuple<GO>(j)(), Teuchos::tuple<double>(value)());
      if (row == column) break;
    }
    grid.A->fillComplete();
  }
  /// Adds to the own blocks of the first nodes.
  void stiffen(const GO num_nodes, const double value) const
  {
    for (GO row = 0; row < 2 * num_nodes; ++row) add(row, row, value);
  }
  solver::MatrixChanges changes() const { return solver::changes_since(before, *grid.A, 2); }
};

/// x . (V S V^T) y with the numbers of all unknowns at hand.
double product(const solver::LowRankTerms &change, const std::vector<double> &x, const std::vector<double> &y)
{
  const auto along = [](const solver::RankOneTerm &term, const std::vector<double> &of) {
    double sum = 0;
    for (int k = 0; k < 2; ++k) sum += term.v[k] * of[term.first_row + k];
    return sum;
  };
  double sum = 0;
  for (const auto &term : change.terms) sum += term.scale * along(term, x) * along(term, y);
  for (const auto &[i, j, value] : change.couplings)
    sum += value * (along(change.terms[i], x) * along(change.terms[j], y) +
                    along(change.terms[j], x) * along(change.terms[i], y));
  return sum;
}

std::vector<double> waves(const int size, const double phase)
{
  std::vector<double> x(size);
  for (int i = 0; i < size; ++i) x[i] = std::sin(phase + 1.3 * i);
  return x;
}

/// A node that has changed alone gives terms of its own block, nodes that have changed together the entries.
TEST(MatrixChanges, AreTheDifference)
{
  constexpr int n = 9, size = 2 * n * n;
  const Changing scene(n);
  EXPECT_TRUE(scene.changes().at_nodes.empty());
  EXPECT_TRUE(scene.changes().between.empty());
  struct Entry {
    GO row, column;
    double value;
  };
  const Entry entries[] = {{20, 20, 1e-3}, {21, 21, 3},    {20, 21, -0.05}, // node 10
                           {91, 91, 7},                                     // node 45
                           {60, 60, 2},    {60, 62, -1.5}, {63, 63, 0.5}};  // nodes 30 and 31
  const auto x = waves(size, 0.3), y = waves(size, 1.7);
  double expected = 0;
  for (const auto &[row, column, value] : entries) {
    scene.add(row, column, value);
    expected += value * x[row] * y[column] + (row == column ? 0 : value * x[column] * y[row]);
  }
  const auto changes = scene.changes();
  EXPECT_EQ(changes.at_nodes.size(), 3U);
  EXPECT_EQ(changes.between.size(), 3U);
  const auto all = low_rank_terms(changes, 0, 2);
  EXPECT_EQ(all.terms.size(), 6U) << "three at nodes, three unknowns that have changed together";
  EXPECT_EQ(all.couplings.size(), 1U);
  EXPECT_NEAR(product(all, x, y), expected, 1e-13);
  const auto most = low_rank_terms(changes, 1, 2); // of node 45 alone 7 of 4.1 have changed
  EXPECT_EQ(most.terms.size(), 4U) << "entries between nodes are never left out";
}

/// What the solver leaves of a right side.
double left(const Changing &scene, const DirectSolver &factor)
{
  const Vector b = scene.grid.right_side();
  Vector x(b.getMap());
  factor.apply(b, x);
  return scene.grid.relative_residual(x, b);
}

/// Few changes are followed without a new factor, also where nodes change together; many are not, but may be left out where they are slight.
TEST(DirectSolver, FollowsFewChangesByTheOldFactor)
{
  constexpr int n = 110; // too wide for a band
  constexpr double rounding = 1e-12;
  const Changing scene(n);
  DirectSolver factor(scene.grid.A, 2);
  ASSERT_TRUE(factor.make());
  EXPECT_LT(left(scene, factor), rounding);
  scene.stiffen(3, 5e3);
  EXPECT_GT(left(scene, factor), 1e-3);
  EXPECT_EQ(factor.update(0), Update::exact);
  EXPECT_LT(left(scene, factor), rounding);
  scene.add(400, 402, -0.7);
  EXPECT_EQ(factor.update(0), Update::exact);
  EXPECT_LT(left(scene, factor), rounding);
  scene.stiffen(n * n, 1e-6);
  EXPECT_EQ(factor.update(0.1), Update::rough);
  EXPECT_LT(left(scene, factor), 1e-4);
  EXPECT_GT(left(scene, factor), rounding);
  EXPECT_EQ(factor.update(0), Update::made);
  EXPECT_LT(left(scene, factor), rounding);
  scene.stiffen(3, -5e3);
  EXPECT_EQ(factor.update(0), Update::exact);
  factor.forget();
  EXPECT_EQ(factor.update(0), Update::made);
  scene.stiffen(n * n, -100);
  EXPECT_THROW(factor.update(0), std::runtime_error) << "not positive definite";
}

} // namespace
} // namespace matrix_changes_test
