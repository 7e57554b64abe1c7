// SPDX-License-Identifier: BSD-3-Clause
#include "expect_error.hpp"
#include "run_scene.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

// Refined meshes of .geo files, from deck to result.

namespace refinement_test
{
namespace
{

using namespace rpc;

const std::string decks = std::string(RPC_TEST_DECKS) + "/", input = decks + "../../../input/";

Solution solved(const std::string &deck, const int refinements, std::vector<std::string> more)
{
  more.push_back("Mesh->Refinements=" + std::to_string(refinements));
  Solution s = run_scene(deck, more);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  return s;
}

int most_iterations(const Solution &s)
{
  return *std::max_element(s.linear.iterations.begin(), s.linear.iterations.end());
}

/// Lamé: u(a) = (1 + nu)/E a^2/(b^2 - a^2) ((1 - 2 nu) a + b^2/a); the energy of a quarter is -p u(a) pi a/4.
TEST(Refinement, EnergyOfLamesRingConvergesAtTheElementsOrder)
{
  const double moved = 1.3 / 1000 / 3 * (0.4 + 4), exact = -moved * M_PI / 4;
  for (const std::string more : {"", "quadrilaterals"})
    for (const int order : {1, 2}) {
      SCOPED_TRACE("order " + std::to_string(order) + " " + more);
      std::vector<std::string> assignments = {"Mesh->Order=" + std::to_string(order)};
      if (!more.empty()) assignments.push_back("Mesh->File=ring_quadrilaterals.geo");
      double last = 0;
      for (const int times : {1, 2, 3}) {
        const Solution s = solved(decks + "ring.xml", times, assignments);
        const double error = std::abs(s.energy / exact - 1);
        if (times > 1) {
          EXPECT_NEAR(std::log2(last / error), 2 * order, 0.4) << times;
        }
        last = error;
      }
      EXPECT_LT(last, order == 1 ? 2e-3 : 2e-6);
    }
}

/// Iterations and steps of contact do not grow, and one set-up serves all states.
TEST(Refinement, HalfCylinderTakesAsMuchWorkOnEachMesh)
{
  for (const int times : {1, 2, 3}) {
    const Solution s = solved(input + "hertz.xml", times, {"Mesh->Size Factor=6"});
    EXPECT_LE(most_iterations(s), 16) << times;
    EXPECT_EQ(s.linear.preconditioner_setups, 1) << times;
    EXPECT_EQ(s.not_predicted, "") << times;
    EXPECT_EQ(s.levels.size(), times < 3 ? 1u : 2u) << times; // predicted on parents alone
    if (times == 3) {
      EXPECT_NEAR(s.contact.total.force[1], 110.028, 0.001 * 110.028);
      EXPECT_NEAR(s.contact.total.max_pressure, 98.34, 0.001 * 98.34);
    }
  }
}

/// The force is that of a mesh which gmsh makes as fine.
TEST(Refinement, BallMeetsGmshsMesh)
{
  const Solution refined = solved(input + "ball.xml", 1, {"Mesh->Size Factor=3"});
  const Solution made = solved(input + "ball.xml", 0, {"Mesh->Size Factor=1.5"});
  EXPECT_NEAR(refined.contact.total.force[2], made.contact.total.force[2], 0.002 * made.contact.total.force[2]);
  EXPECT_NEAR(refined.energy, made.energy, 0.002 * std::abs(made.energy));
  EXPECT_LE(most_iterations(refined), 15);
}

/// gmsh makes the same mesh for each size factor: nested iteration sees that, and has parents where the mesh is refined.
TEST(Refinement, NestedIterationLeavesMeshesThatAreNotSmaller)
{
  const Solution same = solved(decks + "transfinite.xml", 0, {});
  EXPECT_EQ(same.not_predicted, "there is no coarser mesh of this body");
  EXPECT_TRUE(same.levels.empty());
  const Solution refined = solved(decks + "transfinite.xml", 1, {});
  EXPECT_EQ(refined.not_predicted, "");
  ASSERT_EQ(refined.levels.size(), 1u);
  EXPECT_EQ(refined.levels[0].dofs, same.discretization.owned_dofs->getGlobalNumElements());
}

TEST(Refinement, IsRefusedWhereItMakesNoSense)
{
  const auto refuse = [](const std::string &deck, const std::vector<std::string> &more, const std::string &part) {
    test::expect_error(ExitCode::bad_input, part, [&] { run_scene(deck, more); });
  };
  refuse(input + "beam.xml", {"Mesh->Refinements=1"}, "\"Mesh->Refinements\" does not go with \"Mesh->Type\" = box");
  refuse(input + "hertz.xml", {"Mesh->Refinements=-1"}, "\"Mesh->Refinements\" must be 0 to 12, got -1");
}

} // namespace
} // namespace refinement_test
