#include "../src/band_cholesky.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace
{

using rpc::solver::BandCholesky;
using rpc::solver::SymmetricEntries;

constexpr double any_work = 1e12;

/// Five-point differences on n x n places, numbered by a step that scatters neighbours, with something added to the diagonal;
/// the diagonal comes in two parts.
SymmetricEntries scattered_grid(const int n, const double shift)
{
  const int size = n * n;
  const auto number = [&](const int i, const int j) { return (7 * (i * n + j)) % size; };
  SymmetricEntries entries;
  const auto add = [&](const int row, const int column, const double value) {
    entries.row.push_back(row);
    entries.column.push_back(column);
    entries.value.push_back(value);
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int here = number(i, j);
      add(here, here, 4);
      add(here, here, shift);
      for (const int other : {i > 0 ? number(i - 1, j) : -1, i + 1 < n ? number(i + 1, j) : -1,
                              j > 0 ? number(i, j - 1) : -1, j + 1 < n ? number(i, j + 1) : -1})
        if (other >= 0) add(here, other, -1);
    }
  return entries;
}

std::vector<double> product(const SymmetricEntries &A, const std::vector<double> &x)
{
  std::vector<double> y(x.size(), 0.);
  for (std::size_t e = 0; e < A.row.size(); ++e) y[A.row[e]] += A.value[e] * x[A.column[e]];
  return y;
}

TEST(BandCholesky, SolvesASystemInAnyOrder)
{
  for (const int n : {1, 2, 10}) {
    const auto A = scattered_grid(n, 0.1);
    const auto factor = BandCholesky::factor(n * n, A, any_work);
    ASSERT_TRUE(factor);
    std::vector<double> x(n * n);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::sin(1. + static_cast<double>(i));
    auto solution = product(A, x);
    factor->solve(solution.data());
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(solution[i], x[i], 1e-12) << n << " " << i;
  }
}

TEST(BandCholesky, RefusesWhatTakesTooMuchWork)
{
  // In the right order the band of a 10 x 10 grid is about 10 wide, in the given one 70.
  EXPECT_TRUE(BandCholesky::factor(100, scattered_grid(10, 0.1), 100 * 15. * 15));
  EXPECT_FALSE(BandCholesky::factor(100, scattered_grid(10, 0.1), 100 * 5. * 5));
}

TEST(BandCholesky, RefusesAMatrixThatIsNotPositiveDefinite)
{
  EXPECT_FALSE(BandCholesky::factor(100, scattered_grid(10, -1), any_work));
}

TEST(BandCholesky, OfNothingIsNothing)
{
  const auto factor = BandCholesky::factor(0, {}, any_work);
  ASSERT_TRUE(factor);
  factor->solve(nullptr);
}

} // namespace
