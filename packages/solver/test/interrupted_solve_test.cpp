// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/interrupt.hpp"
#include "supported_grid.hpp"

#include <csignal>
#include <gtest/gtest.h>

// Alone in its program: a run that has been asked to stop is so for ever.

namespace interrupted_solve_test
{
namespace
{

using namespace rpc;

/// While levels are made, in a solve's set-up, one rank is asked to stop: CG, which looks now and then, ends on all.
TEST(InterruptedSolve, IsAResultAndNobodyTakesOver)
{
  install_interrupt_handlers();
  const test::SupportedGrid body(40);
  solver::LinearSolverOptions options;
  options.multigrid = "mesh";
  const auto solver = body.solver(options, [&] {
    const auto comm = body.grid.map->getComm();
    if (comm->getRank() == comm->getSize() - 1) std::raise(SIGTERM);
    auto levels = body.levels();
    levels.level[0].stiffness->resumeFill();
    levels.level[0].stiffness->scale(30.); // as poor as no coarse level: CG takes more than a few iterations
    levels.level[0].stiffness->fillComplete();
    return levels;
  });
  const Vector b = body.grid.right_side();
  Vector x(b.getMap());
  for (int k = 0; k < 2; ++k) {
    const auto result = solver->solve(b, x, 1e-10);
    EXPECT_TRUE(result.interrupted);
    EXPECT_TRUE(result.broken);
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.reason, rpc::interruption());
  }
  EXPECT_TRUE(solver->counts().iterations.empty()) << "an interrupted solve does not count";
  EXPECT_EQ(solver->counts().fallback, "");
  EXPECT_EQ(solver_path(solver->counts()), "meshes");
}

} // namespace
} // namespace interrupted_solve_test
