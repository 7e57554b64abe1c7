// SPDX-License-Identifier: BSD-3-Clause
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Gaps that jump where nothing is reached: neither the solution nor its estimated error knows how far. doc/theory.md (3.5a), (10.4a)

namespace gap_jump_test
{
namespace
{

using namespace rpc;

const std::string decks = RPC_TEST_DECKS;

struct Body {
  std::string deck, kinematics;
};
const std::vector<Body> bodies = {
    {"/step_punch.xml", "plane strain"}, {"/step_punch.xml", "axisymmetric"}, {"/step_punch_space.xml", ""}};

Solution pressed_on(const Body &body, const std::string &element, const std::string &gap)
{
  std::vector<std::string> assignments = {"Mesh->Element=" + element, "Contact->Gap=" + gap};
  if (!body.kinematics.empty()) assignments.push_back("Kinematics=" + body.kinematics);
  Solution s = run_scene(decks + body.deck, assignments);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  return s;
}

TEST(GapJump, LeavesTheEstimateWhateverItsHeight)
{
  // The step alone, and one with a second step further out, between open nodes; a hole at the axis of a body of revolution.
  const std::vector<std::string> gaps = {"x < 0.65 ? 0 : ", "x < 0.4 ? 0 : x < 0.7 ? 0.02 : ", "x > 0.35 ? 0 : "};
  for (const Body &body : bodies)
    for (const std::string element : {"P1", "Q1", "P2", "Q2"})
      for (const std::string &gap : gaps) {
        SCOPED_TRACE(body.deck + " " + body.kinematics + " " + element + " " + gap);
        const Solution low = pressed_on(body, element, gap + "0.02");
        EXPECT_GT(low.estimate->total(), 0);
        for (const std::string height : {"1", "10"}) {
          const Solution high = pressed_on(body, element, gap + height);
          EXPECT_NEAR(high.energy / low.energy, 1, 1e-9);
          EXPECT_NEAR(high.estimate->total() / low.estimate->total(), 1, 1e-6) << height;
        }
      }
}

TEST(GapJump, HasAnEstimateLikeTheErrorInSpace)
{
  // Q2 on 20^3 cells has J = 0.04029, P2 0.04038.
  constexpr double exact = 0.0403;
  for (const std::string element : {"P2", "Q2"}) {
    const Solution s = pressed_on(bodies[2], element, "x < 0.65 ? 0 : 1");
    const double effectivity = relative_estimate(s) / std::sqrt(2 * (s.energy - exact) / s.energy_norm_squared);
    EXPECT_GT(effectivity, 0.7) << element;
    EXPECT_LT(effectivity, 1.5) << element;
  }
}

TEST(GapJump, LeavesVerticesWithoutWeightOpenThatLieClearOfIt)
{
  const Solution s = pressed_on(bodies[2], "P2", "x < 0.65 ? 0 : 1");
  const auto v = to_host(s.contact.penetration), p = to_host(s.contact.pressure);
  const auto weight = to_host(s.step.contact.weight);
  int clear = 0, borne = 0;
  for (std::size_t i = 0; i < p.extent(0); ++i) {
    if (weight(i) > 0) continue;
    if (v(i) < -0.5) {
      ++clear;
      EXPECT_EQ(p(i), 0);
    } else if (p(i) > 0) {
      ++borne; // in contact they have the pressure of their neighbours
    }
  }
  EXPECT_EQ(borne, 3 * 5);
  EXPECT_EQ(clear, 2 * 5);
}

} // namespace
} // namespace gap_jump_test
