// SPDX-License-Identifier: BSD-3-Clause
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Error bars where theory promises nothing: they hold the true value, or there is none. doc/theory.md (10.7), (10.8)

namespace error_bars_test
{
namespace
{

using namespace rpc;

const std::string decks = RPC_TEST_DECKS;

Solution adapted(const std::string &deck, const std::string &target, std::vector<std::string> assignments = {})
{
  assignments.push_back("Adapt->Target Relative Error=" + target);
  Solution s = run_scene(decks + deck, assignments);
  EXPECT_TRUE(s.adaptation && s.adaptation->reached) << s.adaptation->reason;
  return s;
}

TEST(ErrorBars, OfTheLargestPressureAreNoneAtATip)
{
  // Without friction Love's solution (1939) grows like a logarithm, with it like a power.
  for (const std::string friction : {"0", "0.3"})
    for (const std::string target : {"0.1", "0.05", "0.02", "0.005"}) {
      SCOPED_TRACE("friction " + friction + ", target " + target);
      const Solution s = adapted("/cone.xml", target, {"Contact->Friction Coefficient=" + friction});
      EXPECT_TRUE(std::isnan(s.adaptation->errors.max_pressure));
      EXPECT_FALSE(s.adaptation->errors.unknown.at("max_pressure").empty());
      if (friction == "0") {
        EXPECT_LT(std::abs(s.contact.total.force[1] - 10.03264), s.adaptation->errors.contact_force);
        EXPECT_LT(std::abs(s.energy - 0.1613634), s.adaptation->errors.energy);
      }
    }
}

TEST(ErrorBars, HoldTheForceWhereFrictionJumps)
{
  // P2 on 400 x 200 cells has (-9.26062, 47.942) and J = 0.5417424, meshes adapted to 0.0015 -9.25234 and 0.5416238.
  for (const std::string target : {"0.05", "0.02", "0.005"}) {
    SCOPED_TRACE(target);
    const Solution s = adapted("/friction_jump.xml", target);
    const auto &force = s.contact.total.force;
    const auto &errors = s.adaptation->errors;
    EXPECT_LT(std::hypot(force[0] + 9.257, force[1] - 47.942), errors.contact_force);
    EXPECT_LT(errors.contact_force, 2); // it is of use
    ASSERT_EQ(errors.reactions.size(), s.reactions.size());
    EXPECT_LT(std::hypot(s.reactions[0][0] - 9.257, s.reactions[0][1] + 47.942), errors.reactions[0]);
    EXPECT_LT(errors.reactions[0], 2);
    EXPECT_LT(std::abs(s.energy - 0.5417), errors.energy);
    EXPECT_TRUE(std::isnan(errors.max_pressure));
  }
}

TEST(ErrorBars, OfTheLargestPressureAreNoneWhereFrictionReachesAnEdge)
{
  const Solution with = adapted("/friction_jump.xml", "0.02", {"Contact->Friction Coefficient=0.3"});
  EXPECT_TRUE(std::isnan(with.adaptation->errors.max_pressure));
  EXPECT_NE(with.adaptation->errors.unknown.at("max_pressure").find("edge"), std::string::npos);
  EXPECT_FALSE(std::isnan(with.adaptation->errors.contact_force));
  const Solution without = adapted("/friction_jump.xml", "0.01", {"Contact->Friction Coefficient=0"});
  EXPECT_FALSE(std::isnan(without.adaptation->errors.max_pressure));
}

TEST(ErrorBars, HoldWhereContactEndsAtAJumpOfTheGapWithinAFacet)
{
  // The foundation yields up to the jump, at which the side lies deeper between its nodes than any of them: most of the estimate, on the last
  // mesh. A target of 0.005 on four times as many cells along each edge gives these forces and energies.
  const Solution s =
      adapted("/step_punch.xml", "0.03",
              {"Mesh->Upper={0.7589007936580883, 1}", "Mesh->Cells={8, 4}", "Mesh->Element=Q2",
               "Material->Poisson's Ratio=0.18737312762420377", "Dirichlet->top->Y=-0.030917123076504623",
               "Contact->Gap=x > 0.39159355656993095 ? 0 : 0.28", "Contact->Yield Stress=163.96885522174804"});
  EXPECT_GT(s.estimate->unseen(), 0.5 * s.estimate->total());
  const auto &errors = s.adaptation->errors;
  EXPECT_LT(std::abs(s.contact.total.force[1] - 15.55172), errors.contact_force);
  EXPECT_LT(errors.contact_force, 0.5);
  EXPECT_LT(std::abs(s.energy - 0.2419836), errors.energy);
  EXPECT_LT(std::abs(s.contact.total.max_penetration - 0.0033977), errors.max_penetration);
  EXPECT_LT(std::abs(s.contact.total.contact_length - 0.3673062), errors.contact_length);
}

TEST(ErrorBars, HoldEnergyAndPressureOfABodyWithReentrantCorners)
{
  // Adapted to 0.0015, 16 528 dofs.
  for (const std::string target : {"0.1", "0.05", "0.02", "0.005"}) {
    SCOPED_TRACE(target);
    const Solution s = adapted("/fork.xml", target);
    const auto &errors = s.adaptation->errors;
    EXPECT_LT(std::abs(s.energy - 0.4449352), errors.energy);
    EXPECT_LT(std::abs(s.contact.total.max_pressure - 47.09821), errors.max_pressure);
    EXPECT_LT(std::abs(s.contact.total.force[1] - 20.9387968), errors.contact_force);
    EXPECT_LT(errors.max_pressure, 0.1 * s.contact.total.max_pressure);
  }
}

} // namespace
} // namespace error_bars_test
