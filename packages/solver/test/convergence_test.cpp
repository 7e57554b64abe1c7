#include "../src/convergence.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace
{

using rpc::solver::Convergence;

TEST(Convergence, OfAConstantRateIsToldExactly)
{
  Convergence seen;
  for (int k = 1; k <= 25; ++k) {
    seen.add(std::pow(0.5, k));
    EXPECT_EQ(seen.iterations(), k);
    EXPECT_NEAR(seen.iterations_in_all(std::pow(0.5, 40), 500), 40, 1e-9) << k;
  }
  EXPECT_EQ(seen.iterations_in_all(1e-3, 500), 25) << "it is there";
}

/// Six digits in fifteen iterations, then a hundredth of a digit in each: over all of them the rate would promise an end before 60.
TEST(Convergence, OfAStallIsNotHiddenByWhatWasGainedBefore)
{
  Convergence seen;
  for (int k = 1; k <= 15; ++k) seen.add(std::pow(10., -0.4 * k));
  EXPECT_NEAR(seen.iterations_in_all(1e-8, 500), 20, 1e-9);
  for (int k = 16; k <= 35; ++k) seen.add(std::pow(10., -6 - 0.01 * (k - 15)));
  EXPECT_NEAR(seen.iterations_in_all(1e-8, 500), 35 + 180, 1e-9);
  for (int k = 36; k <= 55; ++k) seen.add(2e-6);
  EXPECT_EQ(seen.iterations_in_all(1e-8, 500), 500);
}

/// Residuals of CG rise at first where some modes are hard: what was not reduced counts as nothing gained.
TEST(Convergence, CountsTheLeastResidualOnly)
{
  Convergence seen;
  for (const double residual : {3., 8., 2.}) seen.add(residual);
  EXPECT_EQ(seen.iterations_in_all(1e-8, 500), 500);
  for (const double residual : {0.1, 0.4}) seen.add(residual);
  EXPECT_NEAR(seen.iterations_in_all(1e-2, 500), 5 + 5, 1e-9);
}

} // namespace
