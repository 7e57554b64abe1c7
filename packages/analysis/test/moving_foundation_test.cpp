// SPDX-License-Identifier: BSD-3-Clause
/// Load histories of a foundation that moves.
#include "load_scenes.hpp"
#include "rpc/contact/surface/plane.hpp"
#include "rpc/contact/surface/sphere.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace moving_foundation_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using analysis::LoadHistory;
using analysis::Problem;
using analysis::StepSolution;

TEST(LoadHistory, AFoundationThatMovesIsABodyThatMovesTheOtherWay)
{
  const auto depth = [](const double t) { return t < 1.5 ? 0.05 : t < 2.5 ? 0.02 : 0.07; };
  for (const Law &law : laws) {
    SCOPED_TRACE(law.name);
    const auto tilted = [](const Point &x, const double d) { return -d * (1 + 0.5 * x[0]); };
    auto moving = column(law, depth), standing = moving;
    moving.dirichlet[2].displacement[1] =
        in_time([tilted](const Point &x, const double) { return tilted(x, 0.01) + 0.01; });
    standing.dirichlet[2].displacement[1] =
        in_time([tilted, depth](const Point &x, const double t) { return tilted(x, 0.01) + 0.01 - depth(t); });
    auto &plane = moving.contact[0].obstacle;
    plane.surface = contact::Plane{{0, 1, 0}};
    plane.path[0] = ScalarField(0.);
    plane.path[1] = in_time([depth](const Point &, const double t) { return depth(t); });
    standing.contact[0].obstacle = plane;
    standing.contact[0].obstacle.path[1] = ScalarField(0.);
    auto a = history_of(moving), b = history_of(standing);
    for (const double t : {1., 2., 3.}) {
      const StepSolution of_moving = advance(a, t), of_standing = advance(b, t);
      EXPECT_NEAR(of_moving.contact.total.force[1], of_standing.contact.total.force[1], 1e-8) << t;
      EXPECT_NEAR(of_moving.contact.total.max_dent, of_standing.contact.total.max_dent, 1e-10) << t;
      EXPECT_NEAR(of_moving.contact.total.max_penetration, of_standing.contact.total.max_penetration, 1e-10) << t;
      const analysis::Energies &x = a.last().energies, &y = b.last().energies;
      EXPECT_NEAR(x.strain, y.strain, 1e-9) << t;
      EXPECT_NEAR(x.dissipated, y.dissipated, 1e-9) << t;
      if (t > 1) {
        EXPECT_NEAR(x.work, y.work, 1e-9) << t;
      }
    }
  }
}

/// A ball below the block that moves along it: contact acts at other nodes and in other directions at each time.
analysis::Model over_a_ball(const contact::Normal normal, const double radius)
{
  auto model = column(laws[1], [](double) { return 0.02; });
  auto &ball = model.contact[0].obstacle;
  ball.surface = contact::Sphere{radius};
  ball.path[0] = in_time([](const Point &, const double t) { return 0.7 + 0.06 * t; });
  ball.path[1] = ScalarField(-radius);
  ball.point = {0.76, -radius, 0};
  model.contact[0].normal = normal;
  return model;
}

TEST(LoadHistory, AFoundationThatTurnsItsNormalsIsFollowed)
{
  auto history = history_of(over_a_ball(contact::Normal::foundation, 3));
  for (const double t : {1., 2.}) {
    const StepSolution s = advance(history, t);
    const auto normal = to_host(s.step.contact.normal);
    const auto node = to_host(s.step.contact.node);
    const auto coords = to_host(history.problem().discretization().mesh->coords);
    for (std::size_t i = 0; i < node.extent(0); ++i) {
      const double dx = coords(node(i), 0) - (0.7 + 0.06 * t), length = std::hypot(dx, 3.);
      EXPECT_NEAR(normal(i, 0), -dx / length, 1e-14);
    }
  }
}

/// Ten steps with one stiffness and one multigrid, or with new ones for each of them. With the body's normals only the nodes above
/// the ball are points. Of fewer unknowns algebraic multigrid is made for each choice of states.
TEST(LoadHistory, AFoundationThatTurnsItsNormalsNeedsNoOtherMatrixAndNoOtherMultigrid)
{
  for (const auto normal : {contact::Normal::foundation, contact::Normal::surface}) {
    for (const bool box : {true, false}) {
      solver::LinearSolverOptions linear;
      linear.multigrid = box ? "mesh" : "algebraic";
      const auto model = over_a_ball(normal, 0.5);
      const auto history = [&] {
        return LoadHistory(std::make_shared<Problem>(block(5), model, 1), close(), 0, linear);
      };
      LoadHistory one = history(), anew = history();
      int setups = 0;
      LO most = 0;
      for (int step = 1; step <= 10; ++step) {
        if (step > 1) anew.start_anew();
        const StepSolution s = advance(one, step);
        advance(anew, step);
        setups += one.last().preconditioner_setups;
        const LO points = sum_all(one.problem().discretization().mesh->comm(), s.step.contact.size());
        most = std::max(most, points);
        const analysis::Energies &x = one.last().energies, &y = anew.last().energies;
        EXPECT_GT(y.strain, 0);
        EXPECT_GT(y.dissipated, 0);
        EXPECT_NEAR(x.strain, y.strain, 1e-9 * y.strain) << step;
        EXPECT_NEAR(x.work, y.work, 1e-9 * std::abs(y.work)) << step;
        EXPECT_NEAR(x.dissipated, y.dissipated, 1e-9 * y.dissipated) << step;
      }
      EXPECT_EQ(one.problem().stiffness()->assemblies(), box ? 0 : 1);
      EXPECT_EQ(anew.problem().stiffness()->assemblies(), box ? 0 : 10);
      if (box) {
        EXPECT_EQ(setups, 1);
      }
      EXPECT_LE(setups, 2) << "corrections around the contact nodes may wear out once";
      if (normal == contact::Normal::surface) {
        EXPECT_LT(most, 61) << "points among the 61 nodes of the side";
      }
    }
  }
}

} // namespace
} // namespace moving_foundation_test
