// SPDX-License-Identifier: BSD-3-Clause
/// What the steps of a load history cost, and what becomes of those that fail.
#include "load_scenes.hpp"

#include <cmath>
#include <memory>
#include <vector>

namespace step_parts_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using analysis::LoadHistory;
using analysis::Problem;
using analysis::StepSolution;

TEST(LoadHistory, OneSetUpServesAllStepsAndABoxNeedsNoMatrix)
{
  solver::LinearSolverOptions linear;
  linear.multigrid = "mesh"; // follows contact states in place
  LoadHistory history(std::make_shared<Problem>(block(4), uneven(laws[1], to_and_fro), 0.5), {}, 0, linear);
  advance(history, 0.5);
  EXPECT_GT(history.last().linear_iterations, 0);
  EXPECT_EQ(history.last().preconditioner_setups, 1);
  for (const double t : {1., 1.5, 2., 3., 4.}) {
    advance(history, t);
    EXPECT_EQ(history.last().preconditioner_setups, 0) << t;
    EXPECT_GT(history.last().linear_solves, 0) << t;
    EXPECT_EQ(history.last().parts, 1) << t;
  }
  EXPECT_EQ(history.problem().stiffness()->assemblies(), 0);
}

/// A strip that bends far: rounding leaves more than Newton's tolerance at any origin, and what the energies ask for takes one step from the
/// next one.
TEST(LoadHistory, RoundingTakesOneStepOfEachLaterIteration)
{
  const mesh::BoxOptions box{{0, 0}, {1, 1.5e-3}, {3000, 2}, {2, 1, mesh::Shape::simplex}};
  const auto strip = std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
  analysis::Model model;
  model.materials = fem::Material{young, poisson};
  model.tractions.push_back({"top", "top", {ScalarField(0.), ScalarField(-1e-9)}});
  model.dirichlet = {prescribed("left", ScalarField(0.), ScalarField(0.))};
  LoadHistory history(std::make_shared<Problem>(strip, model, 1), {}, 0);
  const auto s = advance(history, 1);
  ASSERT_GT(s.uzawa.newton_iterations.size(), 1u);
  for (std::size_t k = 1; k < s.uzawa.newton_iterations.size(); ++k) EXPECT_EQ(s.uzawa.newton_iterations[k], 1) << k;
  EXPECT_EQ(s.line_search_steps, 0);
}

/// Options that give up early.
analysis::StepOptions impatient(const int newton)
{
  analysis::StepOptions options;
  options.prediction.enabled = false;
  options.newton.max_iterations = newton;
  options.uzawa.max_iterations = 1;
  return options;
}

/// Up to t = 1 in one stroke, where many points change their states.
analysis::Model stroke()
{
  auto model = uneven(laws[0], ramp);
  model.contact[0].gap = in_time([](const Point &x, double) { return 0.03 * x[0] * (2 - x[0]); });
  return model;
}

/// The least number of iterations with which the stroke is solved at once.
int iterations_needed()
{
  for (int newton = 1; newton < 30; ++newton) {
    auto history = history_of(stroke(), impatient(newton), 0, 1, 2);
    if (history.advance(1).uzawa.converged) return newton;
  }
  return 30;
}

TEST(LoadHistory, AStepThatDoesNotConvergeIsHalvedAsOftenAsAllowed)
{
  const int needed = iterations_needed();
  ASSERT_GT(needed, 2);
  ASSERT_LT(needed, 30);
  auto patient = history_of(stroke(), impatient(needed), 6, 1, 2);
  advance(patient, 1);
  EXPECT_EQ(patient.last().parts, 1);

  auto halved = history_of(stroke(), impatient(needed - 1), 8, 1, 2);
  std::vector<double> parts;
  const StepSolution s =
      halved.advance(1, {}, [&](const Problem &, const analysis::Step &step) { parts.push_back(step.time); });
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_EQ(halved.last().parts, static_cast<int>(parts.size()));
  ASSERT_GE(parts.size(), 3u);
  EXPECT_EQ(parts[0], 1);
  EXPECT_EQ(parts[1], 0.5);
  EXPECT_EQ(parts.back(), 1);
  EXPECT_EQ(halved.memory()->time, 1);
  EXPECT_EQ(halved.last().time, 1);
  EXPECT_TRUE(halved.last().converged);
  EXPECT_GT(halved.last().linear_solves, needed - 1); // those of all parts
  EXPECT_NEAR(halved.last().contact.force[1], patient.last().contact.force[1], 1e-6 * patient.last().contact.force[1]);
}

TEST(LoadHistory, ADividedStepHasTheSlipAndTheWorkOfFrictionOfAllItsParts)
{
  analysis::Model model = stroke();
  model.contact[0].friction_coefficient = ScalarField(0.3);
  analysis::StepsOptions steps;
  steps.energy_tolerance = 0.02;
  auto divided = history_of(model, close(), 0, 1, 2);
  divided.balance_energies(steps);
  std::vector<double> times; // of the parts before the last one
  analysis::Progress progress;
  progress.part = [&](const Problem &, const StepSolution &part) {
    if (!times.empty() && part.step.time <= times.back()) times.clear(); // as if it had not been tried
    times.push_back(part.step.time);
  };
  const StepSolution s = divided.advance(1, progress);
  ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  ASSERT_FALSE(times.empty());

  times.push_back(1);
  auto single = history_of(model, close(), 0, 1, 2);
  double work = 0, largest = 0, slips = 0;
  for (const double t : times) {
    advance(single, t);
    const auto &part = single.last().contact;
    work += part.friction_work;
    largest = std::max(largest, part.max_slip);
    slips += part.max_slip;
  }
  const auto &whole = divided.last().contact;
  EXPECT_GT(work, 1.05 * single.last().contact.friction_work);
  EXPECT_NEAR(whole.friction_work / work, 1, 1e-6);
  EXPECT_GT(whole.max_slip, 1.05 * largest);
  EXPECT_LE(whole.max_slip, slips * (1 + 1e-6));
  EXPECT_EQ(whole.friction_work, s.contact.total.friction_work);
  EXPECT_EQ(whole.max_slip, s.contact.sides[0].max_slip);
}

TEST(LoadHistory, AStepThatFailsIsNotRemembered)
{
  const int needed = iterations_needed();
  ASSERT_GT(needed, 2);
  auto history = history_of(stroke(), impatient(needed - 1), 0, 1, 2);
  EXPECT_FALSE(history.advance(1).uzawa.converged);
  EXPECT_EQ(history.memory(), nullptr);
  EXPECT_FALSE(history.last().converged);
  EXPECT_EQ(history.last().parts, 1);
  EXPECT_TRUE(std::isnan(history.last().energies.work));

  // From a state in between it fails again at a stroke that is twice as long, and that state stays.
  auto further = history_of(stroke(), impatient(needed - 1), 0, 1, 2);
  double begun = 0;
  for (double t = 0.5; t > 1e-3 && begun == 0; t /= 2)
    if (further.advance(t).uzawa.converged) begun = t;
  ASSERT_GT(begun, 0);
  const auto dent = further.memory()->dent;
  const auto energies = further.memory()->energies;
  double failed = 2 * begun;
  while (failed < 1e3 && further.advance(failed).uzawa.converged) failed *= 4;
  if (failed < 1e3) {
    EXPECT_LT(further.memory()->time, failed);
    EXPECT_FALSE(further.last().converged);
    if (further.memory()->time == begun) {
      EXPECT_EQ(further.memory()->dent, dent);
      EXPECT_EQ(further.memory()->energies.work, energies.work);
      EXPECT_EQ(further.last().energies.work, energies.work);
    }
  }
}

} // namespace
} // namespace step_parts_test
