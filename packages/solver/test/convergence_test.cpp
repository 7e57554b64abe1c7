// SPDX-License-Identifier: BSD-3-Clause
#include "krylov/convergence.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace convergence_test
{
namespace
{

using rpc::solver::Convergence;
using rpc::solver::EnergyError;

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

/// Energies 1 - q^k: what is left of 1 is q^k, and the first gain alone tells nothing unless a rate is known.
TEST(EnergyError, OfAConstantRateIsToldExactly)
{
  constexpr double q = 0.3;
  EnergyError error, with_rate(q);
  EXPECT_TRUE(std::isinf(error.squared()));
  EXPECT_TRUE(std::isinf(with_rate.squared())) << "nothing was gained yet";
  for (int k = 1; k <= 6; ++k) {
    error.add(1 - std::pow(q, k));
    with_rate.add(1 - std::pow(q, k));
    if (k == 1) {
      EXPECT_TRUE(std::isinf(error.squared()));
    } else {
      EXPECT_NEAR(error.squared(), std::pow(q, k), 1e-14) << k;
    }
    EXPECT_NEAR(with_rate.squared(), std::pow(q, k), 1e-14) << k;
  }
  EXPECT_NEAR(error.rate(), q, 1e-12);
}

/// Gains that rise, or stand still, are never the end of it.
TEST(EnergyError, OfAStallIsTenGains)
{
  EnergyError error;
  for (const double energy : {1., 1.1, 1.3}) error.add(energy);
  EXPECT_NEAR(error.squared(), 9 * 0.2, 1e-12);
  EXPECT_NEAR(error.rate(), 0.9, 1e-12);
}

} // namespace
} // namespace convergence_test
