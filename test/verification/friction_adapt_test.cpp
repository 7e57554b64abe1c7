// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/error.hpp"
#include "run_scene.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

// Estimated errors and adaptive meshes with friction. Tresca's problem has the minimum J + friction_work, so that the true error of a
// mesh is 2 (J_h - J) of that sum, with J of a finer mesh.

namespace friction_adapt_test
{
namespace
{

using namespace rpc;

const std::string decks = RPC_TEST_DECKS;

Solution cantilever(std::vector<std::string> assignments)
{
  assignments.insert(assignments.end(), {"Contact->Friction Coefficient=0", "Contact->Friction Bound=15"});
  Solution s = run_scene(decks + "/friction_cantilever_coulomb.xml", assignments);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  return s;
}

/// What Tresca's problem minimizes.
double minimum(const Solution &s)
{
  return s.energy + s.contact.total.friction_work;
}

/// On 480 x 160 cells of Q2: above the infimum by a tenth of the smallest squared error judged here, at most.
double reference()
{
  static const double value = minimum(cantilever({"Mesh->Element=Q2", "Mesh->Cells={480,160}"}));
  return value;
}

double true_error(const Solution &s)
{
  return std::sqrt(2 * std::abs(minimum(s) - reference()) / s.energy_norm_squared);
}

TEST(EstimateWithFriction, IsTheErrorOnUniformMeshesOfAllElements)
{
  for (const std::string element : {"P1", "Q1", "P2", "Q2"}) {
    const std::string cells = element[1] == '1' ? "{96,32}" : "{48,16}";
    const Solution s = cantilever({"Mesh->Element=" + element, "Mesh->Cells=" + cells, "Adapt->Estimate Error=true"});
    const double effectivity = relative_estimate(s) / true_error(s);
    EXPECT_GT(effectivity, 0.8) << element;
    EXPECT_LT(effectivity, element[1] == '1' ? 1.5 : 2) << element; // corners hold most of the error of order 2
  }
}

TEST(AdaptWithFriction, ReachesTheErrorThatIsAskedForFasterThanUniformMeshes)
{
  const double target = 0.005;
  const Solution s =
      cantilever({"Mesh->Element=P2", "Mesh->Cells={24,8}", "Adapt->Target Relative Error=" + std::to_string(target)});
  ASSERT_TRUE(s.adaptation && s.adaptation->reached);
  EXPECT_LT(true_error(s), target);
  EXPECT_GT(s.contact.total.stick_length, 0.1);
  EXPECT_GT(s.contact.total.slip_length, 0.1);
  const Solution uniform = cantilever({"Mesh->Element=P2", "Mesh->Cells={96,32}"});
  EXPECT_LT(3 * s.discretization.owned_dofs->getGlobalNumElements(),
            uniform.discretization.owned_dofs->getGlobalNumElements());
  EXPECT_GT(true_error(uniform), target);
}

TEST(AdaptWithFriction, CoulombsForcesAreThoseOfAFineMeshWithinTheirErrorBars)
{
  const std::string deck = decks + "/friction_cantilever_coulomb.xml";
  const Solution s = run_scene(deck, {"Mesh->Element=P2", "Mesh->Cells={24,8}", "Adapt->Target Relative Error=0.004"});
  ASSERT_TRUE(s.adaptation && s.adaptation->reached);
  const Solution fine = run_scene(deck, {"Mesh->Element=Q2", "Mesh->Cells={384,128}"});
  double miss = 0;
  for (int k = 0; k < 2; ++k) miss = std::hypot(miss, s.contact.total.force[k] - fine.contact.total.force[k]);
  EXPECT_LT(miss, s.adaptation->errors.contact_force);
}

/// A block that is pressed, sheared and sheared back: slips, sticks after the turn, slips the other way.
Solution sheared(std::vector<std::string> assignments)
{
  assignments.insert(assignments.end(),
                     {"Steps->Times={1, 2, 2.5, 4}", "Contact->Yield Stress=inf", "Contact->Friction Coefficient=0.3"});
  Solution s = run_scene(decks + "/../../../input/shear.xml", assignments);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  return s;
}

TEST(AdaptWithFriction, StepsCarrySlipAndTractionToNewMeshes)
{
  const Solution adapted = sheared({"Mesh->Cells={16,8}", "Adapt->Target Relative Error=0.02"});
  const Solution fine = sheared({"Mesh->Element=Q2", "Mesh->Cells={128,64}"});
  ASSERT_EQ(adapted.history.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    SCOPED_TRACE(adapted.history[k].time);
    const auto &found = adapted.history[k], &expected = fine.history[k];
    const double size = expected.contact.force[1];
    for (int c = 0; c < 2; ++c) EXPECT_NEAR(found.contact.force[c], expected.contact.force[c], 0.005 * size);
    EXPECT_NEAR(found.energies.friction, expected.energies.friction, 0.01 * fine.history.back().energies.friction);
    EXPECT_NEAR(found.energies.imbalance, 0, 0.01 * expected.energies.largest());
  }
  EXPECT_LT(adapted.history[1].contact.force[0] * adapted.history[3].contact.force[0], 0); // sheared both ways
}

} // namespace
} // namespace friction_adapt_test
