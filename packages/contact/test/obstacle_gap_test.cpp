// SPDX-License-Identifier: BSD-3-Clause
#include "expect_error.hpp"
#include "rpc/contact/surface/plane.hpp"
#include "rpc/contact/surface/sphere.hpp"
#include "touching_box.hpp"

#include <cmath>

namespace obstacle_gap_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using contact::Normal;
using contact::Obstacle;

/// A plane through a point, with a unit normal out of the foundation.
Obstacle plane(const Point &point, const Point &normal)
{
  return {contact::Plane{normal}, point};
}
Obstacle circle(const Point &centre, const double radius, const bool encloses = false)
{
  return {contact::Sphere{radius, encloses}, centre};
}

/// A slope below the bottom, which it cuts at x = 2/3: n . (x - p) = 0.4 - 0.6 x at (x, 0).
Obstacle slope()
{
  return plane({0, -0.5, 0}, {-0.6, 0.8, 0});
}

TEST(ContactNodes, GapToAPlaneIsMeasuredAlongTheSurfaceNormal)
{
  for (const mesh::Element element : {mesh::Element{2, 1}, mesh::Element{2, 2, mesh::Shape::simplex}}) {
    const auto d = body(element);
    auto options = touching("bottom");
    options.obstacle = slope(); // straight down to it
    expect_points(d, nodes_of(d, {options}), [](const Point &x) { return Expected{{0, -1, 0}, 0.5 - 0.75 * x[0]}; });
  }
}

TEST(ContactNodes, GapToAPlaneIsMeasuredAlongTheNormalOfTheFoundation)
{
  const auto d = body();
  auto options = touching("bottom");
  options.obstacle = slope();
  options.normal = Normal::foundation;
  expect_points(d, nodes_of(d, {options}), [](const Point &x) { return Expected{{0.6, -0.8, 0}, 0.4 - 0.6 * x[0]}; });
}

TEST(ContactNodes, GapToAPlaneIsMeasuredAlongAFixedNormal)
{
  const auto d = body();
  auto options = touching("bottom");
  options.obstacle = slope();
  options.normal = Normal::fixed;
  options.direction = {0.28, -0.96, 0}; // falls 0.936 towards the plane per metre
  expect_points(d, nodes_of(d, {options}), [](const Point &x) {
    return Expected{{0.28, -0.96, 0}, (0.4 - 0.6 * x[0]) / 0.936};
  });
}

TEST(ContactNodes, GapToACircleIsMeasuredAlongTheSurfaceNormal)
{
  const auto d = body();
  auto options = touching("bottom");
  options.obstacle = circle({1, -2.5, 0}, 2);
  expect_points(d, nodes_of(d, {options}), [](const Point &x) {
    return Expected{{0, -1, 0}, 2.5 - std::sqrt(4 - (x[0] - 1) * (x[0] - 1))};
  });
}

TEST(ContactNodes, GapToACircleIsMeasuredTowardsItsCentre)
{
  const auto d = body();
  auto options = touching("bottom");
  options.obstacle = circle({1, -2.5, 0}, 2.6); // reaches into the body
  options.normal = Normal::foundation;
  expect_points(d, nodes_of(d, {options}), [](const Point &x) {
    const double distance = std::hypot(x[0] - 1, 2.5);
    return Expected{{(1 - x[0]) / distance, -2.5 / distance, 0}, distance - 2.6};
  });
}

TEST(ContactNodes, GapToAnEnclosingSphereIsMeasuredAwayFromItsCentre)
{
  const auto d = body({3, 1});
  auto options = touching("front");
  options.obstacle = circle({1, 0.5, -1}, 3, true);
  options.normal = Normal::foundation;
  expect_points(d, nodes_of(d, {options}), [](const Point &x) {
    const double distance = std::hypot(x[0] - 1, x[1] - 0.5, 2);
    return Expected{{(x[0] - 1) / distance, (x[1] - 0.5) / distance, 2 / distance}, 3 - distance};
  });
}

TEST(ContactNodes, FromWhichTheNormalMissesTheObstacleAreNoPoints)
{
  for (const mesh::Element element : {mesh::Element{2, 1}, mesh::Element{2, 2}}) {
    const auto d = body(element);
    auto options = touching("bottom");
    options.obstacle = circle({1, -3, 0}, 0.7); // below the nodes at x = 0.5 to 1.5
    for (const Normal normal : {Normal::surface, Normal::fixed}) {
      options.normal = normal;
      options.direction = {0, -1, 0};
      const auto c = nodes_of(d, {touching("left"), options, touching("right")});
      EXPECT_EQ(sum_all(d.mesh->comm(), GO(c.first(2) - c.first(1))), element.order == 1 ? 3 : 5);
      EXPECT_EQ(c.num_missing, element.order == 1 ? 2 : 4);
      EXPECT_EQ(c.num_total, element.order == 1 ? 9 : 15);
      EXPECT_EQ(c.num_fixed, 0);
      expect_points(
          d, c,
          [](const Point &p) {
            return Expected{{0, -1, 0}, 3 - std::sqrt(0.49 - (p[0] - 1) * (p[0] - 1))};
          },
          1);
    }
  }
}

TEST(ContactNodes, FromWhichTheNormalMissesTheObstacleMayBeHeldAnyhow)
{
  // Held in y: only what may touch counts as prescribed.
  const auto d = body();
  auto options = touching("bottom");
  options.yield_stress = ScalarField(3.);
  options.obstacle = circle({1, -0.7, 0}, 0.7);
  fem::DirichletCondition held{"held", "bottom", {}};
  held.displacement[1] = ScalarField(-0.1);
  const auto c = contact::contact_nodes(d, {options}, fem::dirichlet_dofs(d, {held}));
  EXPECT_EQ(c.num_total, 3);
  EXPECT_EQ(c.num_fixed, 3);
  EXPECT_EQ(c.num_missing, 2);
}

TEST(ContactNodes, RefuseASideThatMissesTheObstacleAltogetherWithAPlace)
{
  const auto d = body();
  auto options = touching("bottom");
  options.path = "Contact->Sides->ball";
  options.obstacle = circle({1.25, -3, 0}, 0.2); // between two nodes
  expect_error(ExitCode::bad_input,
               {"\"Contact->Sides->ball\"", ", 0)", "\"bottom\"", "-1)", "does not lead into the obstacle",
                "nor from any other node", "\"Normal\" = foundation", "finer"},
               [&] {
                 nodes_of(d, {touching("left"), options});
               });
  options.normal = Normal::foundation;
  EXPECT_EQ(nodes_of(d, {options}).num_total, 5);
}

TEST(ContactNodes, MayBeNoneWhileAnObstacleThatMovesIsBesideTheSide)
{
  const auto d = body();
  auto options = touching("bottom");
  options.obstacle = circle({9, -3, 0}, 0.7);
  options.obstacle.path[0] = ScalarField("9 - t", [](const Point &, const double t) { return 9 - t; });
  options.obstacle.path[1] = ScalarField(-3.);
  for (const double t : {0., 8.}) {
    options.obstacle = options.obstacle.seen_at(t);
    const auto c = nodes_of(d, {touching("left"), options});
    EXPECT_EQ(sum_all(d.mesh->comm(), GO(c.first(2) - c.first(1))), t == 0 ? 0 : 3) << t;
    EXPECT_EQ(c.num_missing, t == 0 ? 5 : 2) << t;
  }
}

TEST(ContactNodes, OfTwoFoundationsOfOneSideAreTwoAtANode)
{
  // A groove of two slopes below the bottom.
  const auto d = body();
  auto left = touching("bottom"), right = touching("bottom");
  left.obstacle = slope();
  right.obstacle = plane({2, -0.5, 0}, {-0.6, 0.8, 0});
  left.normal = right.normal = Normal::foundation;
  right.yield_stress = ScalarField(7.);
  const auto c = nodes_of(d, {left, right});
  EXPECT_EQ(c.num_total, 10);
  const auto node = to_host(c.node);
  const auto gap = to_host(c.gap), yield = to_host(c.law.yield);
  const LO n = c.first(1);
  ASSERT_EQ(c.first(2), 2 * n);
  for (LO i = 0; i < n; ++i) {
    EXPECT_EQ(node(i), node(n + i));
    EXPECT_NEAR(gap(n + i) - gap(i), 1.2, 1e-14);
    EXPECT_EQ(yield(n + i), 7);
  }
}

TEST(ContactNodes, RefuseANormalThatLeadsAwayFromTheObstacle)
{
  const auto d = body();
  auto options = touching("bottom");
  options.obstacle = plane({0, -1, 0}, {0, 1, 0});
  options.normal = Normal::fixed;
  for (const Point &direction : {Point{0, 1, 0}, Point{1, 0, 0}}) {
    options.direction = direction;
    expect_error(ExitCode::bad_input, {"\"Contact\"", ", 0)", "does not lead into the obstacle"},
                 [&] { nodes_of(d, {options}); });
  }
}

TEST(ContactNodes, RefuseANodeInTheFoundationWhoseNormalDoesNotLeadOut)
{
  const auto d = body();
  auto options = touching("bottom");
  options.obstacle = plane({0.7, 0, 0}, {1, 0, 0}); // the nodes at x = 0 and 0.5 lie in it
  expect_error(ExitCode::bad_input, {"\"Contact\"", "(0, 0)", "lies in the foundation", "\"Normal\" = foundation"},
               [&] { nodes_of(d, {options}); });
}

TEST(ContactNodes, RefuseTheCentreOfACircleWhichHasNoNormal)
{
  const auto d = body();
  auto options = touching("bottom");
  options.obstacle = circle({1.5, 0, 0}, 1, true);
  options.normal = Normal::foundation;
  expect_error(ExitCode::bad_input, {"\"Contact->Obstacle->Centre\"", "(1.5, 0)", "\"bottom\"", "Move the centre"},
               [&] { nodes_of(d, {options}); });
}

} // namespace
} // namespace obstacle_gap_test
