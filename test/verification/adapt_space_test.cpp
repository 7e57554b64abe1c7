// SPDX-License-Identifier: BSD-3-Clause
#include "adapt_space_scenes.hpp"
#include "expect_error.hpp"

// Adaptive meshes in space and of bodies of revolution, against each other and against independent values. adapt_space_long has more of them.

namespace adapt_space_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

TEST(AdaptiveBall, InSpaceHasTheForceThePressureAndTheRadiusThatWereAskedFor)
{
  expect_force_pressure_and_radius(balls[0]);
}

TEST(AdaptiveBall, OfRevolutionHasTheForceToFiveDigits)
{
  for (const Ball &ball : balls) {
    SCOPED_TRACE(std::string("moved by ") + ball.moved + ", xi = " + ball.yield_stress);
    const Solution s =
        run_scene(adaptive_deck("ball_axisymmetric_adaptive"),
                  {std::string("Dirichlet->top->Y=-") + ball.moved,
                   std::string("Contact->Yield Stress=") + ball.yield_stress, "Adapt->Target Relative Error=0.001"});
    ASSERT_TRUE(s.adaptation && s.adaptation->reached) << s.adaptation->reason;
    EXPECT_NEAR(s.contact.total.force[1] / ball.force, 1, 1e-5);
    EXPECT_LT(s.adaptation->cycles.back().dofs, 30000u);
  }
}

/// The coarser meshes are the levels of multigrid, down to the first one.
TEST(AdaptiveBall, OfNestedMeshesHasTheSameForceAndNoAlgebraicLevels)
{
  const Ball &ball = balls[0];
  const Solution s = run_scene(adaptive_deck("ball_adaptive"), {"Adapt->Meshes=nested"});
  ASSERT_TRUE(s.adaptation && s.adaptation->reached) << s.adaptation->reason;
  EXPECT_LT(s.adaptation->cycles.back().dofs, 200000u);
  expect_force_and_pressure(s, ball);
  EXPECT_NE(s.linear.description.find("meshes"), std::string::npos) << s.linear.description;
  EXPECT_EQ(s.linear.description.find("algebraic"), std::string::npos) << s.linear.description;
  EXPECT_EQ(s.linear.preconditioner_setups, 1);
  for (const int iterations : s.linear.iterations) EXPECT_LE(iterations, 18);
}

TEST(AdaptiveBlock, GradesItsClampedEdgesWithFewerUnknownsThanUniformMeshes)
{
  expect_fewer_unknowns_than_uniform_meshes("gmsh");
}

/// Hexahedra of a .msh cannot be halved to tetrahedra that fit: the first mesh is the result, and the reason says why.
TEST(AdaptiveMsh, OfHexahedraKeepsItsMeshAndSaysWhy)
{
  const Solution s = run_scene(std::string(RPC_TEST_DECKS) + "/octant_msh.xml",
                               {"Mesh->File=../../../packages/mesh/test/data/bricks_22.msh",
                                "Dirichlet->flat->Side=held", "Contact->Side=contact",
                                "Contact->Obstacle->Point={0, 0, 0.95}", "Contact->Obstacle->Normal={0, 0, -1}"});
  ASSERT_TRUE(s.adaptation);
  EXPECT_FALSE(s.adaptation->reached);
  EXPECT_EQ(s.adaptation->cycles.size(), 1u);
  EXPECT_NE(s.adaptation->reason.find("only triangles and tetrahedra are halved"), std::string::npos)
      << s.adaptation->reason;
  EXPECT_LT(s.contact.total.force[2], 0);
}

TEST(AdaptiveMsh, CannotBeMeshedAnew)
{
  test::expect_error(ExitCode::bad_input, {"Adapt->Meshes", "Its cells can be halved: nested"},
                     [] { run_scene(std::string(RPC_TEST_DECKS) + "/octant_msh.xml", {"Adapt->Meshes=gmsh"}); });
}

TEST(AdaptiveSteps, InSpaceKeepDentsAndDissipation)
{
  expect_dents_and_dissipation_to_stay("gmsh");
}

} // namespace
} // namespace adapt_space_test
