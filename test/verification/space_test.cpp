// SPDX-License-Identifier: BSD-3-Clause
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Bodies in space: the ball of Hertz against an independent solution, and the block of input/ by all four elements.

namespace space_test
{
namespace
{

using namespace rpc;

const std::string input = std::string(RPC_TEST_DECKS) + "/../../../input/";

/// Of the whole half ball, by an axisymmetric program with quadratic triangles.
struct Reference {
  const char *yield_stress;
  double force, max_pressure, contact_radius, yielded_radius, energy, max_penetration;
};

TEST(Ball, IsThatOfAnAxisymmetricProgram)
{
  for (const Reference &reference : {Reference{"inf", 9.22776, 204.741, 0.146347, 0, 0.072412, 0},
                                     Reference{"100", 7.65925, 100, 0.157166, 0.154045, 0.0650233, 0.00702}}) {
    SCOPED_TRACE(reference.yield_stress);
    const Solution s = run_scene(input + "ball.xml", {std::string("Contact->Yield Stress=") + reference.yield_stress});
    ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    const auto &found = s.contact.total;
    const double pi = std::acos(-1.), quarter = 4;
    EXPECT_NEAR(quarter * found.force[2], reference.force, 2e-3 * reference.force);
    EXPECT_NEAR(found.max_pressure, reference.max_pressure, 1e-2 * reference.max_pressure);
    EXPECT_NEAR(quarter * found.contact_length, pi * std::pow(reference.contact_radius, 2),
                2e-2 * pi * std::pow(reference.contact_radius, 2));
    EXPECT_NEAR(quarter * found.yielded_length, pi * std::pow(reference.yielded_radius, 2),
                2e-2 * pi * std::pow(reference.yielded_radius, 2));
    EXPECT_NEAR(quarter * s.energy, reference.energy, 2e-3 * reference.energy);
    EXPECT_NEAR(found.max_penetration, reference.max_penetration, 1e-5);
    EXPECT_LT(s.discretization.owned_dofs->getGlobalNumElements(), 50000u);
    EXPECT_EQ(s.linear.preconditioner_setups, 1);
  }
}

struct Cells {
  const char *element, *coarse, *fine;
  double error; // relative, of the energy with the fine cells
};

TEST(Block, HasOneEnergyByAllElements)
{
  for (const Cells &cells : {Cells{"P1", "{8,8,4}", "{16,16,8}", 0.02}, Cells{"Q1", "{8,8,4}", "{16,16,8}", 0.01},
                             Cells{"P2", "{4,4,2}", "{8,8,4}", 0.01}, Cells{"Q2", "{4,4,2}", "{8,8,4}", 0.01}}) {
    SCOPED_TRACE(cells.element);
    const auto energy = [&](const char *number) {
      const Solution s = run_scene(
          input + "block.xml", {std::string("Mesh->Element=") + cells.element, std::string("Mesh->Cells=") + number});
      EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
      EXPECT_LE(s.line_search_steps, 0);
      return s.energy;
    };
    const double limit = -1.0385; // LIMIT
    const double coarse = energy(cells.coarse), fine = energy(cells.fine);
    EXPECT_LT(std::abs(fine - limit), cells.error * std::abs(limit)) << fine;
    EXPECT_LT(std::abs(fine - limit), 0.6 * std::abs(coarse - limit)) << coarse << " " << fine;
  }
}

TEST(Block, TakesFewStepsHoweverDeepTheFoundationLiesInIt)
{
  for (const char *gap : {"1e10*(x^2 + y^2 - 1)", "1e12*(x^2 + y^2 - 1)"}) { // its forces are as many times the load
    const Solution s = run_scene(
        input + "block.xml", {"Mesh->Cells={4,4,2}", "Contact->Yield Stress=inf", std::string("Contact->Gap=") + gap});
    EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    EXPECT_EQ(s.uzawa.newton_iterations.size(), 1u);
    EXPECT_LE(s.uzawa.newton_iterations.front(), 12) << gap; // 200 where rounding counted as progress
  }
}

/// The block in other axes and units; the first assignments are common.
Solution block(const std::string &element, std::vector<std::string> assignments)
{
  assignments.insert(assignments.begin(),
                     {"Mesh->Element=" + element, "Uzawa->Tolerance=1e-11", "NOX->Residual Tolerance=1e-12"});
  return run_scene(input + "block.xml", assignments);
}

TEST(Block, IsTheSameInOtherAxesAndUnits)
{
  for (const std::string element : {"P1", "Q1", "P2", "Q2"}) {
    SCOPED_TRACE(element);
    const Solution s = block(element, {"Mesh->Cells={8,8,4}"});
    const double force = s.contact.total.force[2];
    ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    EXPECT_GT(force, 1);
    // (x, y, z) becomes (z, x, y).
    const Solution turned = block(element, {"Mesh->Lower={0,-1,-1}", "Mesh->Upper={1,1,1}", "Mesh->Cells={4,8,8}",
                                            "Dirichlet->left->Side=bottom", "Traction->front->Side=right",
                                            "Traction->front->X=-20", "Traction->front->Z=0", "Contact->Side=left",
                                            "Contact->Yield Stress=18 + 9*y", "Contact->Gap=0.01*(y^2 + z^2)"});
    EXPECT_NEAR(turned.energy, s.energy, 1e-10 * std::abs(s.energy));
    EXPECT_NEAR(turned.contact.total.force[0], force, 1e-9 * force);
    EXPECT_NEAR(turned.contact.total.yielded_length, s.contact.total.yielded_length, 1e-12);
    // MPa for Pa.
    const Solution stiff = block(element, {"Mesh->Cells={8,8,4}", "Material->Young's Modulus=1e9",
                                           "Traction->front->Z=-2e7", "Contact->Yield Stress=1e6*(18 + 9*x)"});
    EXPECT_NEAR(stiff.energy, 1e6 * s.energy, 1e-4 * std::abs(s.energy));
    EXPECT_EQ(stiff.uzawa.newton_iterations, s.uzawa.newton_iterations);
  }
}

} // namespace
} // namespace space_test
