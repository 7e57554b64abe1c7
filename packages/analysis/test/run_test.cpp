// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/run.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

namespace run_test
{
namespace
{

using namespace rpc;

/// A block of 2 m x 1 m that is pressed into a plastic foundation by a load that rises and falls.
analysis::Task block(const std::vector<double> &times)
{
  analysis::Task task;
  mesh::BoxOptions box;
  box.lower = {0, 0};
  box.upper = {2, 1};
  box.cells = {16, 8};
  task.mesh = box;
  task.model.materials = fem::Material{2000, 0.3};
  task.model.dirichlet = {{"left", "left", {ScalarField(0.), std::nullopt, std::nullopt}}};
  const ScalarField push("push", [](const Point &x, double t) { return -6 * t * (3 - t) * (1 + x[0]); });
  task.model.tractions = {{"top", "top", {ScalarField(0.), push, ScalarField(0.)}}};
  contact::ContactOptions foundation;
  foundation.side = "bottom";
  foundation.yield_stress = ScalarField(14.);
  foundation.hardening = ScalarField(200.);
  task.model.contact = {foundation};
  task.steps.times = times;
  return task;
}

double distance(const Vector &a, const Vector &b)
{
  Vector difference(a, Teuchos::Copy);
  difference.update(-1., b, 1.);
  return difference.normInf();
}

TEST(Run, EveryStepIsToldOnceItIsKnown)
{
  std::vector<std::string> told;
  analysis::Listener listener;
  listener.mesh = [&](const fem::Discretization &, const contact::ContactNodes &) { told.push_back("mesh"); };
  listener.solved = [&](const analysis::Problem &problem, analysis::Solution &s) {
    EXPECT_EQ(problem.discretization().mesh, s.discretization.mesh);
    told.push_back("solved");
    s.seconds.estimate += 1;
  };
  listener.load_step = [&](analysis::Solution &s) { told.push_back("step " + std::to_string(s.history.size())); };
  const auto s = analysis::solve(block({0.5, 1}), Tpetra::getDefaultComm(), listener);
  EXPECT_EQ(told, (std::vector<std::string>{"mesh", "solved", "step 1", "solved", "step 2"}));
  ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_EQ(s.time, 1);
  EXPECT_EQ(s.seconds.estimate, 2); // phases add up over the steps
  EXPECT_GT(s.contact.total.yielded_length, 0);
}

TEST(Run, GoesOnFromACheckpointAsIfItHadNotEnded)
{
  const auto comm = Tpetra::getDefaultComm();
  auto task = block({0.5, 1, 1.5, 2.5});
  task.steps.checkpoint_every = 2;
  std::optional<analysis::HistoryState> kept;
  analysis::Listener listener;
  listener.checkpoint = [&](const analysis::HistoryState &state) {
    if (!kept) kept = state;
  };
  const auto whole = analysis::solve(task, comm, listener);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->last.time, 1);
  int steps = 0;
  analysis::Listener again;
  again.resume = [&] { return kept; };
  again.load_step = [&](analysis::Solution &) { ++steps; };
  again.checkpoint = [](const analysis::HistoryState &) {};
  const auto resumed = analysis::solve(task, comm, again);
  EXPECT_EQ(steps, 2);
  ASSERT_TRUE(whole.uzawa.converged && resumed.uzawa.converged);
  EXPECT_GT(whole.u->normInf(), 0);
  EXPECT_EQ(distance(*whole.u, *resumed.u), 0);
  ASSERT_EQ(resumed.history.size(), whole.history.size());
  for (std::size_t k = 0; k < whole.history.size(); ++k) {
    for (const auto &q : analysis::energy_quantities)
      EXPECT_EQ(resumed.history[k].energies.*q.value, whole.history[k].energies.*q.value) << q.key;
    for (const auto &q : analysis::step_work)
      EXPECT_EQ(resumed.history[k].*q.value, whole.history[k].*q.value) << q.key;
  }
}

TEST(Run, PhasesAddUp)
{
  analysis::PhaseSeconds a, b;
  double value = 1;
  for (const auto &q : analysis::phase_seconds) b.*q.value = value++;
  a += b;
  a += b;
  for (const auto &q : analysis::phase_seconds) EXPECT_EQ(a.*q.value, 2 * (b.*q.value)) << q.key;
}

} // namespace
} // namespace run_test
