// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/between_nodes.hpp"
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Contact that the nodes of the first mesh do not see: a run says so, and adaptive ones find it.

namespace unseen_contact_test
{
namespace
{

using namespace rpc;

const std::string decks = std::string(RPC_TEST_DECKS) + "/", input = decks + "../../../input/";

/// Of the circle below the block, by uniform meshes: P2 of 256 x 256 cells 3.58596, Q1 of 512 x 512 3.58614.
constexpr double circle_force = 3.5860;

/// How far the force along an axis is from the right one, in error bars.
double bars_off(const Solution &s, const int axis, const double right)
{
  return std::abs(s.contact.total.force[axis] - right) / s.adaptation->errors.contact_force;
}

TEST(UnseenContact, AMeshWhoseNodesMissTheObstacleSaysSo)
{
  for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
    SCOPED_TRACE(element);
    const Scene scene = read_scene(decks + "unseen_circle.xml", {"Mesh->Element=" + element, "Mesh->Cells={3, 3}"});
    const Solution s = run_scene(decks + "unseen_circle.xml",
                                 {"Mesh->Element=" + element, "Mesh->Cells={2, 2}", "Adapt->Estimate Error=true"});
    ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    EXPECT_EQ(s.contact.total.force[1], 0);
    EXPECT_EQ(adapt::errors_of(scene, s).unknown.at("energy_J"), adapt::unseen_by_mesh);
    EXPECT_NEAR(s.contact.total.unseen_penetration, 0.01, 1e-5);
    EXPECT_NE(contact::unseen_contact_note(s.contact, scene.model.contact, 2, s.energy_norm_squared), "");
  }
}

TEST(UnseenContact, AHeldNodeThatIsClearOfTheFoundationSeesNothing)
{
  for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
    SCOPED_TRACE(element);
    const Solution s = run_scene(decks + "unseen_circle.xml", {"Mesh->Element=" + element, "Mesh->Cells={2, 2}",
                                                               "Dirichlet->left->X=0", "Dirichlet->left->Y=0"});
    EXPECT_NEAR(s.contact.total.unseen_penetration, 0.01, 1e-5);
  }
}

TEST(UnseenContact, AdaptiveMeshesFindItWhoeverMakesThem)
{
  for (const std::string way : {"P1,gmsh", "P2,gmsh", "P2,nested"}) {
    SCOPED_TRACE(way);
    const Solution s =
        run_scene(decks + "unseen_circle.xml", {"Mesh->Element=" + way.substr(0, 2), "Adapt->Meshes=" + way.substr(3),
                                                "Adapt->Target Relative Error=0.04"});
    ASSERT_TRUE(s.adaptation->reached) << s.adaptation->reason;
    EXPECT_EQ(s.adaptation->cycles.front().contact.force[1], 0);
    EXPECT_EQ(s.adaptation->cycles.front().estimate, 1); // all of the displacement is missing
    EXPECT_LT(bars_off(s, 1, circle_force), 1);
    EXPECT_NEAR(s.contact.total.force[1] / circle_force, 1, 0.01);
  }
}

TEST(UnseenContact, ABallOfRevolutionThatBarelyTouchesHasTheForceThatAFinerFirstMeshGives)
{
  // 0.033221 from first meshes that see contact at once (Refinements = 5, or Size Factor = 0.1, to 0.2 %). Hertz on a half space: 0.0328.
  const Solution s = run_scene(input + "ball_axisymmetric_adaptive.xml", {"Dirichlet->top->Y=-0.0005"});
  ASSERT_TRUE(s.adaptation->reached) << s.adaptation->reason;
  EXPECT_EQ(s.adaptation->cycles.front().contact.force[1], 0);
  EXPECT_NEAR(s.contact.total.force[1], 0.033221, 3e-5);
}

TEST(UnseenContact, ABumpOfAThousandthOfTheSideIsFound)
{
  const std::vector<std::string> bump{"Contact->Obstacle->Type=none",
                                      "Contact->Gap=0.001 - 0.002*exp(-((x - 0.61)/0.0005)^2)"};
  const Solution s = run_scene(decks + "unseen_circle.xml", bump);
  EXPECT_NEAR(s.contact.total.unseen_penetration, 0.001, 1e-4);
  EXPECT_NEAR(s.contact.between.unseen.place[0], 0.61, 0.001);
}

} // namespace
} // namespace unseen_contact_test
