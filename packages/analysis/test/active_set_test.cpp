// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/active_set.hpp"

#include "beam.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace active_set_test
{
namespace
{

using namespace rpc;
using rpc::test::Beam;
using rpc::test::below;
using rpc::test::contact_law_residual;
using rpc::test::minimize;

constexpr double inf = std::numeric_limits<double>::infinity();

/// What became of the active-set iteration, and of Newton's steps after it.
struct Found {
  int steps = 0;
  bool confirmed = false;
  solver::MinimizeResult all;

  int newton_steps() const { return all.steps - steps; }
};
Found solve(Beam &beam, const analysis::ActiveSetTolerances &tolerances = {},
            const solver::NewtonReport &report = rpc::test::ignore)
{
  analysis::ActiveSetLoop loop(*beam.iterate, tolerances);
  const auto all = minimize(beam, {}, std::ref(loop), report);
  return {loop.steps(), loop.confirmed(), all};
}

contact::ContactOptions flat(const double xi, const double gap, const double penalty = 0)
{
  return below(ScalarField(xi), penalty, ScalarField(gap));
}
GO num_points(const contact::StateCounts &states)
{
  return states.open + states.closed + states.yielding;
}

TEST(ActiveSet, OfTheBeamOnItsFoundationIsConfirmedByNewtonAtOnce)
{
  for (const double penalty : {0., 1e8}) { // chosen, and the paper's
    for (const double xi : {0.5, 14., 16., 19., inf}) {
      Beam beam({}, flat(xi, 0, penalty));
      const Found found = solve(beam);
      EXPECT_GE(found.steps, 1) << xi;
      EXPECT_LE(found.steps, 9) << xi;
      EXPECT_LE(found.newton_steps(), 1) << xi;
      const auto states = beam.iterate->functional().count_states(*beam.u);
      EXPECT_EQ(num_points(states), 79);
      const auto newton = minimize(beam);
      EXPECT_TRUE(newton.converged) << xi << ": " << newton.reason;
      EXPECT_LE(newton.steps, 1) << xi;
      const auto confirmed = beam.iterate->functional().count_states(*beam.u);
      EXPECT_EQ(states.open, confirmed.open) << xi;
      EXPECT_EQ(states.closed, confirmed.closed) << xi;
      EXPECT_EQ(states.yielding, confirmed.yielding) << xi;
      beam.iterate->duals().update(*beam.u);
      EXPECT_LT(contact_law_residual(*beam.iterate, *beam.iterate->state(*beam.u).displacement), 1e-5) << xi;
    }
  }
}

TEST(ActiveSet, BringsPressuresToTheirTolerance)
{
  std::vector<int> steps;
  for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
    Beam beam({}, flat(14, 0));
    analysis::ActiveSetTolerances own;
    own.pressure = tolerance;
    const Found found = solve(beam, own);
    EXPECT_TRUE(found.confirmed);
    EXPECT_TRUE(found.all.converged);
    EXPECT_LE(beam.iterate->pressure_error(*beam.u), tolerance);
    steps.push_back(found.steps);
  }
  EXPECT_LE(steps[0], steps[1]);
  EXPECT_LT(steps[1], steps[2]);
}

TEST(ActiveSet, AboveAGapIsFoundWhateverTheYieldLimit)
{
  for (const double gap : {0.001, 0.01}) {
    for (const double xi : {2., 14., inf}) {
      Beam beam({}, flat(xi, gap));
      const Found found = solve(beam);
      EXPECT_LE(found.all.steps, 12) << xi;
      EXPECT_TRUE(found.all.converged) << xi << ": " << found.all.reason;
      EXPECT_LE(found.newton_steps(), 4) << xi;
    }
  }
}

TEST(ActiveSet, AboveAGapIsFoundWhereTheLoadReachesTheYieldLimitInPart)
{
  for (const double xi : {18., 22., 100.}) {
    Beam beam({}, flat(xi, 0.01));
    const Found found = solve(beam);
    EXPECT_GE(found.all.steps, 4) << xi;
    EXPECT_LE(found.all.steps, 12) << xi;
    EXPECT_TRUE(found.all.converged) << xi << ": " << found.all.reason;
    EXPECT_TRUE(found.confirmed) << xi;
  }
}

/// Foundations that are wavy in yield stress and gap, found by search.
TEST(ActiveSet, OfWavyFoundationsIsFoundByManyChangesOrNewtonOrTheInteriorPath)
{
  using analysis::FoundBy;
  struct Wavy {
    const char *name;
    double yield, yield_phase, yield_waves, gap, gap_phase, gap_waves;
    int most;
    FoundBy by;
  };
  for (const Wavy &w : {Wavy{"more than ten changes, fewer each time", 8, 33, 25, 0.08, 28, 34, 16, FoundBy::choices},
                        Wavy{"much overshoot", 10, 28, 5, 0.03, 27, 35, 9, FoundBy::newton},
                        Wavy{"short steps of Newton's", 15, 39, 30, 0.02, 39, 5, 20, FoundBy::interior_path}}) {
    SCOPED_TRACE(w.name);
    const ScalarField xi(
        "xi", [w](const Point &x) { return w.yield * (1 + 0.97 * std::sin(w.yield_phase + w.yield_waves * x[0])); });
    const ScalarField gap("gap", [w](const Point &x) {
      return x[0] == 0 || x[0] == 5 ? 0 : w.gap * std::sin(w.gap_phase + w.gap_waves * x[0]);
    });
    Beam beam({}, below(xi, 0, gap));
    analysis::ActiveSetLoop loop(*beam.iterate, {});
    const auto all = minimize(beam, {}, std::ref(loop));
    EXPECT_TRUE(all.converged) << all.reason;
    EXPECT_TRUE(loop.confirmed());
    EXPECT_EQ(loop.found_by(), w.by);
    EXPECT_LE(all.steps, w.most);
    const int newton_steps = all.steps - loop.steps(),
              solves = static_cast<int>(beam.linear->counts().iterations.size());
    if (w.by == FoundBy::choices) {
      EXPECT_GT(all.steps, 10);
      EXPECT_EQ(newton_steps, 0);
    } else {
      EXPECT_GE(newton_steps, 2);
    }
    if (w.by == FoundBy::interior_path)
      EXPECT_GE(solves, all.steps + 3) << "two solves a step";
    else
      EXPECT_LE(solves, all.steps + 1) << "one solve a step";
  }
}

/// Pressures of nearly incompressible bodies err by more: forces that the law does not admit may be larger before choices end. A wavy
/// foundation found by search.
TEST(ActiveSet, OfNearlyIncompressibleBodiesIsChosenForLonger)
{
  const ScalarField xi("xi", [](const Point &x) { return 15 * (1 + 0.97 * std::sin(30 + 2 * x[0])); });
  const ScalarField gap("gap",
                        [](const Point &x) { return x[0] == 0 || x[0] == 5 ? 0 : 0.01 * std::sin(34 + 34 * x[0]); });
  for (const bool nearly_incompressible : {false, true}) {
    Beam beam({}, below(xi, 0, gap));
    analysis::ActiveSetTolerances own;
    own.nearly_incompressible = nearly_incompressible;
    analysis::ActiveSetLoop loop(*beam.iterate, own);
    EXPECT_TRUE(minimize(beam, {}, std::ref(loop)).converged);
    EXPECT_TRUE(loop.confirmed());
    EXPECT_EQ(loop.found_by() == analysis::FoundBy::choices, nearly_incompressible);
  }
}

/// Bending of a thin strip turns choices of states by pressures over.
TEST(ActiveSet, OfThinStripsIsFoundWhereChoicesFail)
{
  for (const double xi : {3e-3, inf}) {
    for (const double gap : {1e-3, 1e-2}) {
      SCOPED_TRACE(testing::Message() << "xi " << xi << ", gap " << gap);
      rpc::test::PressedBox strip({{0, 0}, {1, 0.02}, {100, 1}, {2, 1}}, {1000, 0.3}, {"left"}, ScalarField(-1e-3),
                                  flat(xi, gap));
      analysis::ActiveSetLoop loop(*strip.iterate, {});
      const auto all = rpc::test::minimize(strip, {}, std::ref(loop));
      EXPECT_TRUE(all.converged) << all.reason;
      EXPECT_TRUE(loop.confirmed());
      EXPECT_NE(loop.found_by(), analysis::FoundBy::choices);
      EXPECT_GE(all.steps, 2);
      EXPECT_LE(all.steps, 20);
    }
  }
}

/// Steps of the interior path along a strip. After three steps none makes the gap more than half as large again, and it ends below 1e-8.
TEST(ActiveSet, StepsOfTheInteriorPathCloseTheGap)
{
  rpc::test::PressedBox strip({{0, 0}, {1, 0.02}, {100, 1}, {2, 1}}, {1000, 0.3}, {"left"}, ScalarField(-1e-3),
                              flat(3e-3, 1e-2));
  Vector &u = *strip.u;
  Vector F(u.getMap()), G(u.getMap()), d(u.getMap());
  const auto solve_for = [&](Vector &x) {
    ASSERT_TRUE(strip.linear->solve(F, x, {1e-10}).converged);
    x.scale(-1.);
  };
  contact::InteriorPath path = strip.iterate->interior_path(u);
  for (int step = 0; step < 60 && path.gap() > 1e-8; ++step) {
    const double gap = path.gap();
    path.linearize(u, F);
    solve_for(d);
    path.correct(u, d, F);
    path.gradient(u, G);
    G.update(-1., F, 1.);
    EXPECT_LE(G.norm2(), 1e-10 * F.norm2()) << "F has followed the targets";
    solve_for(d);
    const double taken = path.advance(u, d);
    EXPECT_GT(taken, 0);
    EXPECT_LE(taken, 1);
    u.update(taken, d, 1.);
    if (step > 2) {
      EXPECT_LT(path.gap(), 1.5 * gap);
    }
  }
  EXPECT_LE(path.gap(), 1e-8);
}

/// Of strips that a coarser mesh has been solved for, what found the states there makes the first steps. The states are the same, and
/// tries that fail are left out.
TEST(ActiveSet, BeginsWithWhatFoundTheStatesOfTheMeshThatPredicts)
{
  using analysis::FoundBy;
  int steps[3] = {0, 0, 0};
  for (const double gap : {1e-3, 3e-3, 1e-2}) {
    contact::StateCounts states[3];
    for (int k = 0; k < 3; ++k) {
      const FoundBy coarser = std::array{FoundBy::choices, FoundBy::newton, FoundBy::interior_path}[k];
      rpc::test::PressedBox strip({{0, 0}, {1, 0.02}, {100, 1}, {2, 1}}, {1000, 0.3}, {"left"}, ScalarField(-1e-3),
                                  flat(inf, gap));
      analysis::ActiveSetLoop loop(*strip.iterate, {});
      loop.starts_predicted(coarser);
      const auto all = rpc::test::minimize(strip, {}, std::ref(loop));
      EXPECT_TRUE(all.converged) << all.reason;
      EXPECT_TRUE(loop.confirmed());
      if (coarser == FoundBy::interior_path) {
        EXPECT_EQ(all.steps, loop.steps()) << "none of Newton's";
      }
      EXPECT_GE(loop.found_by(), coarser);
      steps[k] += all.steps;
      states[k] = strip.iterate->functional().count_states(*strip.u);
      EXPECT_EQ(states[k].open, states[0].open);
      EXPECT_EQ(states[k].closed, states[0].closed);
      EXPECT_EQ(states[k].yielding, states[0].yielding);
    }
  }
  EXPECT_LT(steps[1], steps[0]);
  EXPECT_LT(steps[2], steps[0]);
}

/// Whatever the coarser mesh needed, the states are found without its choices where its factors are not cheap.
TEST(ActiveSet, GoesOnWhereTheCoarserMeshCannotChoose)
{
  using analysis::FoundBy;
  for (const FoundBy coarser : {FoundBy::choices, FoundBy::coarse_choices, FoundBy::newton, FoundBy::interior_path}) {
    rpc::test::PressedBox strip({{0, 0}, {1, 0.02}, {100, 1}, {2, 1}}, {1000, 0.3}, {"left"}, ScalarField(-1e-3),
                                flat(inf, 1e-3));
    analysis::ActiveSetLoop loop(*strip.iterate, {});
    int asked = 0;
    loop.starts_predicted(coarser, [&](const contact::Iterate &, double) {
      ++asked;
      return std::unique_ptr<analysis::CoarseChoice>();
    });
    EXPECT_TRUE(rpc::test::minimize(strip, {}, std::ref(loop)).converged);
    EXPECT_TRUE(loop.confirmed());
    EXPECT_EQ(asked, 1);
    EXPECT_EQ(loop.coarse_choices(), 0);
  }
}

TEST(ActiveSet, OfTheBeamIsChosen)
{
  Beam beam;
  analysis::ActiveSetLoop loop(*beam.iterate, {});
  EXPECT_TRUE(minimize(beam, {}, std::ref(loop)).converged);
  EXPECT_EQ(loop.found_by(), analysis::FoundBy::choices);
}

/// The edge of the contact zone of a block whose surface has many short cells moves on by a point with each choice.
TEST(ActiveSet, WhoseEdgeCreepsIsLeftToNewtonWhereMuchOfTheWayIsLeft)
{
  const ScalarField gap("gap", [](const Point &x) { return 0.02 * (x[0] - 0.6) * (x[0] - 0.6) - 0.002; });
  rpc::test::PressedBox block({{0, 0}, {1.25, 0.9}, {400, 4}, {2, 1}}, {14000, 0.2}, {"right"}, ScalarField(-120.),
                              below(ScalarField(2360.), 0, gap));
  analysis::ActiveSetLoop loop(*block.iterate, {});
  const auto all = rpc::test::minimize(block, {}, std::ref(loop));
  EXPECT_TRUE(all.converged) << all.reason;
  EXPECT_TRUE(loop.confirmed());
  EXPECT_NE(loop.found_by(), analysis::FoundBy::choices);
  EXPECT_LE(all.steps, 20) << "24 where ten choices creep before the path";
}

TEST(ActiveSet, StepsAreReportedLikeNewtons)
{
  Beam beam;
  std::vector<solver::NewtonStep> seen;
  std::vector<GO> points;
  const Found found = solve(beam, {}, [&](const solver::NewtonStep &step, const Vector &u) {
    seen.push_back(step);
    points.push_back(num_points(beam.iterate->functional().count_states(u)));
  });
  ASSERT_TRUE(found.confirmed);
  ASSERT_EQ(static_cast<int>(seen.size()), found.steps + 1); // with the start
  for (int k = 0; k <= found.steps; ++k) {
    EXPECT_EQ(seen[k].iteration, k);
    EXPECT_EQ(points[k], 79);
    EXPECT_EQ(seen[k].linear_iterations > 0, k > 0);
    EXPECT_GT(seen[k].residual, 0);
  }
}

TEST(ActiveSet, OfHeldNodesAloneLeavesNothingToNewton)
{
  auto foundation = flat(16, 0);
  foundation.side = "left"; // held
  Beam held({}, foundation);
  const Found found = solve(held);
  EXPECT_LE(found.steps, 1);
  EXPECT_EQ(found.newton_steps(), 0);
  EXPECT_TRUE(found.all.converged);
}

TEST(ActiveSet, IsUndoneWhereTheSystemCannotBeSolved)
{
  solver::LinearSolverOptions weak;
  weak.max_iterations = 1;
  weak.multigrid = "algebraic"; // no sparse factor stands in
  Beam beam(weak);
  analysis::ActiveSetLoop loop(*beam.iterate, {});
  solver::NewtonOptions options;
  options.max_iterations = 1;
  minimize(beam, options, std::ref(loop));
  EXPECT_EQ(loop.steps(), 0);
  EXPECT_FALSE(loop.confirmed());
  const auto lambda = to_host(beam.iterate->duals().multipliers().normal);
  double sum = 0;
  for (std::size_t i = 0; i < lambda.extent(0); ++i) sum += lambda(i);
  EXPECT_EQ(sum_all(beam.d.mesh->comm(), sum), 79 * 8.);
}

TEST(ActiveSet, StepsAreNotTakenWhereTheDeckAsksForOtherDirections)
{
  for (const char *method : {"Sweep", "Newton"}) {
    Beam beam;
    analysis::ActiveSetLoop loop(*beam.iterate, {});
    solver::NewtonOptions options;
    options.nox.sublist("Direction").set("Method", method);
    EXPECT_TRUE(minimize(beam, options, std::ref(loop)).converged) << method;
    EXPECT_EQ(loop.steps(), 0) << method;
  }
}

/// They stand in place of those of the loop, and of Newton's.
TEST(ActiveSet, StopsAtTheUsersStatusTestsWhateverItBeginsWith)
{
  using analysis::FoundBy;
  solver::NewtonOptions options;
  Teuchos::ParameterList &tests = options.nox.sublist("Status Tests");
  tests.set("Test Type", "MaxIters");
  tests.set("Maximum Iterations", 2);
  for (const FoundBy coarser : {FoundBy::choices, FoundBy::newton, FoundBy::interior_path}) {
    rpc::test::PressedBox strip({{0, 0}, {1, 0.02}, {100, 1}, {2, 1}}, {1000, 0.3}, {"left"}, ScalarField(-1e-3),
                                flat(inf, 1e-3));
    analysis::ActiveSetLoop loop(*strip.iterate, {});
    loop.starts_predicted(coarser);
    const auto result = rpc::test::minimize(strip, options, std::ref(loop));
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.steps, 2);
    EXPECT_EQ(loop.steps(), coarser == FoundBy::newton ? 0 : 2);
  }
}

TEST(ActiveSet, IsNoLongerConfirmedWhereNewtonGoesOn)
{
  solver::NewtonOptions options;
  Teuchos::ParameterList &tests = options.nox.sublist("Status Tests");
  tests.set("Test Type", "MaxIters");
  tests.set("Maximum Iterations", 30);
  Beam beam;
  analysis::ActiveSetLoop loop(*beam.iterate, {});
  const auto result = minimize(beam, options, std::ref(loop));
  EXPECT_GT(loop.steps(), 0);
  EXPECT_GT(result.newton_steps, 0);
  EXPECT_FALSE(loop.confirmed());
}

TEST(ActiveSet, ConvergesByTheUsersStatusTestsThoughNoChoiceIsConfirmed)
{
  solver::NewtonOptions options;
  Teuchos::ParameterList &tests = options.nox.sublist("Status Tests");
  tests.set("Test Type", "NormF");
  tests.set("Scale Type", "Unscaled");
  for (const double tolerance : {1e9, 0.5}) { // N: at the start, and on the way
    Beam beam;
    tests.set("Tolerance", tolerance);
    analysis::ActiveSetLoop loop(*beam.iterate, {});
    const auto result = minimize(beam, options, std::ref(loop));
    EXPECT_TRUE(result.converged) << result.reason;
    EXPECT_FALSE(loop.confirmed());
    EXPECT_EQ(result.steps > 0, tolerance < 1);
    EXPECT_EQ(result.newton_steps, 0);
  }
}

} // namespace
} // namespace active_set_test
