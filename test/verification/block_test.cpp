// SPDX-License-Identifier: BSD-3-Clause
#include "larger.hpp"
#include "run_scene.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace block_test
{
namespace
{

using namespace rpc;

const std::string block = std::string(RPC_TEST_DECKS) + "/block.xml";

/// Largest difference of a displacement field from an exact one, over this rank's nodes.
double largest_error(const Solution &s, const std::function<std::array<double, 2>(double, double)> &exact)
{
  const auto x = to_host(s.discretization.mesh->coords);
  const auto u = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  double worst = 0;
  for (LO n = 0; n < s.discretization.mesh->num_owned_nodes(); ++n)
    for (int c = 0; c < 2; ++c) worst = test::larger(worst, std::abs(u(2 * n + c, 0) - exact(x(n, 0), x(n, 1))[c]));
  return worst;
}

class Block : public testing::TestWithParam<const char *>
{
};
INSTANTIATE_TEST_SUITE_P(Elements, Block, testing::Values("P1", "Q1", "P2", "Q2"));

TEST_P(Block, BetweenRollersIsCompressedUniformlyToRounding)
{
  const double p = 4, E = 2000, nu = 0.3;
  const double modulus = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)); // confined: sigma_yy = modulus eps_yy
  for (const char *xi : {"10", "inf", "4+x", "1e6"}) {
    const Solution s =
        run_scene(block, {std::string("Mesh->Element=") + GetParam(), std::string("Contact->Yield Stress=") + xi});
    ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    const double scale = p / modulus;
    EXPECT_LT(largest_error(s,
                            [&](double, double y) {
                              return std::array<double, 2>{0, -p / modulus * y};
                            }),
              1e-12 * scale);
    EXPECT_NEAR(s.contact.total.max_pressure, p, 1e-12 * p) << xi;
    EXPECT_NEAR(s.contact.total.force[1], p, 1e-12 * p);
    EXPECT_NEAR(s.contact.total.force[0], 0, 1e-12 * p);
    EXPECT_NEAR(s.energy, -0.5 * p * p / modulus, 1e-12 * p * p / modulus);
    EXPECT_NEAR(s.energy_norm_squared, p * p / modulus, 1e-12 * p * p / modulus);
    EXPECT_NEAR(s.contact.total.contact_length, 1, 1e-12);
    EXPECT_LE(s.uzawa.iterations, 5);
  }
}

TEST_P(Block, FullyYieldedEqualsTheLinearProblemWithThatPressure)
{
  const std::vector<std::string> held = {std::string("Mesh->Element=") + GetParam(), "Dirichlet->left->Y=0",
                                         "Dirichlet->right->Y=0", "Traction->top->Y=-12", "Contact->Yield Stress=1.5"};
  const Solution contact = run_scene(block, held);
  ASSERT_TRUE(contact.uzawa.converged) << contact.uzawa.reason;
  EXPECT_NEAR(contact.contact.total.yielded_length, 1, 1e-12);
  EXPECT_NEAR(contact.contact.total.force[1], 1.5, 1e-12);
  EXPECT_EQ(contact.uzawa.iterations, 1);

  auto linear_case = held;
  linear_case.insert(linear_case.end(), {"Contact->Side=", "Traction->bottom->Y=1.5"});
  const Solution linear = run_scene(block, linear_case);
  ASSERT_TRUE(linear.uzawa.converged) << linear.uzawa.reason;
  EXPECT_LE(linear.linear.iterations.size(), 2u);
  Vector difference(*contact.u, Teuchos::Copy);
  difference.update(-1., *linear.u, 1.);
  EXPECT_LT(difference.norm2(), 1e-12 * linear.u->norm2());
}

TEST_P(Block, LiftedOffItsFoundationIsFree)
{
  const Solution s = run_scene(block, {std::string("Mesh->Element=") + GetParam(), "Dirichlet->top->Y=0.01",
                                       "Traction->top->Y=0", "Contact->Gap=-0.005"});
  ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_EQ(s.contact.total.max_pressure, 0);
  EXPECT_EQ(s.contact.total.contact_length, 0);
  EXPECT_NEAR(s.contact.total.max_initial_penetration, 0.005, 1e-15);
  EXPECT_LT(largest_error(s, [](double, double) { return std::array<double, 2>{0, 0.01}; }), 1e-13);
}

TEST_P(Block, PushedDownByAPrescribedDisplacementYieldsAtItsLimit)
{
  const double nu = 0.3, modulus = 2000 * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  // Top moved by -delta. Below the limit the foundation holds; beyond, the block keeps the stress xi and sinks in by
  // the rest.
  for (const double delta : {0.002, 0.01}) {
    const Solution s = run_scene(block, {std::string("Mesh->Element=") + GetParam(),
                                         "Dirichlet->top->Y=" + std::to_string(-delta), "Traction->top->Y=0"});
    ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    const double p = std::min(10., modulus * delta), sunk = delta - p / modulus;
    EXPECT_NEAR(s.contact.total.max_pressure, p, 1e-11 * p);
    EXPECT_LT(largest_error(s,
                            [&](double, double y) {
                              return std::array<double, 2>{0, -sunk - p / modulus * y};
                            }),
              1e-12 * delta);
    EXPECT_NEAR(s.energy_norm_squared, p * p / modulus, 1e-11 * p * p / modulus);
    const auto top = std::find_if(s.reactions.begin(), s.reactions.end(), [](const auto &r) { return r[1] != 0; });
    ASSERT_NE(top, s.reactions.end());
    EXPECT_NEAR((*top)[1], -s.contact.total.force[1], 1e-12 * p);
    EXPECT_NEAR(s.energy, 0.5 * p * p / modulus + 10 * sunk, 1e-11 * 10 * delta); // J with xi v+ of the foundation
  }
}

TEST_P(Block, InACornerTouchesTwoFoundationsEachWithItsLaw)
{
  // u = (-a x, -b y) is exact; the corner's node belongs to both sides.
  const double lambda = 2000 * 0.3 / (1.3 * 0.4), mu = 2000 / 2.6, a = 0.001;
  for (const bool yields : {false, true}) {
    const double b = yields ? (1.5 - lambda * a) / (lambda + 2 * mu) : 0.003; // sigma_yy = -1.5
    const Solution s =
        run_scene(block, {std::string("Mesh->Element=") + GetParam(), "Traction->top->Y=0",
                          "Dirichlet->left->Side=right", "Dirichlet->left->X=-0.001", "Dirichlet->right->X=-0.001",
                          "Dirichlet->top->Y=-0.003", "Contact->Sides->left->Yield Stress=inf",
                          std::string("Contact->Yield Stress=") + (yields ? "1.5" : "inf")});
    ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    const double sunk = yields ? 0.003 - b : 0;
    EXPECT_LT(largest_error(s,
                            [&](double x, double y) {
                              return std::array<double, 2>{-a * x, -sunk - b * y};
                            }),
              1e-11 * a);
    const double p_left = lambda * (a + b) + 2 * mu * a, p_bottom = lambda * (a + b) + 2 * mu * b;
    ASSERT_EQ(s.contact.sides.size(), 2u);
    EXPECT_NEAR(s.contact.sides[0].force[1], p_bottom, 1e-10 * p_bottom);
    EXPECT_NEAR(s.contact.sides[0].yielded_length, yields ? 1 : 0, 1e-12);
    EXPECT_NEAR(s.contact.sides[1].force[0], p_left, 1e-10 * p_bottom);
    EXPECT_NEAR(s.contact.sides[1].max_pressure, p_left, 1e-10 * p_bottom);
    EXPECT_NEAR(s.contact.total.force[0], p_left, 1e-10 * p_bottom);
    EXPECT_NEAR(s.contact.total.force[1], p_bottom, 1e-10 * p_bottom);
  }
}

TEST(Block, ResultsDoNotSeeARigidShiftOfTheScene)
{
  const std::vector<std::string> scene = {"Traction->top->Y=0", "Contact->Yield Stress=1.5", "Uzawa->Tolerance=1e-8",
                                          "NOX->Residual Tolerance=1e-11"};
  auto here = scene, there = scene;
  here.insert(here.end(), {"Dirichlet->left->Y=-0.01*y", "Dirichlet->right->Y=-0.01*y"});
  there.insert(there.end(), {"Dirichlet->left->Y=-0.01*y-1", "Dirichlet->right->Y=-0.01*y-1", "Contact->Gap=1"});
  const Solution a = run_scene(block, here), b = run_scene(block, there);
  ASSERT_TRUE(a.uzawa.converged) << a.uzawa.reason;
  ASSERT_TRUE(b.uzawa.converged) << b.uzawa.reason;
  EXPECT_GT(a.contact.total.force[1], 0.1);
  EXPECT_NEAR(b.contact.total.force[1], a.contact.total.force[1], 1e-6 * a.contact.total.force[1]);
  EXPECT_NEAR(b.energy_norm_squared, a.energy_norm_squared, 1e-9 * a.energy_norm_squared);
}

TEST(Layers, OfTwoMaterialsAreCompressedEachByItsModulus)
{
  const double p = 4, nu = 0.3, factor = (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  const double stiff = 8000 * factor, soft = 2000 * factor;
  for (const char *file : {"layers.geo", "layers_quads.geo"})
    for (const char *order : {"1", "2"}) {
      const Solution s =
          run_scene(std::string(RPC_TEST_DECKS) + "/layers.xml",
                    {std::string("Mesh->File=") + file, std::string("Mesh->Order=") + order,
                     "Material->Blocks->stiff->Young's Modulus=8000", "Material->Blocks->stiff->Poisson's Ratio=0.3"});
      ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
      EXPECT_EQ(s.discretization.mesh->element.name(),
                std::string(file == std::string("layers.geo") ? "P" : "Q") + order);
      EXPECT_LT(largest_error(s,
                              [&](double, double y) {
                                const double below = std::min(y, 0.25), above = std::max(y - 0.25, 0.);
                                return std::array<double, 2>{0, -p * (below / stiff + above / soft)};
                              }),
                1e-11 * p / soft);
      EXPECT_NEAR(s.energy_norm_squared, p * p * (0.25 / stiff + 0.75 / soft), 1e-11 * p * p / soft);
      EXPECT_NEAR(s.contact.total.force[1], p, 1e-11 * p);
    }
}

TEST(BlockIn3d, IsCompressedUniformlyToRounding)
{
  const double p = 4, nu = 0.3, modulus = 2000 * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  const Solution s = run_scene(block, {"Mesh->Lower={0,0,0}", "Mesh->Upper={1,1,1}", "Mesh->Cells={4,3,4}",
                                       "Dirichlet->back->Z=0", "Dirichlet->front->Z=0"});
  ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_NEAR(s.contact.total.max_pressure, p, 1e-12 * p);
  EXPECT_NEAR(s.contact.total.force[1], p, 1e-12 * p);
  EXPECT_NEAR(s.energy, -0.5 * p * p / modulus, 1e-12 * p * p / modulus);
}

} // namespace
} // namespace block_test
