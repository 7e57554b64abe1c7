// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/solve_step.hpp"

#include "rpc/contact/energies.hpp"
#include "rpc/mesh/box.hpp"
#include "solved.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>

namespace problem_test
{
namespace
{

using namespace rpc;
using analysis::Problem;
using analysis::StepSolution;

ScalarField in_time(std::function<double(const Point &, double)> f)
{
  return ScalarField("test", std::move(f));
}

/// A block on a foundation: what presses it, where it is held, the gap and the yield stress all follow the time.
analysis::Model model()
{
  analysis::Model model;
  model.materials = fem::Material{100, 0.3};
  model.body_force[1] = in_time([](const Point &, const double t) { return -3 * t; });
  model.tractions.push_back(
      {"top",
       "top",
       {ScalarField(0.), in_time([](const Point &x, const double t) { return -6 * t * (1 + std::sin(x[0])); }),
        ScalarField(0.)}});
  model.dirichlet.push_back(
      {"left",
       "left",
       {in_time([](const Point &, const double t) { return 0.02 * t; }),
        in_time([](const Point &x, const double t) { return -0.03 * t * t * x[1]; }), std::nullopt}});
  contact::ContactOptions foundation;
  foundation.side = "bottom";
  foundation.gap = in_time([](const Point &x, const double t) { return 0.02 * x[0] * (1.5 - t); });
  foundation.yield_stress = in_time([](const Point &, const double t) { return 8 + 2 * t; });
  model.contact.push_back(foundation);
  return model;
}

std::shared_ptr<const mesh::Mesh> block()
{
  const mesh::BoxOptions box{{0, 0}, {2, 1}, {24, 12}, {2, 1}};
  return std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
}

void expect_equal(const StepSolution &a, const StepSolution &b)
{
  EXPECT_TRUE(a.uzawa.converged) << a.uzawa.reason;
  EXPECT_TRUE(b.uzawa.converged) << b.uzawa.reason;
  EXPECT_NEAR(a.energy, b.energy, 1e-9 * std::abs(b.energy));
  EXPECT_NEAR(a.energy_norm_squared, b.energy_norm_squared, 1e-8 * b.energy_norm_squared);
  EXPECT_NEAR(a.contact.total.force[1], b.contact.total.force[1], 1e-8 * b.contact.total.force[1]);
  EXPECT_NEAR(a.reactions[0][1], b.reactions[0][1], 1e-8 * std::abs(b.reactions[0][1]));
  Vector difference(*a.u, Teuchos::Copy);
  difference.update(-1., *b.u, 1.);
  EXPECT_LT(difference.norm2(), 1e-8 * b.u->norm2());
}

TEST(Problem, OfOneTimeGivesTheStepsOfAllOthers)
{
  const auto mesh = block();
  const Problem of_start(mesh, model(), 0.25);
  for (const double t : {1., 0.25, 0.6}) {
    const Problem of_its_own(mesh, model(), t);
    const auto step = of_start.step(t);
    EXPECT_EQ(step.time, t);
    const auto found = test::solved(of_start, step), expected = test::solved(of_its_own, of_its_own.step(t));
    expect_equal(found, expected);
    EXPECT_GT(found.contact.total.contact_length, 0);
  }
}

/// The first box with a fourth of the cells along the side that has most: others may have more cells than that.
TEST(Problem, OfStretchedCellsHasACoarserOneByItsLongestSide)
{
  const auto cells_of_coarser = [](const mesh::BoxOptions &box) {
    const auto mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
    return Problem(mesh, model()).coarser(4, 1)->discretization().mesh->box->cells;
  };
  EXPECT_EQ(cells_of_coarser({{0, 0}, {2, 1}, {64, 32}, {2, 1}}), (std::vector<int>{16, 8})) << "square cells";
  EXPECT_EQ(cells_of_coarser({{0, 0}, {1, 0.5}, {64, 96}, {2, 1}}), (std::vector<int>{32, 24})) << "cells 3 : 1";
}

TEST(Problem, OfASlenderBodyThatLiftsOffTakesFewSteps)
{
  // A strip on a roller, pressed near one end: the edges of its contact zone move by a node a step.
  analysis::Model strip;
  strip.materials = fem::Material{1000, -0.16};
  const auto push = [](const Point &x) { return -0.15 * std::exp(-std::pow((x[0] - 12.3) / 1.73, 2)); };
  strip.tractions.push_back({"top", "top", {ScalarField(0.), ScalarField("push", push), ScalarField(0.)}});
  strip.dirichlet.push_back({"left", "left", {ScalarField(0.), std::nullopt, std::nullopt}});
  contact::ContactOptions foundation;
  foundation.side = "bottom";
  foundation.yield_stress = ScalarField(2.77);
  strip.contact.push_back(foundation);
  const mesh::BoxOptions box{{0, 0}, {37.9, 1}, {54, 2}, {2, 1}};
  const auto mesh = std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
  const Problem problem(mesh, strip, 1);
  const auto steps_of = [](const analysis::StepSolution &found) {
    EXPECT_TRUE(found.uzawa.converged) << found.uzawa.reason;
    int steps = 0;
    for (const int n : found.uzawa.newton_iterations) steps += n;
    return steps;
  };
  const auto step = problem.step(1);
  const auto found = test::solved(problem, step);
  EXPECT_LE(steps_of(found), 30) << "Newton or the interior path takes over where the edges creep";
  analysis::StepOptions newton;
  newton.newton.nox.sublist("Direction").set("Method", "Newton");
  analysis::SolverState solver(problem);
  const auto by_newton = analysis::solve_step(problem, step, solver, newton);
  EXPECT_GT(by_newton.line_search_steps, 0);
  EXPECT_GT(steps_of(by_newton), 2 * steps_of(found));
  const auto force = [](const analysis::StepSolution &of) { return of.contact.total.force[1]; };
  EXPECT_NEAR(force(found), force(by_newton), 1e-8 * force(found)) << "both end at the same contact";
}

TEST(Problem, StepStartsFromTheStateOfTheOneBefore)
{
  const auto mesh = block();
  const Problem problem(mesh, model(), 0.9);
  analysis::SolverState solver(problem);
  const auto before = analysis::solve_step(problem, problem.step(0.9), solver, {});
  const auto step = problem.step(1);
  const auto warm = analysis::solve_step(problem, step, solver, {}, {{before.state}, {}}),
             cold = test::solved(problem, step);
  expect_equal(warm, cold);
  EXPECT_EQ(warm.linear.preconditioner_setups, 0) << "K is that of the step before";
  EXPECT_LE(warm.uzawa.newton_iterations[0], cold.uzawa.newton_iterations[0]);
}

TEST(SolveStep, ResultsAndResidualsAreOfTheDisplacementFromZero)
{
  // With a weak penalty Newton's minimizations take several multiplier updates, before each of which the origin moves.
  analysis::Model soft = model();
  for (auto &side : soft.contact) side.penalty = 300;
  analysis::StepOptions newton;
  newton.newton.nox.sublist("Direction").set("Method", "Newton");
  const Problem problem(block(), soft, 1);
  analysis::SolverState solver(problem);
  const auto step = problem.step(1);
  int reports = 0;
  analysis::Progress progress;
  progress.uzawa = [&](const analysis::UzawaResult &now) { EXPECT_EQ(now.iterations, ++reports); };
  const auto s = analysis::solve_step(problem, step, solver, newton, {}, progress);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_GT(reports, 1);
  EXPECT_EQ(s.u.get(), s.state.displacement.get());
  const contact::Iterate anew(step.elastic, step.contact, solver.hessian());
  const auto judged = contact::optimality_residuals(problem.discretization(), problem.model().materials, step.elastic,
                                                    step.contact, s.state, anew.force_scale(),
                                                    [&](const Vector &F) { return solver.linear().inverse_energy(F); });
  EXPECT_EQ(judged.kkt_residual, s.uzawa.residuals.kkt_residual);
  EXPECT_EQ(judged.energy_balance, s.uzawa.residuals.energy_balance);
  expect_equal(s, test::solved(Problem(block(), model(), 1), Problem(block(), model(), 1).step(1)));
}

TEST(SolveStep, ASolutionOutlivesItsProblem)
{
  std::optional<analysis::StepSolution> s;
  {
    const Problem problem(block(), model(), 1);
    s = test::solved(problem, problem.step(1));
  }
  const Problem again(block(), model(), 1);
  expect_equal(*s, test::solved(again, again.step(1)));
  EXPECT_GT(s->u->norm2(), 0);
  EXPECT_EQ(contact::contact_law_residual(s->step.contact, s->state), s->uzawa.residuals.kkt_residual);
}

TEST(SolverState, SolvesASecondRightSideWithAFrozenHessian)
{
  // z = H^-1 b for the active set that the step has ended on: what goal-oriented estimates and patch problems ask for.
  const Problem problem(block(), model(), 1);
  analysis::SolverState solver(problem);
  const auto s = analysis::solve_step(problem, problem.step(1), solver, {});
  ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  const int revision = solver.hessian()->revision(), setups = solver.linear().counts().preconditioner_setups;
  Vector b(*s.step.elastic.load, Teuchos::Copy), z(b.getMap()), Hz(b.getMap());
  fem::clear_prescribed(s.step.elastic.dirichlet, b);
  EXPECT_TRUE(solver.linear().solve(b, z, 1e-10).converged);
  solver.hessian()->apply(z, Hz);
  Hz.update(-1., b, 1.);
  EXPECT_LE(Hz.norm2(), 1e-9 * b.norm2());
  EXPECT_EQ(solver.hessian()->revision(), revision);
  EXPECT_EQ(solver.linear().counts().preconditioner_setups, setups);
}

TEST(Problem, WorkOfTheSupportsAndLoadsIsTheChangeOfEnergy)
{
  // u is linear in prescribed displacements where nothing touches: J is quadratic in them, for every one of the steps.
  analysis::Model apart = model();
  apart.contact[0].gap = ScalarField(10.);
  apart.tractions.clear();
  apart.body_force = {};
  apart.dirichlet[0].displacement = {in_time([](const Point &, const double t) { return 0.02 * t; }), ScalarField(0.),
                                     std::nullopt};
  apart.dirichlet.push_back({"right", "right", {ScalarField(0.), ScalarField(0.), std::nullopt}});
  const Problem problem(block(), apart, 1);
  const double one = test::solved(problem, problem.step(1)).energy,
               three = test::solved(problem, problem.step(3)).energy;
  EXPECT_GT(one, 0);
  EXPECT_NEAR(three, 9 * one, 1e-9 * three);
}

} // namespace
} // namespace problem_test
