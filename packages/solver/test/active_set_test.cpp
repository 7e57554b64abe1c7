#include "rpc/solver/active_set.hpp"

#include "beam.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace
{

using namespace rpc;
using rpc::test::Beam;
using rpc::test::below;
using rpc::test::ignore;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr int most_steps = 14; // ten changes of states, and multiplier updates
const solver::NewtonOptions options;

int find_states(Beam &beam)
{
  return solver::find_states(*beam.functional, *beam.linear, *beam.u, options, ignore).steps;
}
contact::MinimizeResult minimize(Beam &beam)
{
  return solver::minimize(*beam.functional, *beam.linear, beam.u, options, false, ignore);
}

contact::ContactOptions flat(const double xi, const double gap, const double penalty = 0)
{
  return below(ScalarField(xi), penalty, ScalarField(gap));
}
GO num_points(const contact::StateCounts &states)
{
  return states.open + states.stuck + states.yielded;
}

TEST(FindStates, OfTheBeamOnItsFoundationAreConfirmedByNewtonAtOnce)
{
  for (const double penalty : {0., 1e8}) { // chosen, and the paper's
    for (const double xi : {0.5, 14., 16., 19., inf}) {
      Beam beam({}, flat(xi, 0, penalty));
      const int steps = find_states(beam);
      EXPECT_GE(steps, 1) << xi;
      EXPECT_LE(steps, 9) << xi;
      const auto states = beam.functional->count_states(*beam.u);
      EXPECT_EQ(num_points(states), 79);
      const auto newton = minimize(beam);
      EXPECT_TRUE(newton.converged) << xi << ": " << newton.reason;
      EXPECT_LE(newton.newton_iterations, 1) << xi;
      const auto confirmed = beam.functional->count_states(*beam.u);
      EXPECT_EQ(states.open, confirmed.open) << xi;
      EXPECT_EQ(states.stuck, confirmed.stuck) << xi;
      EXPECT_EQ(states.yielded, confirmed.yielded) << xi;
      beam.functional->update_multipliers(*beam.u);
      EXPECT_LT(beam.functional->contact_law_residual(beam.functional->displacement(*beam.u)), 1e-5) << xi;
    }
  }
}

TEST(FindStates, BringsPressuresToTheirTolerance)
{
  std::vector<int> steps;
  for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
    Beam beam({}, flat(14, 0));
    solver::NewtonOptions own;
    own.pressure_tolerance = tolerance;
    const auto found = solver::find_states(*beam.functional, *beam.linear, *beam.u, own, ignore);
    EXPECT_TRUE(found.confirmed);
    EXPECT_LE(beam.functional->pressure_error(*beam.u), tolerance);
    steps.push_back(found.steps);
  }
  EXPECT_LE(steps[0], steps[1]);
  EXPECT_LT(steps[1], steps[2]);
}

TEST(FindStates, AboveAGapAreFoundWhateverTheYieldLimit)
{
  for (const double gap : {0.001, 0.01}) {
    for (const double xi : {2., 14., inf}) {
      Beam beam({}, flat(xi, gap));
      EXPECT_LE(find_states(beam), 12) << xi;
      const auto newton = minimize(beam);
      EXPECT_TRUE(newton.converged) << xi << ": " << newton.reason;
      EXPECT_LE(newton.newton_iterations, 2) << xi;
    }
  }
}

TEST(FindStates, AboveAGapAreFoundWhereTheLoadReachesTheYieldLimitInPart)
{
  for (const double xi : {18., 22., 100.}) {
    Beam beam({}, flat(xi, 0.01));
    const int steps = find_states(beam);
    EXPECT_GE(steps, 4) << xi;
    EXPECT_LE(steps, most_steps) << xi;
    const auto newton = minimize(beam);
    EXPECT_TRUE(newton.converged) << xi << ": " << newton.reason;
    EXPECT_LE(newton.newton_iterations, 2) << xi;
  }
}

TEST(FindStates, LeaveToNewtonWhatDoesNotSettle)
{
  const ScalarField xi("xi", [](const Point &x) { return 25 * (1 + 0.9 * std::sin(9 + 12 * x[0])); });
  const ScalarField gap("gap",
                        [](const Point &x) { return x[0] == 0 || x[0] == 5 ? 0 : 0.01 * std::sin(11.7 + 11 * x[0]); });
  Beam beam({}, below(xi, 0, gap));
  EXPECT_LE(find_states(beam), most_steps);
  const auto newton = minimize(beam);
  EXPECT_TRUE(newton.converged) << newton.reason;
  EXPECT_LE(newton.newton_iterations, 15);
}

TEST(FindStates, ReportEachStep)
{
  Beam beam;
  std::vector<solver::NewtonStep> seen;
  const int steps =
      solver::find_states(*beam.functional, *beam.linear, *beam.u, options, [&](const solver::NewtonStep &step) {
        seen.push_back(step);
      }).steps;
  ASSERT_EQ(static_cast<int>(seen.size()), steps);
  for (int k = 0; k < steps; ++k) {
    EXPECT_EQ(seen[k].iteration, k + 1);
    EXPECT_EQ(num_points(seen[k].states), 79);
    EXPECT_GT(seen[k].linear_iterations, 0);
    EXPECT_GT(seen[k].residual, 0);
  }
}

TEST(FindStates, OfHeldNodesAloneLeaveNothingToNewton)
{
  auto foundation = flat(16, 0);
  foundation.side = "left"; // held
  Beam held({}, foundation);
  EXPECT_LE(find_states(held), 1);
  EXPECT_TRUE(minimize(held).converged);
}

TEST(FindStates, AreUndoneWhereTheSystemCannotBeSolved)
{
  solver::LinearSolverOptions weak;
  weak.max_iterations = 1;
  Beam beam(weak);
  EXPECT_EQ(find_states(beam), 0);
  EXPECT_EQ(beam.u->normInf(), 0);
  const auto lambda = to_host(beam.functional->multipliers());
  double sum = 0;
  for (std::size_t i = 0; i < lambda.extent(0); ++i) sum += lambda(i);
  EXPECT_EQ(sum_all(beam.d.mesh->comm(), sum), 79 * 8.);
}

} // namespace
