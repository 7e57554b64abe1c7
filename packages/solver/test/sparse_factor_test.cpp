// SPDX-License-Identifier: BSD-3-Clause
#include "factor/band_factor.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/solver/sparse_factor.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>

namespace sparse_factor_test
{
namespace
{

using rpc::solver::BandFactor;
using rpc::solver::factor_of;
using rpc::solver::SparseColumns;
using rpc::solver::SparseFactor;
using rpc::solver::SymmetricEntries;

constexpr double any_work = 1e12;

/// Five-point differences on length x height places, of which each has a number: steps of 7 scatter neighbours. Something is added to the
/// diagonal, which comes in two parts.
constexpr int scattering = 7;
int number_of(const int place, const int size, const int step = scattering)
{
  return step * place % size;
}
SymmetricEntries scattered_grid(const int length, const int height, const double shift, const int step = scattering)
{
  const auto number = [&](const int i, const int j) { return number_of(i * height + j, length * height, step); };
  SymmetricEntries entries;
  const auto add = [&](const int row, const int column, const double value) {
    entries.row.push_back(row);
    entries.column.push_back(column);
    entries.value.push_back(value);
  };
  for (int i = 0; i < length; ++i)
    for (int j = 0; j < height; ++j) {
      const int here = number(i, j);
      add(here, here, 4);
      add(here, here, shift);
      for (const int other : {i > 0 ? number(i - 1, j) : -1, i + 1 < length ? number(i + 1, j) : -1,
                              j > 0 ? number(i, j - 1) : -1, j + 1 < height ? number(i, j + 1) : -1})
        if (other >= 0) add(here, other, -1);
    }
  return entries;
}
SymmetricEntries scattered_grid(const int n, const double shift)
{
  return scattered_grid(n, n, shift);
}

std::vector<double> product(const SymmetricEntries &A, const std::vector<double> &x)
{
  std::vector<double> y(x.size(), 0.);
  for (std::size_t e = 0; e < A.row.size(); ++e) y[A.row[e]] += A.value[e] * x[A.column[e]];
  return y;
}

/// This rank's share of the entries: every so many.
SymmetricEntries share_of(const SymmetricEntries &all, const rpc::Comm &comm)
{
  SymmetricEntries mine;
  for (std::size_t e = comm.getRank(); e < all.row.size(); e += comm.getSize()) {
    mine.row.push_back(all.row[e]);
    mine.column.push_back(all.column[e]);
    mine.value.push_back(all.value[e]);
  }
  return mine;
}

std::vector<double> some_solution(const int size)
{
  std::vector<double> x(size);
  for (int i = 0; i < size; ++i) x[i] = std::sin(1. + i);
  return x;
}

/// What all ranks see of rank 0's vector.
std::vector<double> from_root(const rpc::Comm &comm, std::vector<double> x)
{
  Teuchos::broadcast(comm, 0, static_cast<int>(x.size()), x.data());
  return x;
}

TEST(SparseFactor, SolvesASystemInAnyOrder)
{
  for (const int n : {1, 2, 10, 90}) { // bands, and what is too wide for a band
    const auto A = scattered_grid(n, 0.1);
    const auto factor = factor_of(n * n, A, any_work);
    ASSERT_TRUE(factor);
    const auto x = some_solution(n * n);
    auto solution = product(A, x);
    factor->solve(solution.data());
    for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(solution[i], x[i], 1e-12) << n << " " << i;
  }
}

/// Columns of few entries, more of them than MUMPS takes at once, one without any; dense right sides before and after them.
TEST(SparseFactor, SolvesForManyColumnsOfFewEntries)
{
  const auto comm = Tpetra::getDefaultComm();
  for (const int n : {10, 90}) {
    const int size = n * n, columns = 50, empty = 7;
    const auto A = scattered_grid(n, 0.1);
    if (n == 90 && !SparseFactor::can_be_shared) continue;
    const auto factor =
        n == 90 ? SparseFactor::analyse(comm, size, share_of(A, *comm), 1) : factor_of(size, A, any_work);
    if (n == 90) {
      ASSERT_TRUE(factor->make(share_of(A, *comm).value));
    }
    SparseColumns B;
    std::vector<double> whole(static_cast<std::size_t>(size) * columns, 0.);
    for (int c = 0; c < columns; ++c) {
      for (int k = 0; k < 3 && c != empty; ++k) {
        B.row.push_back((37 * c + 11 * k) % size);
        B.value.push_back(1. + k);
        whole[static_cast<std::size_t>(c) * size + B.row.back()] = B.value.back();
      }
      B.begin.push_back(static_cast<int>(B.row.size()));
    }
    const bool is_root = comm->getRank() == 0 || n != 90;
    const auto one = some_solution(size);
    for (int repeat = 0; repeat < 2; ++repeat) {
      auto alone = product(A, one);
      factor->solve(is_root ? alone.data() : nullptr);
      std::vector<double> x(whole.size(), 3.);
      factor->solve(B, is_root ? x.data() : nullptr);
      if (!is_root) continue;
      for (int i = 0; i < size; ++i) ASSERT_NEAR(alone[i], one[i], 1e-12) << n << " " << i;
      for (int c = 0; c < columns; ++c) {
        const auto from = x.begin() + static_cast<std::ptrdiff_t>(c) * size;
        const auto b = product(A, std::vector<double>(from, from + size));
        for (int i = 0; i < size; ++i)
          ASSERT_NEAR(b[i], whole[static_cast<std::size_t>(c) * size + i], 1e-12) << n << " " << c << " " << i;
      }
    }
  }
}

/// Ranks that each hold some of the entries factor the matrix together, and follow its values.
TEST(SparseFactor, IsMadeByAllRanksTogether)
{
  if (!SparseFactor::can_be_shared) GTEST_SKIP() << "without MUMPS";
  const auto comm = Tpetra::getDefaultComm();
  const int n = 90, size = n * n;
  const auto factor = SparseFactor::analyse(comm, size, share_of(scattered_grid(n, 0.1), *comm), 1);
  EXPECT_FALSE(factor->exists());
  const auto x = some_solution(size);
  for (const double shift : {0.1, 2., -1., 0.5}) {
    const auto A = scattered_grid(n, shift);
    EXPECT_EQ(factor->make(share_of(A, *comm).value), shift > 0) << shift;
    EXPECT_EQ(factor->exists(), shift > 0);
    if (!factor->exists()) continue;
    auto solution = product(A, x);
    factor->solve(comm->getRank() == 0 ? solution.data() : nullptr);
    solution = from_root(*comm, solution);
    for (int i = 0; i < size; ++i) ASSERT_NEAR(solution[i], x[i], 1e-12) << shift << " " << i;
  }
}

TEST(SparseFactor, ToldCostGrowsAsThatOfNestedDissection)
{
  if (!SparseFactor::can_be_shared) GTEST_SKIP() << "without MUMPS";
  const auto comm = rpc::rcp(new Teuchos::SerialComm<int>);
  std::vector<double> operations;
  for (const int n : {100, 200}) {
    const auto cost = SparseFactor::analyse(comm, n * n, scattered_grid(n, 0.1), 1)->cost();
    operations.push_back(cost.operations);
    EXPECT_GT(cost.entries, 2. * n * n);
    EXPECT_GT(cost.bytes, 8 * cost.entries);
    EXPECT_GT(cost.seconds, cost.seconds_of_solve);
  }
  EXPECT_GT(operations[1] / operations[0], 6) << "n^3 for n x n unknowns in the plane";
  EXPECT_LT(operations[1] / operations[0], 12) << "a band would take n^4";
}

/// A long grid whose numbers go along it is a band; scattered, the same grid is none.
TEST(SparseFactor, TakesTheBandThatTheNumbersAre)
{
  if (!SparseFactor::can_be_shared) GTEST_SKIP() << "without MUMPS";
  const int length = 3000, height = 5, size = length * height;
  const double band = BandFactor::cost_of(size, height).entries;
  for (const int step : {1, scattering}) {
    const auto A = scattered_grid(length, height, 0.1, step);
    const auto factor = factor_of(size, A, any_work);
    ASSERT_TRUE(factor);
    if (step == 1)
      EXPECT_EQ(factor->cost().entries, band);
    else
      EXPECT_NE(factor->cost().entries, band);
    const auto x = some_solution(size);
    auto solution = product(A, x);
    factor->solve(solution.data());
    for (int i = 0; i < size; ++i) ASSERT_NEAR(solution[i], x[i], 1e-12) << step << " " << i;
  }
}

TEST(SparseFactor, RefusesWhatTakesTooMuchWork)
{
  // In the right order the band of a 10 x 10 grid is about 10 wide, in the given one 70.
  EXPECT_TRUE(factor_of(100, scattered_grid(10, 0.1), 100 * 15. * 15));
  EXPECT_FALSE(factor_of(100, scattered_grid(10, 0.1), 100 * 5. * 5));
}

TEST(SparseFactor, RefusesAMatrixThatIsNotPositiveDefinite)
{
  for (const int n : {10, 90}) EXPECT_FALSE(factor_of(n * n, scattered_grid(n, -1), any_work)) << n;
}

/// A grid of 40 x 5 places, scattered by their numbers: the band is one column of places wide.
TEST(BandFactor, FollowsAGivenOrder)
{
  const int length = 40, height = 5, size = length * height;
  const auto A = scattered_grid(length, height, 0);
  std::vector<int> place(size);
  for (int at = 0; at < size; ++at) place[number_of(at, size)] = at;
  BandFactor factor(size, A, place);
  const auto cost = factor.cost(), told = BandFactor::cost_of(size, height);
  EXPECT_EQ(cost.entries, size * (height + 1.));
  EXPECT_EQ(cost.entries, told.entries);
  EXPECT_EQ(cost.seconds, told.seconds);
  ASSERT_TRUE(factor.make(A.value));
  const auto x = some_solution(size);
  auto solution = product(A, x);
  factor.solve(solution.data());
  for (int i = 0; i < size; ++i) ASSERT_NEAR(solution[i], x[i], 1e-13) << i;
}

TEST(BandFactor, OfNothingIsNothing)
{
  const auto factor = BandFactor::as_numbered(0, {});
  EXPECT_TRUE(factor->make({}));
  factor->solve(nullptr);
}

} // namespace
} // namespace sparse_factor_test
