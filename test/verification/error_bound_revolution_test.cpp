// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/error.hpp"
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Guaranteed bounds for bodies of revolution, doc/bounds.md (13.10a) - (13.10d), against closed forms and finer meshes.

namespace error_bound_revolution_test
{
namespace
{

using namespace rpc;

const std::string deck = std::string(RPC_TEST_DECKS) + "/barrel.xml";
constexpr double pi = 3.14159265358979323846;

Solution bounded(const std::string &element, std::vector<std::string> assignments)
{
  assignments.insert(assignments.end(), {"Adapt->Error Bound=guaranteed", "Mesh->Element=" + element});
  Solution s = run_scene(deck, assignments);
  EXPECT_TRUE(s.bound);
  EXPECT_EQ(s.bound->missing, "");
  EXPECT_LT(s.bound->imbalance, 1e-10);
  return s;
}

TEST(ErrorBoundOfRevolution, IsNearlyNothingWhereTheElementsHaveTheSolution)
{
  for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
    SCOPED_TRACE(element);
    Solution s = bounded(element, {"Dirichlet->top->X="});
    const double energy = 1000 * 0.01 * 0.01 / 2 * pi, force = 1000 * 0.01 * pi;
    EXPECT_LE(s.bound->lower, energy * (1 + 1e-14));
    EXPECT_GE(s.bound->upper, energy * (1 - 1e-14));
    EXPECT_LT(s.bound->upper - s.bound->lower, 2e-6 * energy);     // of what 1/r is replaced with
    EXPECT_LT(s.bound->energy_norm, 2e-6 * std::sqrt(2 * energy)); // contact is solved to 1e-8
    ASSERT_EQ(s.bound->contact_force.size(), 1u);
    EXPECT_LE(s.bound->contact_force[0].lower, force);
    EXPECT_GE(s.bound->contact_force[0].upper, force);
    EXPECT_LT(s.bound->contact_force[0].upper - s.bound->contact_force[0].lower, 2e-6 * force);
  }
}

TEST(ErrorBoundOfRevolution, IsNearlyNothingUnderAForceAlongTheRadius)
{
  // Between smooth plates u_r = A r - f r^2/(3 (lambda + 2 mu)), and s_rr = 0 at r = 1.
  const double lambda = 400, mu = 400, modulus = lambda + 2 * mu, f = -30, B = -f / (3 * modulus),
               A = -(2 * modulus + lambda) * B / (2 * (lambda + mu));
  const double energy = -f * 2 * pi * (A / 3 + B / 4) / 2; // - int f u_r/2
  for (const std::string element : {"P2", "Q2"}) {
    SCOPED_TRACE(element);
    const Solution s = bounded(element, {"Dirichlet->top->X=", "Dirichlet->top->Y=0", "Body Force->X=-30"});
    EXPECT_LE(s.bound->lower, energy);
    EXPECT_GE(s.bound->upper, energy);
    EXPECT_LT(s.bound->upper - s.bound->lower, 1e-4 * std::abs(energy));
  }
}

TEST(ErrorBoundOfRevolution, HoldsTheForceOfAWavyBedInFullContact)
{
  // In a rigid smooth tube the mean of the strain along the axis fixes the force, whatever the pressure is:
  // (lambda + 2 mu)/h times the integral of what the plate moves beyond the gap a r^2.
  const double modulus = 1000 * 0.75 / (1.25 * 0.5), a = 0.002, force = modulus * (0.01 * pi - a * pi / 2);
  for (const std::string element : {"P2", "Q2"}) {
    SCOPED_TRACE(element);
    const Solution s = bounded(element, {"Dirichlet->right->X=0", "Contact->Gap=0.002*x*x"});
    const bound::ForceBound &f = s.bound->contact_force.at(0);
    EXPECT_EQ(f.missing, "");
    EXPECT_LT(f.lower, force);
    EXPECT_GT(f.upper, force);
    EXPECT_LT(f.upper - f.lower, 0.05 * force);
  }
}

TEST(ErrorBoundOfRevolution, HoldsTheForceOfARingInARigidTube)
{
  // Lame's ring between smooth plates: u_r = A r + B/r, s_rr = 2 (lambda + mu) A - 2 mu B/r^2 is -10 at r = 1, and u_r the gap at r = 2.
  const double lambda = 400, mu = 400, gap = 0.002, B = ((lambda + mu) * gap + 10) / ((lambda + mu) / 2 + 2 * mu);
  const double A = (gap - B / 2) / 2, pressure = -(2 * (lambda + mu) * A - 2 * mu * B / 4),
               force = pressure * 2 * pi * 2;
  EXPECT_NEAR(2 * (lambda + mu) * A - 2 * mu * B, -10, 1e-12);
  for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
    SCOPED_TRACE(element);
    const Solution s = bounded(element, {"Mesh->Lower={1, 0}", "Mesh->Upper={2, 1}",
                                         "Dirichlet->top->X=", "Dirichlet->top->Y=0", "Dirichlet->bottom->Y=0",
                                         "Traction->left->X=10", "Contact->Side=right", "Contact->Gap=0.002"});
    const bound::ForceBound &f = s.bound->contact_force.at(0);
    EXPECT_EQ(f.missing, "");
    EXPECT_LT(f.lower, force);
    EXPECT_GT(f.upper, force);
    EXPECT_LT(f.upper - f.lower, 0.05 * force);
    // J: half of the work of the pressures, less that of the load: -(10 u(1) 2 pi)/2 - p gap 4 pi/2.
    const double energy = -10 * (A + B) * pi - pressure * gap * 2 * pi;
    EXPECT_LT(s.bound->lower, energy);
    EXPECT_GT(s.bound->upper, energy);
    EXPECT_LT((s.bound->upper - s.bound->lower) / (s.bound->upper - energy), 1.6 * 1.6);
  }
}

TEST(ErrorBoundOfRevolution, MeetsThatOfAFinerMeshAndIsNear)
{
  const std::vector<std::string> scenes[] = {
      {"Contact->Gap=0.004*x"},
      {"Contact->Yield Stress=9"},
      {"Contact->Gap=0.004*x", "Contact->Yield Stress=6", "Body Force->X=3", "Body Force->Y=-4"},
      {"Contact->Yield Stress=6", "Contact->Hardening=400", "Contact->Stiffness=3e3", "Contact->Friction Bound=0.5"},
      {"Contact->Gap=0.004*x", "Traction->right->X=-30*y*(1 - y)", "Traction->right->Y=-20*y*(1 - y)"},
      {"Mesh->Lower={0.3, 0}", "Contact->Gap=0.004*x", "Traction->left->X=30*y*(1 - y)"},
      {"Mesh->Lower={0.3, 0}", "Contact->Gap=0.004*x", "Contact->Stiffness=3e3"}};
  for (const auto &scene : scenes) {
    std::vector<std::string> of_fine(scene);
    of_fine.push_back("Mesh->Cells={32, 32}");
    const Solution fine = bounded("P2", of_fine);
    for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
      SCOPED_TRACE(scene.front() + ", " + scene.back() + ", " + element);
      const Solution s = bounded(element, scene);
      EXPECT_LT(s.bound->lower, fine.bound->upper);
      EXPECT_GT(s.bound->upper, fine.bound->lower);
      EXPECT_LT((s.bound->upper - s.bound->lower) / (s.bound->upper - fine.bound->upper), 1.6 * 1.6);
      const bound::ForceBound &f = s.bound->contact_force.at(0), &g = fine.bound->contact_force.at(0);
      EXPECT_EQ(f.missing, g.missing);
      EXPECT_LE(f.lower, g.upper);
      EXPECT_GE(f.upper, g.lower);
    }
  }
}

TEST(ErrorBoundOfRevolution, RefusesLoadsThatBendAtTheAxis)
{
  try {
    bounded("P1", {"Dirichlet->top->Y=", "Dirichlet->right->X=0", "Dirichlet->right->Y=0", "Traction->top->Y=-x"});
    FAIL() << "no error";
  } catch (const Error &error) {
    EXPECT_NE(std::string(error.what()).find("loads on a cell at the axis"), std::string::npos) << error.what();
  }
}

} // namespace
} // namespace error_bound_revolution_test
