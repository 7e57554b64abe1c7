// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/uzawa.hpp"

#include "foundation_scene.hpp"
#include "rpc/core/causes.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

namespace uzawa_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using analysis::Minimization;
using analysis::UzawaOptions;
using analysis::UzawaResult;
using analysis::UzawaTest;
using contact::OptimalityResiduals;

constexpr double given_penalty = 40;

/// The KKT residual of each iteration, the last one for all that follow.
using Residuals = std::vector<double>;

/// The loop of solve_step() with a minimization and residuals of our own making.
struct Stubbed {
  Scene scene{given_penalty};
  RCP<Vector> u = scene.vector(0, 0), step = scene.vector(0.05, 0.4);
  UzawaOptions options;
  double unbalanced = 0;
  double rounding = 0;           ///< the equilibrium residual that it makes
  std::vector<double> penalties; ///< the largest one at each minimization

  UzawaResult run(const Residuals &residuals, const Minimization &inner)
  {
    contact::Iterate &iterate = *scene.iterate;
    UzawaResult result;
    bool over = false;
    while (!over) {
      penalties.push_back(largest_penalty());
      result.multiplier_change = iterate.duals().update(*u);
      const double previous = result.residuals.worst();
      result.residuals.kkt_residual =
          penalties.size() <= residuals.size() ? residuals[penalties.size() - 1] : residuals.back();
      result.residuals.equilibrium_residual = unbalanced;
      result.newton_iterations.push_back(inner.steps);
      ++result.iterations;
      over = analysis::is_over(
          result, inner, previous, options, scene.d.mesh->comm(), [&] { return iterate.raise_penalty(*u); },
          [&] { return rounding; });
    }
    return result;
  }
  double largest_penalty() const
  {
    const auto penalty = to_host(scene.iterate->duals().penalty());
    double largest = 0;
    for (std::size_t i = 0; i < penalty.extent(0); ++i) largest = std::max(largest, penalty(i));
    return max_all(scene.d.mesh->comm(), largest);
  }
};

const Minimization converged{true, 3, "", false, 0}, at_rounding{false, 7, "rounding has the last word", false, 0};

TEST(Uzawa, StopsAtTheFirstOptimalityResidualsThatHolds)
{
  Stubbed stubbed;
  const auto result = stubbed.run({1e-3, 1e-5, 1e-9}, converged);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_EQ(result.newton_iterations, (std::vector<int>{3, 3, 3}));
  EXPECT_EQ(result.residuals.kkt_residual, 1e-9);
  EXPECT_EQ(stubbed.largest_penalty(), given_penalty); // fast enough: nothing to raise
}

TEST(Uzawa, AMinimizationThatFailedDoesNotMatterWhereTheyHold)
{
  Stubbed stubbed;
  const auto result = stubbed.run({1e-9}, at_rounding);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_EQ(result.reason.find(at_rounding.reason), std::string::npos) << result.reason;
}

TEST(Uzawa, RaisesThePenaltyWhereAnUpdateLeavesMoreThanATenth)
{
  Stubbed stubbed;
  stubbed.options.max_iterations = 5;
  const auto result = stubbed.run({1, 0.05, 0.006, 0.0001, 0.0001}, converged);
  EXPECT_FALSE(result.converged);
  EXPECT_NE(result.reason.find("5 Uzawa iterations were not enough"), std::string::npos) << result.reason;
  const double first = stubbed.penalties[0], raised = stubbed.penalties[3];
  EXPECT_EQ(stubbed.penalties, (std::vector<double>{first, first, first, raised, raised}));
  EXPECT_GT(raised, 1e3 * first);
  EXPECT_GT(stubbed.largest_penalty(), raised); // the last iteration was slow again
}

TEST(Uzawa, OneIterationIsNotSlow)
{
  Stubbed stubbed;
  stubbed.options.max_iterations = 1;
  stubbed.run({1}, converged);
  EXPECT_EQ(stubbed.largest_penalty(), given_penalty);
}

TEST(Uzawa, GoesOnFromAMinimizationThatFailedAsLongAsThatHelps)
{
  Stubbed stubbed;
  const auto result = stubbed.run({1e-2, 5e-4, 2e-5, 1e-6, 5e-8, 1e-9}, at_rounding);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, 6);
}

TEST(Uzawa, EndsWithTheReasonOfTheMinimizationWhenNothingIsLeftToRaise)
{
  Stubbed stubbed;
  const auto result = stubbed.run({1e-3}, at_rounding);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.reason, at_rounding.reason);
  EXPECT_EQ(result.iterations, 5); // 40 -> 1e5, 1e7, 1e8 times the own stiffness
  EXPECT_EQ(stubbed.penalties[4], stubbed.largest_penalty());
  EXPECT_LT(stubbed.penalties[3], stubbed.penalties[4]);
}

TEST(Uzawa, EndsAtOnceWhereNumbersAreNotFinite)
{
  Stubbed stubbed;
  const auto result = stubbed.run({std::numeric_limits<double>::quiet_NaN()}, at_rounding);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.reason, at_rounding.reason);
  EXPECT_EQ(result.iterations, 1);
}

TEST(Uzawa, ResidualsWithoutBoundAreNoHeadway)
{
  Stubbed stubbed;
  const auto result = stubbed.run({std::numeric_limits<double>::infinity()}, at_rounding);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.reason, at_rounding.reason);
  EXPECT_LT(result.iterations, 10);
}

TEST(Uzawa, SaysRoundingWhereItIsMeasured)
{
  for (const double rounding : {1e-4, 1e-6}) {
    Stubbed stubbed;
    stubbed.rounding = rounding;
    stubbed.unbalanced = 1e-4;
    const auto result = stubbed.run({1e-3}, converged);
    EXPECT_FALSE(result.converged);
    const Cause &cause = rounding < 1e-5 ? causes::stuck : causes::rounding;
    for (const char *const part : {cause.said, cause.remedy})
      EXPECT_NE(result.reason.find(part), std::string::npos) << result.reason;
  }
}

TEST(Uzawa, ThePapersTestAsksForMultipliersAtRestAsWell)
{
  Stubbed stubbed;
  stubbed.options.test = UzawaTest::multiplier_change;
  stubbed.u->assign(*stubbed.step);
  const auto result = stubbed.run({1e-9}, converged);
  EXPECT_TRUE(result.converged);
  EXPECT_GT(result.iterations, 1);
  EXPECT_LT(result.multiplier_change, stubbed.options.tolerance);
}

} // namespace
} // namespace uzawa_test
