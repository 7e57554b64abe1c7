// SPDX-License-Identifier: BSD-3-Clause
// Ellipsoid, cone, wedge, flat punch and torus: x lies in them where a function of its coordinates says so, and their surfaces are clouds of points.
#include "expect_error.hpp"
#include "shape_cases.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace shapes_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using contact::direction_into;
using contact::distance_along;
using contact::lies_in;

/// Places about a shape: unit vectors and numbers from -1 to 1.
struct Draw {
  std::mt19937 engine{7};
  std::uniform_real_distribution<double> number{-1, 1};

  Point point(const int dim, const double size)
  {
    Point x{};
    for (int k = 0; k < dim; ++k) x[k] = size * number(engine);
    return x;
  }
  Point unit(const int dim)
  {
    for (;;) {
      const Point x = point(dim, 1);
      if (length(x) > 0.1 && length(x) < 1) return scaled(1 / length(x), x);
    }
  }
};

Point moved(const Point &x, const double by, const Point &direction)
{
  return {x[0] + by * direction[0], x[1] + by * direction[1], x[2] + by * direction[2]};
}

TEST(Shapes, HoldWhatTheirFormulasSay)
{
  Draw draw;
  for (const ShapeCase &c : shape_cases()) {
    int held = 0;
    for (int n = 0; n < 400; ++n) {
      const Point x = moved(c.place, 1, draw.point(c.dim, 2.));
      const bool expected = c.holds(c.local(x));
      held += expected ? 1 : 0;
      EXPECT_EQ(lies_in(c.obstacle, x), expected) << c.name;
    }
    EXPECT_GT(held, 2) << c.name;
    EXPECT_LT(held, 398) << c.name;
  }
}

/// From a cloud of points of the surface, refined around the nearest one of each quarter of it.
double brute_distance(const ShapeCase &c, const Point &x)
{
  const Point y = c.local(x);
  double nearest = std::numeric_limits<double>::infinity();
  for (const double first_along : {0.25, 0.75})
    for (const double first_around : {0.25, 0.75}) {
      double best = std::numeric_limits<double>::infinity(), along = first_along, around = first_around, width = 0.25;
      const auto within = [](const double middle, const double number) {
        return std::min(middle + 0.25 - 1e-12,
                        std::max(middle - 0.25, number)); // a wedge has its two sides in two quarters
      };
      for (int round = 0; round < 7; ++round) {
        const int parts = round == 0 ? 60 : 20;
        const double from_along = along - width, from_around = around - width, step = 2 * width / parts;
        for (int i = 0; i <= parts; ++i)
          for (int k = 0; k <= parts; ++k) {
            const double a = within(first_along, from_along + i * step),
                         b = within(first_around, from_around + k * step);
            const double distance = length(difference(c.at(a, b), y));
            if (distance < best) {
              best = distance;
              along = a;
              around = b;
            }
          }
        width = 2 * step;
      }
      nearest = std::min(nearest, best);
    }
  return nearest;
}

TEST(Shapes, AreAsFarAsTheNearestOfTheirPoints)
{
  Draw draw;
  for (const ShapeCase &c : shape_cases())
    for (int n = 0; n < 12; ++n) {
      const Point x = moved(c.place, 1, draw.point(c.dim, 2.));
      const auto direction = direction_into(c.obstacle, x);
      ASSERT_TRUE(direction) << c.name;
      EXPECT_NEAR(length(*direction), 1, 1e-14) << c.name;
      const auto gap = distance_along(c.obstacle, x, *direction);
      ASSERT_TRUE(gap) << c.name;
      EXPECT_EQ(*gap < 0, lies_in(c.obstacle, x)) << c.name;
      EXPECT_NEAR(std::abs(*gap), brute_distance(c, x), 1e-6) << c.name << " at " << n;
    }
}

/// Over how far a place is from the surface, the largest difference of a normal from the slope of the distance.
double slope_error(const ShapeCase &c, const Point &x, const double step)
{
  const auto distance = [&](const Point &y) {
    return distance_along(c.obstacle, y, direction_into(c.obstacle, y).value()).value();
  };
  const Point direction = direction_into(c.obstacle, x).value();
  double worst = 0;
  for (int k = 0; k < c.dim; ++k) {
    Point unit{};
    unit[k] = 1;
    const double slope = (distance(moved(x, step, unit)) - distance(moved(x, -step, unit))) / (2 * step);
    worst = std::max(worst, std::abs(slope + direction[k]));
  }
  return worst;
}

TEST(Shapes, HaveTheSlopeOfTheirDistanceAsNormal)
{
  Draw draw;
  int of_second_order = 0;
  for (const ShapeCase &c : shape_cases()) {
    std::vector<double> orders;
    for (int n = 0; n < 60; ++n) {
      const Point x = moved(c.place, 1, draw.point(c.dim, 2.));
      const double coarse = slope_error(c, x, 0.004), fine = slope_error(c, x, 0.002);
      if (coarse > 1e-9) orders.push_back(std::log2(coarse / fine)); // on flat parts differences are exact
    }
    if (orders.size() < 9) continue; // all of it is flat
    const auto middle = orders.begin() + static_cast<std::ptrdiff_t>(orders.size() / 2);
    std::nth_element(orders.begin(), middle, orders.end()); // some places have an edge next to them
    EXPECT_NEAR(*middle, 2, 0.05) << c.name;
    ++of_second_order;
  }
  EXPECT_GT(of_second_order, 12);
}

TEST(Shapes, AreMetWhereALineFirstEntersThem)
{
  Draw draw;
  for (const ShapeCase &c : shape_cases()) {
    int met = 0, missed = 0;
    for (int n = 0; n < 300; ++n) {
      const Point x = moved(c.place, 1, draw.point(c.dim, 2.5)), direction = draw.unit(c.dim);
      const bool inside = c.holds(c.local(x));
      const auto held = [&](const double g) { return c.holds(c.local(moved(x, g, direction))); };
      const auto gap = distance_along(c.obstacle, x, direction);
      double first = std::numeric_limits<double>::infinity(); // by small steps: forwards from outside, back from inside
      const double step = (inside ? -1 : 1) * 0.002;
      for (int k = 1; k < 4000 && std::isinf(first); ++k)
        if (held(k * step) != inside) first = k * step;
      if (!gap) {
        ++missed;
        EXPECT_TRUE(std::isinf(first)) << c.name << (inside ? " from inside " : " from outside ") << first;
        continue;
      }
      ++met;
      if (c.encloses && inside && *gap > 0) continue; // through the hole, to its other side, as spheres have it
      EXPECT_EQ(*gap < 0, inside) << c.name;
      EXPECT_TRUE(held(*gap + 1e-7) && !held(*gap - 1e-7)) << c.name << " " << *gap;
      if (std::isfinite(first)) {
        EXPECT_NEAR(*gap, first, 0.0021) << c.name;
      }
    }
    EXPECT_GT(met, 5) << c.name;
    if (c.name.find("wedge") == std::string::npos) {
      EXPECT_GT(missed, 5) << c.name;
    }
  }
}

TEST(Shapes, AreMetByHandAlgebra)
{
  const auto seen = [](const ShapeCase &c, const Point &y) { return c.global(y); };
  const ShapeCase cone = tip("cone", 3, 0.4, 0.5);
  const Point down = scaled(-1, cone.frame[2]);
  const double size = std::hypot(0.4, 1);
  EXPECT_NEAR(*distance_along(cone.obstacle, seen(cone, {0, 0, 3}), down), 3, 1e-14); // to the tip
  EXPECT_NEAR(*distance_along(cone.obstacle, seen(cone, {0, 0, -0.2}), down), -0.2, 1e-14);
  EXPECT_NEAR(*distance_along(cone.obstacle, seen(cone, {0, 3, 1}), down), 1 + 1.2 - 0.5 * (size - 1), 1e-14);
  EXPECT_FALSE(distance_along(cone.obstacle, seen(cone, {0, 0, 1}), scaled(-1, down)));
  EXPECT_FALSE(distance_along(cone.obstacle, seen(cone, {0, 3, 1}), cone.frame[1])); // passes it by
  const ShapeCase ring = torus(2, 0.5);
  EXPECT_NEAR(*distance_along(ring.obstacle, seen(ring, {4, 0, 0}), scaled(-1, ring.frame[0])), 1.5, 1e-14);
  EXPECT_NEAR(*distance_along(ring.obstacle, seen(ring, {0, 0, 0}), ring.frame[1]), 1.5, 1e-14); // from its hole
  EXPECT_NEAR(*distance_along(ring.obstacle, seen(ring, {-1.9, 0, 0}), scaled(-1, ring.frame[0])), -0.4, 1e-14);
  EXPECT_NEAR(*distance_along(ring.obstacle, seen(ring, {1.9, 0, 0}), scaled(-1, ring.frame[0])), -0.6,
              1e-14); // not through the hole
  EXPECT_FALSE(distance_along(ring.obstacle, seen(ring, {1.4, 0, 3}), scaled(-1, ring.frame[2])));
  const ShapeCase punch = flat_punch(3, 2, 0.5);
  EXPECT_NEAR(*distance_along(punch.obstacle, seen(punch, {0, 1.4, 1}), down), 1, 1e-14);
  EXPECT_NEAR(*distance_along(punch.obstacle, seen(punch, {0, 1.9, 1}), down), 1.5 - std::sqrt(0.25 - 0.16), 1e-14);
  EXPECT_FALSE(distance_along(punch.obstacle, seen(punch, {0, 2.1, 1}), down));
  EXPECT_NEAR(*distance_along(punch.obstacle, seen(punch, {0, 3, -7}), scaled(-1, punch.frame[1])), 1,
              1e-14); // its shank
}

TEST(Shapes, HaveTheDirectionOfTheirAxisOnIt)
{
  for (const ShapeCase &c : {tip("cone", 3, 0.4, 0), tip("cone", 2, 0.4, 0.2), tip("wedge", 3, 0.4, 0),
                             flat_punch(3, 1, 0.2), flat_punch(2, 1, 0)})
    for (const double z : {2., 0., -0.1, -5.}) {
      const Point found = direction_into(c.obstacle, c.global({0, 0, z})).value();
      EXPECT_NEAR(inner(found, c.frame[2]), -1, 1e-15) << c.name << " " << z;
      const auto gap = distance_along(c.obstacle, c.global({0, 0, z}), found);
      EXPECT_NEAR(gap.value(), z, 1e-14) << c.name;
    }
  const ShapeCase ring = torus(2, 0.5);
  for (const double z : {2., -0.1}) // through the hole, so that nothing is met
    EXPECT_NEAR(inner(direction_into(ring.obstacle, ring.global({0, 0, z})).value(), ring.frame[2]), z > 0 ? -1 : 1,
                1e-15);
  EXPECT_FALSE(direction_into(ring.obstacle, ring.place));
  EXPECT_FALSE(direction_into(ring.obstacle, ring.global({2, 0, 0}))); // in the middle of its tube
}

TEST(Ellipsoid, OfEqualAxesIsASphere)
{
  Draw draw;
  const ShapeCase c = ellipsoid(3, {1.3, 1.3, 1.3});
  EXPECT_FALSE(direction_into(c.obstacle, c.place));
  for (int n = 0; n < 20; ++n) {
    const Point x = moved(c.place, 1, draw.point(3, 2)), from = difference(x, c.place);
    const Point found = direction_into(c.obstacle, x).value();
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], -from[k] / length(from), 1e-14);
  }
}

TEST(Ellipsoid, HasNoDirectionBetweenPointsThatAreAsNear)
{
  const ShapeCase c = ellipsoid(3, {2, 1, 1.5}); // the shortest one is the second
  ShapeCase straight = c;
  Teuchos::ParameterList list;
  list.set("Type", "ellipsoid");
  list.set("Centre", Numbers(Teuchos::tuple(0., 0., 0.)));
  list.set("Semi-Axes", Numbers(Teuchos::tuple(2., 1., 1.5)));
  straight.obstacle = read_obstacle(list, 3); // its axes are x, y, z
  EXPECT_FALSE(direction_into(straight.obstacle, {0, 0, 0}));
  EXPECT_FALSE(direction_into(straight.obstacle, {0.5, 0, -0.3}));
  EXPECT_TRUE(direction_into(straight.obstacle, {0.5, 1e-6, -0.3}));
  for (const double x : {1.6, 2., 3.}) { // beyond the centre of curvature, 2 - 1/2
    const Point found = direction_into(straight.obstacle, {x, 0, 0}).value();
    EXPECT_NEAR(found[0], -1, 1e-14);
  }
}

TEST(ShapeOptions, RefuseWhatDoesNotFit)
{
  const auto refuse = [](const std::initializer_list<std::string> &words, const int dim, const char *const type,
                         const std::function<void(Teuchos::ParameterList &)> &change) {
    Teuchos::ParameterList list;
    list.set("Type", type);
    const bool centre = std::string(type) == "torus" || std::string(type) == "ellipsoid";
    list.set(centre ? "Centre" : "Point", Numbers(dim, 0.));
    change(list);
    expect_error(ExitCode::bad_input, words, [&] { read_obstacle(list, dim); });
  };
  const Numbers up = Teuchos::tuple(0., 0., 1.), flat = Teuchos::tuple(0., 1.);
  refuse({"\"Contact->Obstacle->Slope\" must be > 0 and finite [-], got 0"}, 3, "cone",
         [&](auto &list) { list.set("Axis", up); });
  refuse({"\"Contact->Obstacle->Axis\" must hold 3 numbers, got 0"}, 3, "cone",
         [](auto &list) { list.set("Slope", 1.); });
  refuse({"\"Contact->Obstacle->Tip Radius\" must be >= 0 and finite [m]", "got -1"}, 2, "cone", [&](auto &list) {
    list.set("Axis", flat);
    list.set("Slope", 1.);
    list.set("Tip Radius", -1.);
  });
  refuse({"\"Contact->Obstacle->Axis\" goes with a wedge in space", "Remove it"}, 2, "wedge", [&](auto &list) {
    list.set("Normal", flat);
    list.set("Axis", flat);
  });
  refuse({"\"Contact->Obstacle->Normal\" must lead across", "same direction"}, 3, "wedge", [&](auto &list) {
    list.set("Normal", up);
    list.set("Axis", up);
  });
  refuse({"\"Contact->Obstacle->Edge Radius\" must be at most \"Contact->Obstacle->Radius\" = 1 [m], got 2"}, 2,
         "flat punch", [&](auto &list) {
           list.set("Normal", flat);
           list.set("Radius", 1.);
           list.set("Edge Radius", 2.);
         });
  refuse({"\"Contact->Obstacle->Semi-Axes\" must hold 3 numbers, got 2"}, 3, "ellipsoid",
         [&](auto &list) { list.set("Semi-Axes", flat); });
  refuse({"\"Contact->Obstacle->Semi-Axes\" must be > 0 and finite [m], got 0"}, 2, "ellipsoid",
         [&](auto &list) { list.set("Semi-Axes", flat); });
  refuse({"\"Contact->Obstacle->Second Axis\" must be at right angles"}, 3, "ellipsoid", [&](auto &list) {
    list.set("Semi-Axes", Numbers(3, 1.));
    list.set("Second Axis", Numbers(3, 1.));
  });
  refuse({"torus goes with a body in space; use circle in the plane"}, 2, "torus", [](auto &) {});
  refuse({"\"Contact->Obstacle->Tube Radius\" must be below \"Contact->Obstacle->Radius\" = 1 [m], got 1"}, 3, "torus",
         [&](auto &list) {
           list.set("Axis", up);
           list.set("Radius", 1.);
           list.set("Tube Radius", 1.);
         });
}

} // namespace
} // namespace shapes_test
