// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/iterate.hpp"

#include "foundation_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace penalty_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

// On square Q1 cells of width h, a node of a straight side has the stiffness 2 (lambda + 3 mu) / 3 [Pa] along either axis,
// from two cells, and the weight h; at a corner both are halved.
const fem::Material material{10, 0.3};
constexpr double h = 1. / 3;
double own_stiffness()
{
  return 2 * (material.lambda() + 3 * material.mu()) / (3 * h);
}
/// Of the corner (2, 0) along (0.8, -0.6), where int dN/dx dN/dy = -1/4 couples the axes.
double slanted_corner_stiffness()
{
  const double along = (material.lambda() + 3 * material.mu()) / 3, across = -(material.lambda() + material.mu()) / 4;
  return (along + 2 * 0.8 * -0.6 * across) / (0.5 * h);
}

/// A body on its foundation, without gap.
contact::ContactOptions touching(const double penalty, const double yield = 3)
{
  contact::ContactOptions options;
  options.side = "bottom";
  options.yield_stress = ScalarField(yield);
  options.penalty = penalty;
  return options;
}

/// Each point's penalty, against what it must be at a place; relative tolerance 1e-13.
template <class Expected>
void expect_penalties(const Scene &scene, const Expected &expected)
{
  const auto &c = scene.iterate->points();
  const auto coords = to_host(scene.d.mesh->coords);
  const auto node = to_host(c.node);
  const auto penalty = to_host(scene.iterate->duals().penalty());
  for (int side = 0; side < c.num_sides(); ++side) {
    for (LO i = c.first(side); i < c.first(side + 1); ++i) {
      const Point x{coords(node(i), 0), coords(node(i), 1), 0};
      EXPECT_NEAR(penalty(i), expected(side, x), 1e-13 * expected(side, x)) << side << testing::PrintToString(x);
    }
  }
}

TEST(Penalty, IsAMultipleOfTheNodesOwnStiffnessWhereItIsLeftOpen)
{
  const Scene scene(std::vector{below(0), beside(0)});
  expect_penalties(scene, [](const int side, const Point &x) {
    if (side == 0) return 1e5 * own_stiffness();
    if (x[1] == 0) return 1e3 * slanted_corner_stiffness(); // along no axis
    return x[1] < 1 ? 1e3 * own_stiffness() : 0; // held at the top, which leaves the direction (0.8, 0) there
  });
}

TEST(Penalty, IsKeptWhereItIsGiven)
{
  const Scene scene(std::vector{below(40), beside(1e-3)});
  expect_penalties(scene, [](const int side, const Point &) { return side == 0 ? 40 : 1e-3; });
}

TEST(Penalty, IsBoundedByWhatDoublePrecisionBears)
{
  for (const double much : {1e15, 1.7e308}) {
    const Scene scene(std::vector{touching(much)});
    expect_penalties(scene, [](int, const Point &) { return 1e8 * own_stiffness(); });
    EXPECT_FALSE(scene.iterate->raise_penalty(*scene.vector(0, 0)));
    expect_penalties(scene, [](int, const Point &) { return 1e8 * own_stiffness(); });
  }
}

TEST(Penalty, RisesToTheOneOfItsOwnChoiceAtLeastAndUpToTheBound)
{
  const double own = own_stiffness();
  const auto rises = [](const double given, const std::vector<double> &expected) {
    const Scene scene(std::vector{touching(given)});
    for (const double penalty : expected) {
      EXPECT_TRUE(scene.iterate->raise_penalty(*scene.vector(0, 0)));
      expect_penalties(scene, [&](int, const Point &) { return penalty; });
    }
    EXPECT_FALSE(scene.iterate->raise_penalty(*scene.vector(0, 0)));
    expect_penalties(scene, [&](int, const Point &) { return expected.back(); });
  };
  rises(0, {1e7 * own, 1e8 * own});
  rises(1e-3, {1e5 * own, 1e7 * own, 1e8 * own});
  rises(2e4 * own, {2e6 * own, 1e8 * own});
  rises(9e7 * own, {1e8 * own});
}

TEST(Penalty, TooWeakForFrictionIsThatOfItsOwnChoice)
{
  const double own = own_stiffness();
  for (const double given : {1e-3, 9e4 * own, 2e5 * own, 2e7 * own}) {
    const Scene scene(std::vector{touching(given)});
    const bool weak = given < 1e5 * own;
    EXPECT_EQ(scene.iterate->duals().raise_weak_penalties(), weak ? scene.iterate->points().num_total : 0);
    expect_penalties(scene, [&](int, const Point &) { return weak ? 1e5 * own : given; });
    EXPECT_EQ(scene.iterate->duals().raise_weak_penalties(), 0);
  }
}

TEST(Penalty, OfASideInThePlaneWithFrictionIsRaisedFromTheStart)
{
  for (const double coefficient : {0., 0.3}) {
    auto side = touching(0);
    side.friction_coefficient = ScalarField(coefficient);
    const Scene scene(std::vector{side});
    expect_penalties(scene, [&](int, const Point &) { return (coefficient > 0 ? 1e7 : 1e5) * own_stiffness(); });
  }
}

TEST(Penalty, RaisedAtOneNodeIsARaiseOnAllRanks)
{
  // Given at the bound below, left open beside.
  const Scene scene(std::vector{touching(1e300), beside(0)});
  EXPECT_TRUE(scene.iterate->raise_penalty(*scene.vector(0, 0)));
  expect_penalties(scene, [](const int side, const Point &x) {
    if (side == 0) return 1e8 * own_stiffness();
    if (x[1] == 0) return 1e5 * slanted_corner_stiffness();
    return x[1] < 1 ? 1e5 * own_stiffness() : 0;
  });
}

/// e . H e with e = e_y at the node (1, 0).
double stiffness_of_middle(const Scene &scene)
{
  const auto e = scene.vector([](const Point &x) {
    return Point{0, std::abs(x[0] - 1) < 1e-9 && x[1] == 0 ? 1. : 0., 0};
  });
  Vector He(e->getMap());
  scene.iterate->hessian()->apply(*e, He);
  return e->dot(He);
}

TEST(Penalty, RaisedIsInTheHessianOfClosedNodesAtOnce)
{
  const Scene scene(std::vector{touching(40)});
  auto &iterate = *scene.iterate;
  const double elastic = stiffness_of_middle(scene);
  EXPECT_NEAR(elastic, own_stiffness() * h, 1e-13 * elastic);
  iterate.update_hessian(*scene.vector(0, 0)); // all closed
  EXPECT_NEAR(stiffness_of_middle(scene), elastic + 40 * h, 1e-12 * elastic);
  const int before = iterate.hessian()->revision();
  ASSERT_TRUE(iterate.raise_penalty(*scene.vector(0, 0)));
  EXPECT_GT(iterate.hessian()->revision(), before);
  EXPECT_NEAR(stiffness_of_middle(scene), elastic * (1 + 1e5), 1e-12 * 1e5 * elastic);
  iterate.update_hessian(*scene.vector([](const Point &) { return Point{0, 1, 0}; })); // all open
  EXPECT_NEAR(stiffness_of_middle(scene), elastic, 1e-12 * elastic);
  ASSERT_TRUE(iterate.raise_penalty(*scene.vector(0, 0)));
  EXPECT_NEAR(stiffness_of_middle(scene), elastic, 1e-12 * elastic);
}

TEST(Penalty, RaisedIsInTheGradientEvenAfterTheOriginHasMoved)
{
  const Scene scene(std::vector{touching(40)});
  auto &iterate = *scene.iterate;
  auto u = scene.vector([](const Point &) { return Point{}; });
  iterate.move_origin(*u);
  ASSERT_TRUE(iterate.raise_penalty(*scene.vector(0, 0)));
  const double r = 1e5 * own_stiffness();
  u = scene.vector([&](const Point &) { return Point{0, -1 / r, 0}; }); // presses lambda + r v from 1.5 to 2.5
  iterate.duals().update(*u);
  const auto lambda = to_host(iterate.duals().multipliers().normal);
  for (std::size_t i = 0; i < lambda.extent(0); ++i) EXPECT_NEAR(lambda(i), 2.5, 1e-12);
}

} // namespace
} // namespace penalty_test
