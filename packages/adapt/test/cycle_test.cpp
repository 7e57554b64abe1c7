// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/adapt/cycle.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Error bars from the meshes of a run. doc/theory.md (10.7), (10.8)

namespace cycle_test
{
namespace
{

using namespace rpc;
using adapt::Cycle;
using adapt::observed_errors;

Cycle mesh(const double estimate, const double force, const double pressure)
{
  Cycle c;
  c.estimate = estimate;
  c.energy = 1;
  c.energy_norm_squared = 2;
  c.contact.force = {0, force, 0};
  c.contact.max_pressure = pressure;
  return c;
}

TEST(ErrorBars, OfOneMeshAreNone)
{
  const auto errors = observed_errors({mesh(0.1, 10, 30)});
  EXPECT_TRUE(std::isnan(errors.contact_force));
  EXPECT_EQ(errors.unknown.size(), adapt::error_bars.size());
}

TEST(ErrorBars, AreNoLessThanWhatTheLastMeshLeavesOpen)
{
  // Meshes that agree by chance.
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  auto errors = observed_errors(cycles);
  EXPECT_NEAR(errors.energy, 2 * 0.02 * 0.02 * 2 / 2, 1e-15);
  EXPECT_NEAR(errors.contact_force, 2 * 0.02 * 0.02 * 10, 1e-15);
  EXPECT_EQ(errors.max_pressure, 0); // nothing but its change and the recovered stress tells of it
  // Data that jump: 0.3 N at a load that has moved by 2 J / 10 N, and an edge that may release 0.01 J.
  cycles.back().jumped_force = 0.3;
  errors = observed_errors(cycles);
  EXPECT_NEAR(errors.contact_force, 2 * 0.02 * 0.02 * 10 + 0.3, 1e-15);
  EXPECT_NEAR(errors.energy, 0.02 * 0.02 * 2 + 0.3 * 0.2, 1e-15);
  cycles.back().jumped_force = 0;
  cycles.back().jumped_energy = 0.01;
  errors = observed_errors(cycles);
  EXPECT_NEAR(errors.contact_force, 2 * 0.02 * 0.02 * 10 + 2 * 0.01 / 0.2, 1e-15);
  EXPECT_NEAR(errors.energy, 0.02 * 0.02 * 2 + 0.01, 1e-15);
}

TEST(ErrorBars, OfReactionsAreThoseOfForces)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  cycles[0].reactions = {{3, -4, 0}, {0, 1, 0}};
  cycles[1].reactions = {{3, -4, 0}, {0.3, 1.4, 0}};
  auto errors = observed_errors(cycles);
  ASSERT_EQ(errors.reactions.size(), 2U);
  EXPECT_NEAR(errors.reactions[0], 2 * 0.02 * 0.02 * 10, 1e-15); // by the largest force at work, that of contact
  EXPECT_NEAR(errors.reactions[1], 0.5 / (0.1 / 0.02 - 1), 1e-12);
  cycles[1].jumped_force = cycles[0].jumped_force = 0.3;
  cycles[1].reactions[0] = cycles[0].reactions[0] = {0, 50, 0};
  errors = observed_errors(cycles);
  EXPECT_NEAR(errors.reactions[0], 2 * 0.02 * 0.02 * 50 + 0.3, 1e-12);
  EXPECT_NEAR(errors.contact_force, 2 * 0.02 * 0.02 * 10 + 0.3, 1e-12);
}

TEST(ErrorBars, OfMeshesThatAreHardlyFinerAreWide)
{
  const auto errors = observed_errors({mesh(0.1, 10, 30), mesh(0.08, 10.01, 30.1)});
  EXPECT_NEAR(errors.max_pressure, 0.08 * 30.1, 1e-12);
}

TEST(ErrorBars, AreTheLastChangeWhereChangesDoNotFall)
{
  // The estimate falls by three twice, the changes grow: (10.7) alone would be half of the last one.
  const auto errors = observed_errors({mesh(0.18, 10, 30), mesh(0.06, 10.1, 30.5), mesh(0.02, 9.8, 30.4)});
  EXPECT_NEAR(errors.contact_force, 0.3, 1e-12);
}

TEST(ErrorBars, OfALargestPressureThatGrowsWithoutLimitAreNone)
{
  const auto growing = observed_errors({mesh(0.5, 10, 30), mesh(0.1, 10, 46), mesh(0.02, 10, 62)});
  EXPECT_TRUE(std::isnan(growing.max_pressure));
  EXPECT_NE(growing.unknown.at("max_pressure").find("does not settle"), std::string::npos);
  const auto settling = observed_errors({mesh(0.5, 10, 30), mesh(0.1, 10, 46), mesh(0.02, 10, 49)});
  EXPECT_NEAR(settling.max_pressure, std::max(3. / 4, 16. / 4 / 5), 1e-12);
  auto kinked = mesh(0.1, 10, 46);
  kinked.peak.kink = 0.1;
  EXPECT_TRUE(std::isnan(observed_errors({mesh(0.5, 10, 30), kinked}).max_pressure));
}

} // namespace
} // namespace cycle_test
