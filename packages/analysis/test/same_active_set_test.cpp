// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/same_active_set.hpp"

#include "beam.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace same_active_set_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

TEST(SameActiveSet, StopsAtTheUsersStatusTests)
{
  solver::NewtonOptions options;
  Teuchos::ParameterList &tests = options.nox.sublist("Status Tests");
  tests.set("Test Type", "MaxIters");
  tests.set("Maximum Iterations", 1);
  Beam beam;
  ASSERT_TRUE(minimize(beam).converged);
  beam.iterate->duals().update(*beam.u);
  const auto from_same = [&](auto &steps) { return analysis::minimize_from_same_active_set(*beam.iterate, steps); };
  const auto result = minimize(beam, options, from_same);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.steps, 1);
}

TEST(SameActiveSet, AfterAMultiplierUpdateTakesOneStepWhereThePapersNewtonTakesMore)
{
  // The first minimization, with xi/2 for multipliers, leaves v = (p - lambda)/r. With lambda <- p the nodes with p < xi/4 or p > 3 xi/4
  // count as open or yielding by lambda + r v at that v.
  solver::NewtonOptions papers;
  papers.nox.sublist("Direction").set("Method", "Newton");
  for (const double xi : {14., 16., 18.}) {
    SCOPED_TRACE(xi);
    std::vector<int> steps;
    for (const bool same : {true, false}) {
      Beam beam({}, below(ScalarField(xi), 0, ScalarField(0.)));
      ASSERT_TRUE(minimize(beam, papers).converged);
      beam.iterate->duals().update(*beam.u);
      beam.iterate->move_origin(*beam.u);
      const auto from_same = [&](auto &steps) { return analysis::minimize_from_same_active_set(*beam.iterate, steps); };
      const auto result = same ? minimize(beam, {}, from_same) : minimize(beam, papers);
      EXPECT_TRUE(result.converged) << result.reason;
      steps.push_back(result.steps);
    }
    EXPECT_EQ(steps[0], 1);
    EXPECT_LT(steps[0], steps[1]);
  }
}

} // namespace
} // namespace same_active_set_test
