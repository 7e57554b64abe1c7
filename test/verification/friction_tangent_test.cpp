// SPDX-License-Identifier: BSD-3-Clause
#include "friction_scene.hpp"

#include <cmath>
#include <numeric>

// Friction acts along the side: its traction has no part along the normal, whatever a solution started from.

namespace friction_tangent_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// The largest |q . nu| and |slip . nu| over the largest |q| and |slip|, over all ranks.
struct AlongNormal {
  double traction = 0, slip = 0;
  int sticking = 0, slipping = 0; // points
};
AlongNormal along_normal(const analysis::Solution &s)
{
  const contact::ContactNodes &c = s.step.contact;
  const auto normal = to_host(c.normal), q = to_host(s.contact.traction), e = to_host(s.contact.slip);
  const auto state = to_host(s.contact.slip_state);
  std::vector<double> most(4, 0.), numbers(2, 0.);
  for (LO i = 0; i < c.size(); ++i) {
    double of_q = 0, of_e = 0;
    for (int k = 0; k < c.dim; ++k) {
      of_q += q(i, k) * normal(i, k);
      of_e += e(i, k) * normal(i, k);
      most[1] = std::max(most[1], std::abs(q(i, k)));
      most[3] = std::max(most[3], std::abs(e(i, k)));
    }
    most[0] = std::max(most[0], std::abs(of_q));
    most[2] = std::max(most[2], std::abs(of_e));
    if (state(i) > 0) ++numbers[state(i) - 1];
  }
  const Comm &comm = s.discretization.mesh->comm();
  most = largest(comm, most);
  numbers = summed(comm, numbers);
  EXPECT_GT(most[1], 0);
  return {most[0] / most[1], most[2] / most[3], static_cast<int>(numbers[0]), static_cast<int>(numbers[1])};
}

// Of r e: penalties are large against E over the size of the body, and slips small against displacements.
constexpr double rounding = 1e-10;

void expect_none(const analysis::Solution &s)
{
  const AlongNormal found = along_normal(s);
  EXPECT_LT(found.traction, rounding);
  EXPECT_LT(found.slip, rounding);
  EXPECT_GT(found.sticking, 0);
  EXPECT_GT(found.slipping, 0);
}

/// A block pressed on a circle, in the plane, or on a ball: the normals of its flat side turn along it.
const Assignments pressed = {"Contact->Obstacle->Radius=2", "Contact->Normal=foundation",
                             "Contact->Friction Coefficient=0.2", "Dirichlet->top->X=0"};
const Assignments on_a_circle =
    joined(pressed, {"Mesh->Cells={48, 24}", "Contact->Obstacle->Type=circle", "Traction->left->X=0",
                     "Traction->left->Y=0", "Traction->right->X=0", "Traction->right->Y=0", "Dirichlet->top->Y=-0.03"});
const Assignments on_a_ball = joined(joined(block_in_space, pressed),
                                     {"Mesh->Cells={12, 6, 6}", "Contact->Obstacle->Type=sphere",
                                      "Contact->Yield Stress=inf", "Dirichlet->top->Y=0", "Dirichlet->top->Z=-0.03"});

TEST(FrictionTangent, AfterAStartFromACoarserMesh)
{
  const Solution plane =
      solved("loop", joined(on_a_circle, {"Steps->Times={1}", "Contact->Obstacle->Centre={0.8, -2}"}));
  EXPECT_FALSE(plane.levels.empty()) << "a coarser mesh predicts the start";
  expect_none(plane);
  const Solution space =
      solved("loop", joined(on_a_ball, {"Steps->Times={1}", "Contact->Obstacle->Centre={0.8, 0.4, -2}"}));
  EXPECT_FALSE(space.levels.empty()) << "a coarser mesh predicts the start";
  expect_none(space);
}

TEST(FrictionTangent, AfterAStepInWhichTheObstacleTurnsTheNormals)
{
  for (const auto &s : solved_steps(
           "loop", joined(on_a_circle, {"Steps->Times={1, 2, 3}", "Contact->Obstacle->Centre={0.8 + 0.0002*t, -2}"})))
    expect_none(s);
  int set_ups = 0;
  for (const auto &s : solved_steps(
           "loop",
           joined(on_a_ball, {"Steps->Times={1, 2, 3}", "Contact->Obstacle->Centre={0.8 + 0.0002*t, 0.4, -2}"}))) {
    expect_none(s);
    const auto &iterations = s.linear.iterations; // of GMRES but for the first ones
    const int sum = std::accumulate(iterations.begin(), iterations.end(), 0);
    EXPECT_GE(sum, 12);
    EXPECT_LE(sum, 26);
    set_ups += s.linear.preconditioner_setups;
  }
  EXPECT_EQ(set_ups, 1) << "points that change between stick and slip do not wear the preconditioner out";
}

TEST(FrictionTangent, AtPointsThatTakeTheirTractionFromNodesAround)
{
  const Solution s = solved("loop", joined(on_a_ball, {"Mesh->Cells={4, 3, 2}", "Mesh->Element=P2", "Steps->Times={1}",
                                                       "Contact->Obstacle->Centre={0.8, 0.4, -2}"}));
  EXPECT_GT(s.step.contact.num_weightless, 0);
  expect_none(s);
}

} // namespace
} // namespace friction_tangent_test
