// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/run.hpp"
#include "rpc/core/interrupt.hpp"

#include <Tpetra_Core.hpp>
#include <csignal>
#include <gtest/gtest.h>

// Alone in its program: a run that has been asked to stop is so for ever.

namespace interrupted_steps_test
{
namespace
{

using namespace rpc;

/// A signal that comes when the last step has been solved stops nothing: the run has all its results, and the checkpoint that is due.
TEST(InterruptedSteps, ACheckpointThatIsDueAfterTheLastStepIsKept)
{
  install_interrupt_handlers();
  const auto comm = Tpetra::getDefaultComm();
  analysis::Task task;
  mesh::BoxOptions box;
  box.lower = {0, 0};
  box.upper = {2, 1};
  box.cells = {4, 2};
  task.mesh = box;
  task.model.materials = fem::Material{2000, 0.3};
  const ScalarField down("down", [](const Point &, const double t) { return -0.01 * t; });
  task.model.dirichlet = {{"top", "top", {ScalarField(0.), down, std::nullopt}}};
  contact::ContactOptions foundation;
  foundation.side = "bottom";
  foundation.yield_stress = ScalarField(14.);
  task.model.contact = {foundation};
  task.steps.times = {1, 2};
  task.steps.checkpoint_every = 2;
  std::vector<double> kept;
  analysis::Listener listener;
  listener.load_step = [&](analysis::Solution &s) {
    if (s.time == 2 && comm->getRank() == comm->getSize() - 1) std::raise(SIGTERM);
  };
  listener.checkpoint = [&](const analysis::HistoryState &state) { kept.push_back(state.last.time); };
  const auto s = analysis::solve(task, comm, listener);
  EXPECT_TRUE(interrupted(*comm));
  EXPECT_TRUE(s.uzawa.converged);
  EXPECT_FALSE(s.failure);
  EXPECT_EQ(kept, std::vector<double>{2});
}

} // namespace
} // namespace interrupted_steps_test
