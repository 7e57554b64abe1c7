// SPDX-License-Identifier: BSD-3-Clause
/// Choices of contact states by a coarser mesh, on thin bodies that a coarser mesh predicts.
#include "rpc/analysis/coarse_choice.hpp"

#include "rpc/analysis/active_set.hpp"
#include "rpc/analysis/load_history.hpp"
#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

namespace coarse_choice_test
{
namespace
{

using namespace rpc;
using analysis::FoundBy;
using analysis::Problem;

/// A thin plate, held at one side and pressed on a rough bump.
analysis::Model plate()
{
  analysis::Model model;
  model.materials = fem::Material{1000, 0.3};
  model.tractions.push_back({"top", "top", {ScalarField(0.), ScalarField(-1e-3), ScalarField(0.)}});
  model.dirichlet.push_back({"left", "left", {ScalarField(0.), ScalarField(0.), ScalarField(0.)}});
  contact::ContactOptions foundation;
  foundation.side = "bottom";
  foundation.yield_stress = ScalarField(0.02);
  foundation.gap = ScalarField("gap", [](const Point &x) {
    const double far = std::pow(x[0] - 0.6, 2) + std::pow(x[2] - 0.4, 2);
    return 1e-2 * (1 - std::exp(-far / 0.1)) + 2e-4 * std::sin(311 * x[0] + 173 * x[2]);
  });
  model.contact.push_back(foundation);
  return model;
}

std::shared_ptr<const Problem> problem(const std::vector<int> &cells)
{
  const mesh::BoxOptions box{{0, 0, 0}, {1, 0.03, 1}, cells, {3, 1}};
  return std::make_shared<Problem>(std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())),
                                   plate());
}

analysis::StepSolution solved(const std::shared_ptr<const Problem> &fine, const bool predicted)
{
  analysis::StepOptions options;
  options.prediction.enabled = predicted;
  const auto coarser = [](const Problem &finer, int) { return finer.coarser(4, 1); };
  analysis::LoadHistory history(fine, options, 0, {}, coarser);
  return history.solve(1, options, {}, {});
}

int steps(const analysis::StepSolution &s)
{
  return std::accumulate(s.uzawa.newton_iterations.begin(), s.uzawa.newton_iterations.end(), 0);
}

TEST(CoarseChoice, SettlesThinPlatesInFewerSteps)
{
  const auto fine = problem({40, 1, 40});
  const auto by_coarse = solved(fine, true), alone = solved(fine, false);
  ASSERT_TRUE(by_coarse.uzawa.converged) << by_coarse.uzawa.reason;
  ASSERT_TRUE(alone.uzawa.converged) << alone.uzawa.reason;
  EXPECT_EQ(by_coarse.found_by, FoundBy::coarse_choices);
  EXPECT_GT(by_coarse.coarse_choices, 0);
  EXPECT_EQ(by_coarse.line_search_steps, 0);
  EXPECT_EQ(alone.coarse_choices, 0);
  EXPECT_LT(steps(by_coarse), steps(alone));
  EXPECT_NEAR(by_coarse.energy, alone.energy, 1e-9 * std::abs(alone.energy)) << "the same solution";
}

} // namespace
} // namespace coarse_choice_test
