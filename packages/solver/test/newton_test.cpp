// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/newton.hpp"

#include "beam.hpp"
#include "kinked_line.hpp"
#include "newton/nox_line_search.hpp"
#include "rpc/core/causes.hpp"
#include "rpc/core/error.hpp"
#include "rpc/solver/exact_line_search.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <random>

namespace newton_test
{
namespace
{

using namespace rpc;
using rpc::test::Beam;
using rpc::test::below;
using rpc::test::minimize;
using rpc::test::open_between;
using Line = rpc::test::KinkedLine;

TEST(ExactStep, FindsTheRootOfTheSlopeWhateverTheKinks)
{
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Line line(1 + seed % 60, seed);
    const auto model = line.model(-0.01 * (seed + 1), seed % 3 == 0 ? 1e-3 : 2);
    const double t = solver::exact_step(*model);
    ASSERT_GT(t, 0);
    const double eps = 1e-10 * t; // the slope changes sign at t
    EXPECT_LE(model->at(t - eps).slope, 1e-12 * 0.01 * (seed + 1)) << seed;
    EXPECT_GE(model->at(t + eps).slope, -1e-12 * 0.01 * (seed + 1)) << seed;
  }
}

TEST(ExactStep, IsOneForAQuadraticAndItsNewtonStep)
{
  const Line line(0, 0);
  EXPECT_NEAR(solver::exact_step(*line.model(-3, 3)), 1, 1e-12);
  EXPECT_NEAR(solver::exact_step(*line.model(-3e-20, 3e-20)), 1, 1e-12);
  EXPECT_NEAR(solver::exact_step(*line.model(-1, 1e-6)), 1e6, 1e-6);
}

TEST(ExactStep, IsZeroWithoutDescent)
{
  const Line line(3, 7);
  EXPECT_EQ(solver::exact_step(*line.model(1, 2)), 0);
  EXPECT_EQ(solver::exact_step(*line.model(std::nan(""), 2)), 0);
}

TEST(ExactStep, IsInfiniteWhereTheFunctionalFallsWithoutEnd)
{
  const Line line(0, 0);
  EXPECT_EQ(solver::exact_step(*line.model(-1, 0)), std::numeric_limits<double>::infinity());
  EXPECT_EQ(solver::exact_step(*line.model(-1, -1)), std::numeric_limits<double>::infinity());
}

TEST(Newton, FullStepsCycleWhereExactStepsConverge)
{
  for (const double xi : {16., 18.}) {
    Beam full({}, below(ScalarField(xi), 1e8)), exact({}, below(ScalarField(xi), 1e8));
    solver::NewtonOptions full_steps;
    full_steps.nox.sublist("Line Search").set("Method", "Full Step");
    full_steps.nox.sublist("Direction").set("Method", "Newton"); // a sweep leads out of the cycle
    full_steps.max_iterations = 30;
    std::vector<std::array<GO, 3>> states;
    const auto record = [&](const solver::NewtonStep &, const Vector &u) {
      const auto counts = full.iterate->functional().count_states(u);
      states.push_back({counts.open, counts.closed, counts.yielding});
    };
    solver::MinimizeResult with_full, with_exact;
    for (int uzawa = 0; uzawa < 4;
         ++uzawa) { // cold each time: the start that a multiplier update leaves is where full steps cycle
      if (uzawa == 0 || with_full.converged) {
        states.clear();
        with_full = minimize(full, full_steps, nullptr, record);
        full.iterate->duals().update(*full.u);
      }
      with_exact = minimize(exact);
      EXPECT_TRUE(with_exact.converged) << with_exact.reason;
      EXPECT_LE(with_exact.steps, 12);
      exact.iterate->duals().update(*exact.u);
    }
    EXPECT_FALSE(with_full.converged);
    EXPECT_EQ(with_full.steps, 30);
    EXPECT_NE(with_full.reason.find(causes::circles.said), std::string::npos) << with_full.reason;
    EXPECT_NE(with_full.reason.find("Full Step"), std::string::npos) << with_full.reason;
    EXPECT_GT(std::count(states.begin(), states.end(), states.back()), 1)
        << "the states of the last step came before: a cycle";
  }
}

TEST(Newton, LineSearchesOfNoxLowerTheFunctional)
{
  for (const char *const method : {"Backtrack", "Polynomial", "More'-Thuente"}) {
    Beam beam({}, below(ScalarField(16.), 1e8)), exact({}, below(ScalarField(16.), 1e8));
    solver::NewtonOptions options;
    options.nox.sublist("Direction").set("Method", "Newton");
    Teuchos::ParameterList &search = options.nox.sublist("Line Search");
    search.set("Method", method);
    if (method == std::string("Backtrack"))
      search.sublist(method)
          .set("Minimum Step", 1e-4)
          .set("Recovery Step", 1e-4); // as lists for other problems have it
    for (int uzawa = 0; uzawa < 4; ++uzawa) {
      const auto result = minimize(beam, options);
      EXPECT_TRUE(result.converged) << method << ": " << result.reason;
      EXPECT_LE(result.steps, 20) << method;
      minimize(exact);
      const double least = exact.iterate->value(*exact.u);
      EXPECT_NEAR(beam.iterate->value(*beam.u), least, 1e-10 * std::abs(least)) << method;
      beam.iterate->duals().update(*beam.u);
      exact.iterate->duals().update(*exact.u);
    }
  }
}

TEST(Newton, ALineSearchThatFindsNothingIsTheReason)
{
  Beam beam({}, below(ScalarField(16.), 1e8));
  solver::NewtonOptions options;
  options.nox.sublist("Direction").set("Method", "Newton");
  options.nox.sublist("Line Search").set("Method", "Backtrack");
  options.nox.sublist("Line Search").sublist("Backtrack").set("Minimum Step", 0.9).set("Recovery Step", 1e-6);
  options.max_iterations = 30;
  solver::MinimizeResult result;
  for (int uzawa = 0; uzawa < 4; ++uzawa) {
    result = minimize(beam, options);
    if (!result.converged) break;
    beam.iterate->duals().update(*beam.u);
  }
  EXPECT_FALSE(result.converged);
  for (const char *const part :
       {causes::no_lower_step.said, causes::no_lower_step.remedy, "Minimum Step 0.9", "Recovery Step 1e-06"})
    EXPECT_NE(result.reason.find(part), std::string::npos) << result.reason;
}

TEST(Newton, MethodsThatCannotBeUsedAreRefused)
{
  const auto refused = [](const char *const list, const char *const method, const char *const usable) {
    Teuchos::ParameterList deck = solver::valid_newton_parameters();
    deck.sublist(list).set("Method", method);
    try {
      solver::newton_options(deck);
      ADD_FAILURE() << method;
    } catch (const Error &error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      for (const char *const part : {list, method, usable})
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  for (const char *const method : {"Broyden", "Steepest Descent", "NonlinearCG", "User Defined", "newton"})
    refused("Direction", method, "Active Set, Sweep, Newton");
  for (const char *const method : {"Safeguarded Step", "User Defined"})
    refused("Line Search", method, "Backtrack, Polynomial");
}

TEST(Rise, IsTheIntegralOfTheSlope)
{
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Line line(1 + seed % 5, seed);
    const auto model = line.model(-0.01 * (seed + 1), 2);
    constexpr int parts = 20000;
    double sum = 0, most = 0;
    for (int k = 0; k < parts; ++k) {
      const double slope = model->at((k + 0.5) / parts).slope;
      sum += slope / parts;
      most += std::abs(slope) / parts;
    }
    EXPECT_NEAR(solver::rise(*model, 0, 1), sum, 5e-4 * most) << seed;
  }
  EXPECT_NEAR(solver::rise(*Line(0, 0).model(-3, 3), 0, 0.5), -3 * 0.5 + 3 * 0.125, 1e-15);
}

TEST(Newton, FunctionalFallsAtEveryExactStep)
{
  Beam beam;
  double previous = beam.iterate->value(*beam.u);
  solver::NewtonOptions options;
  options.max_iterations = 1;
  for (int k = 0; k < 12; ++k) {
    minimize(beam, options);
    const double now = beam.iterate->value(*beam.u);
    EXPECT_LE(now, previous + 1e-13 * std::abs(previous)) << k;
    previous = now;
  }
  Vector F(beam.u->getMap());
  beam.iterate->gradient(*beam.u, F);
  EXPECT_LT(F.norm2(), 1e-10 * beam.iterate->force_scale());
}

/// A beam, pressed on bumps that are rigid at some points and give way at others: kinks lie close to each other.
contact::ContactOptions bumps()
{
  const ScalarField xi("xi", [](const Point &x) { return 25 * (1 + 0.9 * std::sin(9 + 12 * x[0])); });
  const ScalarField gap("gap",
                        [](const Point &x) { return x[0] == 0 || x[0] == 5 ? 0 : 0.01 * std::sin(11.7 + 11 * x[0]); });
  return below(xi, 0, gap);
}

TEST(Newton, SweepsTakeItPastTheKinks)
{
  Beam with({}, bumps()), without({}, bumps());
  solver::NewtonOptions plain;
  plain.nox.sublist("Direction").set("Method", "Newton");
  const auto swept = minimize(with);
  const auto crept = minimize(without, plain);
  EXPECT_TRUE(swept.converged) << swept.reason;
  EXPECT_LE(swept.steps, 15);
  EXPECT_GE(crept.steps, 2 * swept.steps);
  const double value = without.iterate->value(*without.u);
  EXPECT_LE(with.iterate->value(*with.u), value + 1e-10 * std::abs(value));
}

TEST(Newton, SaysWhyItFailed)
{
  solver::LinearSolverOptions weak;
  weak.max_iterations = 1;
  weak.multigrid = "algebraic"; // no sparse factor stands in
  Beam beam(weak);
  solver::NewtonOptions options;
  options.max_iterations = 2;
  const auto result = minimize(beam, options);
  EXPECT_FALSE(result.converged);
  EXPECT_NE(result.reason.find("linear solver"), std::string::npos) << result.reason;
}

/// |H x - load| / |load|
double residual_of(const Beam &beam, const Vector &x)
{
  const Vector &load = *beam.elastic.load;
  Vector r(x.getMap());
  beam.iterate->hessian()->apply(x, r);
  r.update(-1., load, 1.);
  return r.norm2() / load.norm2();
}

TEST(LinearSolver, FollowsChangesOfAFewNodesWithoutASetUp)
{
  Beam beam;
  Vector x(beam.u->getMap());
  const Vector &load = *beam.elastic.load;
  open_between(beam, 2, 2.01);
  const int fresh = beam.linear->solve(load, x, 1e-8).iterations;
  EXPECT_LT(residual_of(beam, x), 1.01e-8);
  EXPECT_TRUE(beam.linear->solve(load, x, 1e-8).converged);
  EXPECT_EQ(beam.linear->counts().preconditioner_setups, 1);
  EXPECT_EQ(beam.linear->counts().local_corrections, 0);
  for (const double to : {2.1, 2.5, 2.2}) { // 1, 7, 3 nodes open that closed in the matrix
    open_between(beam, 2, to);
    const auto result = beam.linear->solve(load, x, 1e-8);
    EXPECT_TRUE(result.converged);
    EXPECT_LE(result.iterations, fresh + 3) << to;
    EXPECT_LT(residual_of(beam, x), 1.01e-8);
  }
  EXPECT_EQ(beam.linear->counts().preconditioner_setups, 1);
  EXPECT_EQ(beam.linear->counts().local_corrections, 3);
}

TEST(LinearSolver, FollowsAllStatesWithAHierarchyOfOthers)
{
  solver::LinearSolverOptions options;
  options.multigrid = "algebraic"; // a GPU's iterations take so long that a sparse factor of the host's would take over
  Beam beam(options);
  Vector x(beam.u->getMap());
  const Vector &load = *beam.elastic.load;
  open_between(beam, 0.01, 4.99);
  const int open = beam.linear->solve(load, x, 1e-8).iterations;
  for (const double to : {2.01, 2., 4.99, 2.}) { // multigrid was made for a side that moves freely
    open_between(beam, to == 2.01 ? 2 : 0.01, to);
    const auto result = beam.linear->solve(load, x, 1e-8);
    EXPECT_TRUE(result.converged);
    EXPECT_LE(result.iterations, 3 * open);
    EXPECT_LT(residual_of(beam, x), 1.01e-8);
  }
  EXPECT_LE(beam.linear->counts().preconditioner_setups, 2) << solver::solver_path(beam.linear->counts());
}

TEST(LinearSolver, InverseEnergyIsThatOfASolveUpToOneMultigridCycle)
{
  Beam beam;
  const Vector &F = *beam.elastic.load;
  Vector x(F.getMap()), zero(F.getMap());
  EXPECT_EQ(beam.linear->inverse_energy(zero), 0);
  EXPECT_TRUE(beam.linear->solve(F, x, 1e-8).converged);
  const double exact = F.dot(x), estimate = beam.linear->inverse_energy(F);
  EXPECT_GT(estimate, 0.5 * exact);
  EXPECT_LT(estimate, 1.5 * exact);
  Vector tenfold(F, Teuchos::Copy);
  tenfold.scale(-10.);
  EXPECT_NEAR(beam.linear->inverse_energy(tenfold), 100 * estimate, 1e-10 * 100 * estimate);
}

TEST(LinearSolver, StopsEarlyWhereLessAccuracyIsAskedFor)
{
  Beam beam;
  Vector x(beam.u->getMap());
  const int fine = beam.linear->solve(*beam.elastic.load, x, 1e-11).iterations;
  const int coarse = beam.linear->solve(*beam.elastic.load, x, 1e-2).iterations;
  EXPECT_LT(coarse, fine);
  EXPECT_EQ(beam.linear->solve(*beam.elastic.load, x, 1e-30).iterations, fine); // bounded by the options
}

} // namespace
} // namespace newton_test
