#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

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
    for (int c = 0; c < 2; ++c) worst = std::max(worst, std::abs(u(2 * n + c, 0) - exact(x(n, 0), x(n, 1))[c]));
  return worst;
}

class Block : public testing::TestWithParam<const char *>
{
};
INSTANTIATE_TEST_SUITE_P(Elements, Block, testing::Values("Q1", "Q2"));

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
    EXPECT_NEAR(s.contact.max_pressure, p, 1e-12 * p) << xi;
    EXPECT_NEAR(s.contact.force[1], p, 1e-12 * p);
    EXPECT_NEAR(s.contact.force[0], 0, 1e-12 * p);
    EXPECT_NEAR(s.energy, -0.5 * p * p / modulus, 1e-12 * p * p / modulus);
    EXPECT_NEAR(s.strain_energy, p * p / modulus, 1e-12 * p * p / modulus);
    EXPECT_NEAR(s.contact.contact_length, 1, 1e-12);
    EXPECT_LE(s.uzawa.iterations, 5);
  }
}

TEST_P(Block, FullyYieldedEqualsTheLinearProblemWithThatPressure)
{
  const std::vector<std::string> held = {std::string("Mesh->Element=") + GetParam(), "Dirichlet->left->Y=0",
                                         "Dirichlet->right->Y=0", "Traction->top->Y=-12", "Contact->Yield Stress=1.5"};
  const Solution contact = run_scene(block, held);
  ASSERT_TRUE(contact.uzawa.converged) << contact.uzawa.reason;
  EXPECT_NEAR(contact.contact.yielded_length, 1, 1e-12);
  EXPECT_NEAR(contact.contact.force[1], 1.5, 1e-12);
  EXPECT_EQ(contact.uzawa.iterations, 1);

  auto linear_case = held;
  linear_case.insert(linear_case.end(), {"Contact->Side=", "Traction->bottom->Y=1.5"});
  const Solution linear = run_scene(block, linear_case);
  ASSERT_TRUE(linear.uzawa.converged) << linear.uzawa.reason;
  EXPECT_LE(linear.linear.iterations.size(), 2u);
  Vector difference(*contact.u, Teuchos::Copy);
  difference.update(-1., *linear.u, 1.);
  EXPECT_LT(difference.normInf(), 1e-12 * linear.u->normInf());
}

TEST_P(Block, LiftedOffItsFoundationIsFree)
{
  const Solution s = run_scene(block, {std::string("Mesh->Element=") + GetParam(), "Dirichlet->top->Y=0.01",
                                       "Traction->top->Y=0", "Contact->Gap=-0.005"});
  ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_EQ(s.contact.max_pressure, 0);
  EXPECT_EQ(s.contact.contact_length, 0);
  EXPECT_NEAR(s.contact.max_initial_penetration, 0.005, 1e-15);
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
    EXPECT_NEAR(s.contact.max_pressure, p, 1e-11 * p);
    EXPECT_LT(largest_error(s,
                            [&](double, double y) {
                              return std::array<double, 2>{0, -sunk - p / modulus * y};
                            }),
              1e-12 * delta);
    EXPECT_NEAR(s.strain_energy, p * p / modulus, 1e-11 * p * p / modulus);
    EXPECT_NEAR(s.energy, 0.5 * p * p / modulus + 10 * sunk, 1e-11 * 10 * delta); // J with xi v+ of the foundation
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
  EXPECT_GT(a.contact.force[1], 0.1);
  EXPECT_NEAR(b.contact.force[1], a.contact.force[1], 1e-6 * a.contact.force[1]);
  EXPECT_NEAR(b.strain_energy, a.strain_energy, 1e-9 * a.strain_energy);
}

TEST(BlockIn3d, IsCompressedUniformlyToRounding)
{
  const double p = 4, nu = 0.3, modulus = 2000 * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  const Solution s = run_scene(block, {"Mesh->Lower={0,0,0}", "Mesh->Upper={1,1,1}", "Mesh->Cells={4,3,4}",
                                       "Dirichlet->back->Z=0", "Dirichlet->front->Z=0"});
  ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_NEAR(s.contact.max_pressure, p, 1e-12 * p);
  EXPECT_NEAR(s.contact.force[1], p, 1e-12 * p);
  EXPECT_NEAR(s.energy, -0.5 * p * p / modulus, 1e-12 * p * p / modulus);
}

} // namespace
