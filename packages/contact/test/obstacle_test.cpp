// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/obstacle.hpp"

#include "expect_error.hpp"
#include "read_obstacle.hpp"
#include "rpc/contact/surface/plane.hpp"
#include "rpc/core/parameters.hpp"

#include <Teuchos_Array.hpp>
#include <cmath>
#include <gtest/gtest.h>

namespace obstacle_test
{
namespace
{

using namespace rpc;
using contact::direction_into;
using contact::distance_along;
using contact::lies_in;
using contact::Obstacle;
using rpc::test::expect_error;

using Numbers = Teuchos::Array<double>;

Obstacle read(const Teuchos::ParameterList &list, const int dim = 2)
{
  return rpc::test::read_obstacle(list, dim);
}

Obstacle plane(const Numbers &point, const Numbers &normal)
{
  Teuchos::ParameterList list;
  list.set("Type", "plane");
  list.set("Point", point);
  list.set("Normal", normal);
  return read(list, static_cast<int>(point.size()));
}

Obstacle circle(const double radius, const bool encloses)
{
  Teuchos::ParameterList list;
  list.set("Type", "circle");
  list.set("Centre", Numbers(Teuchos::tuple(1., 2.)));
  list.set("Radius", radius);
  list.set("Encloses Body", encloses);
  return read(list);
}

void expect_point(const std::optional<Point> &found, const Point &expected)
{
  ASSERT_TRUE(found);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR((*found)[c], expected[c], 1e-15);
}

TEST(Plane, DistanceIsMeasuredAlongTheDirection)
{
  const Obstacle floor = plane(Teuchos::tuple(5., 1.), Teuchos::tuple(0., 4.));
  expect_point(direction_into(floor, {2, 3}), {0, -1});
  EXPECT_DOUBLE_EQ(*distance_along(floor, {2, 3}, {0, -1}), 2);
  EXPECT_DOUBLE_EQ(*distance_along(floor, {2, 3}, {0.6, -0.8}), 2.5);
  EXPECT_DOUBLE_EQ(*distance_along(floor, {2, 0.5}, {0, -1}), -0.5); // in the foundation
  EXPECT_FALSE(distance_along(floor, {2, 3}, {1, 0}));
  EXPECT_FALSE(distance_along(floor, {2, 3}, {0, 1}));
  EXPECT_FALSE(distance_along(floor, {2, 3}, {1, -6e-17})); // level, but for rounding
  EXPECT_FALSE(distance_along(floor, {2, 0.5}, {0, 1}));
}

TEST(Plane, TellsWhatLiesBehindIt)
{
  const Obstacle floor = plane(Teuchos::tuple(5., 1.), Teuchos::tuple(0., 4.));
  EXPECT_FALSE(lies_in(floor, {2, 3}));
  EXPECT_FALSE(lies_in(floor, {2, 1 - 1e-14})); // on it, but for rounding
  EXPECT_TRUE(lies_in(floor, {2, 0.5}));
}

TEST(Plane, StandsInSpaceToo)
{
  const Obstacle wall = plane(Teuchos::tuple(0., 0., 3.), Teuchos::tuple(0., 0., -1.));
  expect_point(direction_into(wall, {7, 8, 1}), {0, 0, 1});
  EXPECT_DOUBLE_EQ(*distance_along(wall, {7, 8, 1}, {0, 0, 1}), 2);
}

TEST(Circle, OutsideOfItTheNormalLeadsToTheCentre)
{
  const Obstacle disc = circle(2, false);
  expect_point(direction_into(disc, {4, 6}), {-0.6, -0.8});
  EXPECT_DOUBLE_EQ(*distance_along(disc, {4, 6}, {-0.6, -0.8}), 3);
  EXPECT_DOUBLE_EQ(*distance_along(disc, {1, 5}, {0, -1}), 1);
  EXPECT_DOUBLE_EQ(*distance_along(disc, {1, 3.5}, {0, -1}), -0.5); // in the foundation
  // Along a fixed direction the near point of the circle counts: at x = 1 + sqrt(3) it lies 1 above the centre.
  EXPECT_NEAR(*distance_along(disc, {1 + std::sqrt(3.), 5}, {0, -1}), 2, 1e-15);
  EXPECT_FALSE(distance_along(disc, {4, 5}, {0, -1})); // passes it by
  EXPECT_FALSE(distance_along(disc, {1, 5}, {0, 1}));  // leads away
  EXPECT_FALSE(direction_into(disc, {1, 2}));          // the centre is as far from everywhere
}

TEST(Circle, FromWithinItTheSurfaceLiesBehind)
{
  const Obstacle disc = circle(2, false);
  EXPECT_FALSE(lies_in(disc, {4, 6}));
  EXPECT_FALSE(lies_in(disc, {1, 4 - 1e-14})); // on it, but for rounding
  EXPECT_TRUE(lies_in(disc, {1, 1}));
  EXPECT_DOUBLE_EQ(*distance_along(disc, {1, 3}, {0, -1}), -1);
  EXPECT_DOUBLE_EQ(*distance_along(disc, {1, 2}, {0, -1}), -2);
  EXPECT_DOUBLE_EQ(*distance_along(disc, {1, 1}, {0, -1}), -3); // beyond the centre
}

TEST(Circle, InsideOfItTheNormalLeadsOut)
{
  const Obstacle hole = circle(10, true);
  expect_point(direction_into(hole, {4, 6}), {0.6, 0.8});
  EXPECT_DOUBLE_EQ(*distance_along(hole, {4, 6}, {0.6, 0.8}), 5);
  EXPECT_DOUBLE_EQ(*distance_along(hole, {7, 10}, {0, -1}), 16); // down through it: y = 2 - 8
  EXPECT_DOUBLE_EQ(*distance_along(hole, {1, -9}, {0, -1}), -1); // in the foundation
  EXPECT_TRUE(lies_in(hole, {1, -9}));
  EXPECT_FALSE(lies_in(hole, {1, -7}));
  EXPECT_NEAR(*distance_along(hole, {1, 12 + 1e-14}, {1, 0}), 0, 1e-6); // a tangent at its point, but for rounding
  EXPECT_FALSE(distance_along(hole, {1, 13}, {1, 0}));                  // outside of the hole, and passes it by
}

/// Radius 2 about the axis through (1, 2, -7) along (0, 0, 5), or another one.
Teuchos::ParameterList cylinder_list(const bool encloses, const Numbers &axis = Teuchos::tuple(0., 0., 5.))
{
  Teuchos::ParameterList list;
  list.set("Type", "cylinder");
  list.set("Point", Numbers(Teuchos::tuple(1., 2., -7.)));
  list.set("Axis", axis);
  list.set("Radius", 2.);
  list.set("Encloses Body", encloses);
  return list;
}

TEST(Cylinder, IsACircleAcrossItsAxis)
{
  for (const bool encloses : {false, true}) {
    const Obstacle rod = read(cylinder_list(encloses), 3), disc = circle(2, encloses);
    for (const double z : {-20., 0., 3.}) {
      for (const Point &at : {Point{4, 6}, Point{1, 3.5}, Point{1, 5}, Point{-3, 2.5}}) {
        const Point x{at[0], at[1], z};
        EXPECT_EQ(lies_in(rod, x), lies_in(disc, at));
        expect_point(direction_into(rod, x), *direction_into(disc, at));
        for (const Point &direction : {Point{-0.6, -0.8}, Point{0, -1}, Point{1, 0}}) {
          const auto gap = distance_along(rod, x, direction), flat = distance_along(disc, at, direction);
          ASSERT_EQ(gap.has_value(), flat.has_value());
          if (gap) {
            EXPECT_NEAR(*gap, *flat, 1e-14);
          }
        }
      }
    }
    EXPECT_FALSE(direction_into(rod, {1, 2, 5})); // on the axis
  }
}

TEST(Cylinder, IsMetAlongASlantingDirection)
{
  const Obstacle rod = read(cylinder_list(false), 3);
  EXPECT_DOUBLE_EQ(*distance_along(rod, {1, 8, 0}, {0, -0.8, 0.6}), 5); // 4 across the axis
  EXPECT_FALSE(distance_along(rod, {1, 8, 0}, {0, 0, 1}));              // along it
  EXPECT_FALSE(distance_along(read(cylinder_list(true), 3), {1, 2.5, 0}, {0, 0, 1}));
}

TEST(Cylinder, MayLieInAnyDirection)
{
  const Obstacle rod = read(cylinder_list(false, Teuchos::tuple(1., 1., 0.)), 3); // through (1, 2, -7)
  expect_point(direction_into(rod, {4, 5, 0}), {0, 0, -1});
  EXPECT_NEAR(*distance_along(rod, {4, 5, 0}, {0, 0, -1}), 5, 1e-14);
  EXPECT_TRUE(lies_in(rod, {4, 5, -6}));
}

TEST(Sphere, IsRoundInSpace)
{
  Teuchos::ParameterList list;
  list.set("Type", "sphere");
  list.set("Centre", Numbers(Teuchos::tuple(1., 2., 3.)));
  list.set("Radius", 2.);
  const Obstacle ball = read(list, 3);
  expect_point(direction_into(ball, {1, 5, 7}), {0, -0.6, -0.8});
  EXPECT_DOUBLE_EQ(*distance_along(ball, {1, 5, 7}, {0, -0.6, -0.8}), 3);
  EXPECT_DOUBLE_EQ(*distance_along(ball, {1, 2, 9}, {0, 0, -1}), 4);
  list.set("Type", "circle"); // its older name
  expect_point(direction_into(read(list, 3), {1, 5, 7}), {0, -0.6, -0.8});
}

TEST(ObstacleOptions, RefuseWhatDoesNotFit)
{
  const auto refuse = [](const std::string &words, const std::function<void(Teuchos::ParameterList &)> &change) {
    Teuchos::ParameterList list;
    list.set("Type", "plane");
    list.set("Point", Numbers(Teuchos::tuple(0., 0.)));
    list.set("Normal", Numbers(Teuchos::tuple(0., 1.)));
    change(list);
    expect_error(ExitCode::bad_input, words, [&] { read(list); });
  };
  refuse("one of none, plane, sphere, circle, cylinder, ellipsoid, ellipse, cone, wedge, flat punch, torus, height "
         "map, surface mesh",
         [](auto &list) { list.set("Type", "pyramid"); });
  refuse("must hold 2 numbers or expressions of t, got 3",
         [](auto &list) { list.set("Point", Numbers(Teuchos::tuple(0., 0., 0.))); });
  refuse("must hold 2 numbers, got 0. It has no default: add it.", [](auto &list) { list.remove("Normal"); });
  refuse("length > 0", [](auto &list) { list.set("Normal", Numbers(Teuchos::tuple(0., 0.))); });
  refuse("does not go with", [](auto &list) { list.set("Radius", 1.); });
  refuse("does not go with", [](auto &list) { list.set("Type", "circle"); });
  refuse("body in space", [](auto &list) { list = cylinder_list(false); });
  refuse("must be > 0", [](auto &list) {
    list = Teuchos::ParameterList();
    list.set("Type", "circle");
    list.set("Centre", Numbers(Teuchos::tuple(0., 0.)));
  });
}

TEST(ObstacleOptions, KindsDescribeThemselves)
{
  const Teuchos::ParameterList valid = contact::valid_obstacle_parameters();
  const auto help = [&](const std::string &name) { return valid.getEntry(name).docString(); };
  EXPECT_EQ(help("Type"),
            "Shape of the foundation's surface: `plane`, `sphere` (in 2D also named `circle`), in 3D `cylinder`, "
            "`ellipsoid` (in 2D also named `ellipse`), `cone`, `wedge`, `flat punch`, in 3D `torus`, `height map`, in "
            "3D `surface mesh`, or `none`: see Gap.");
  EXPECT_EQ(help("Point"), "plane: a point on it; cylinder: a point on its axis; cone: its tip; wedge: a point on its "
                           "edge; flat punch: the middle of its face "
                           "[m]. Numbers, or expressions of t.");
  EXPECT_EQ(help("Radius"), "sphere, cylinder: its radius, > 0 [m]; flat punch: that of its shank, in 2D half its "
                            "width, > 0 [m]; torus: that of the "
                            "circle in the middle of its tube, > 0 [m].");
  for (const auto &entry : valid) { // each goes with the types that its help begins with, and is refused with others
    const std::string &name = entry.first;
    if (name == "Type" || name.find("Force ") == 0 || name.find("Stiffness ") == 0) continue; // these go with all
    Teuchos::ParameterList list;
    list.set("Type", help(name).find("plane") == 0 ? "circle" : "plane");
    if (valid.isType<double>(name))
      list.set(name, 7.);
    else if (valid.isType<bool>(name))
      list.set(name, true);
    else if (valid.isType<std::string>(name))
      list.set(name, "bilinear");
    else
      list.set(name, Numbers(Teuchos::tuple(1., 2.)));
    expect_error(ExitCode::bad_input, "->" + name + "\" does not go with", [&] { read(list); });
  }
}

TEST(Obstacle, PointsAndCentresMoveWithTime)
{
  Teuchos::ParameterList floor;
  floor.set("Type", "plane");
  floor.set("Point", Teuchos::Array<std::string>(Teuchos::tuple<std::string>("5", "t")));
  floor.set("Normal", Numbers(Teuchos::tuple(0., 1.)));
  const Obstacle at_first = read(floor), later = at_first.seen_at(3);
  EXPECT_EQ(at_first.point, (Point{5, 2, 0})); // the test's parser takes it for 2 t, seen at t = 1
  EXPECT_EQ(later.point, (Point{5, 6, 0}));
  EXPECT_EQ(*distance_along(later, {1, 10}, {0, -1}), 4);
  EXPECT_EQ(later.seen_at(0.5).point, (Point{5, 1, 0}));

  Teuchos::ParameterList ball;
  ball.set("Type", "sphere");
  ball.set("Centre", Teuchos::Array<std::string>(Teuchos::tuple<std::string>("t", "0", "-4")));
  ball.set("Radius", 2.);
  EXPECT_EQ(read(ball, 3).seen_at(2).point, (Point{4, 0, -4}));

  Teuchos::ParameterList rod = cylinder_list(false);
  rod.set("Point", Teuchos::Array<std::string>(Teuchos::tuple<std::string>("1", "2", "t")));
  EXPECT_EQ(read(rod, 3).seen_at(2).point, (Point{1, 2, 4}));
  EXPECT_EQ(read(cylinder_list(false), 3).seen_at(2).point, (Point{1, 2, -7})); // numbers stay where they are

  // Made without a deck: where it is said to be, whatever the time.
  const Obstacle made{contact::Plane{{0, 1, 0}}, {7, 8, 0}};
  EXPECT_EQ(made.seen_at(5).point, (Point{7, 8, 0}));
}

TEST(Obstacle, MovesWithTimeAloneAndToPlacesAlone)
{
  const auto refuses = [](const ScalarField &field, const std::initializer_list<std::string> &parts) {
    Teuchos::ParameterList list;
    list.set("Type", "plane");
    list.set("Point", Teuchos::Array<std::string>(Teuchos::tuple<std::string>("0", "formula")));
    list.set("Normal", Numbers(Teuchos::tuple(0., 1.)));
    validate(list, contact::valid_obstacle_parameters());
    const auto parse = [&](const std::string &text, const std::string &) {
      return text == "formula" ? field : ScalarField(std::stod(text));
    };
    expect_error(ExitCode::bad_input, parts, [&] { contact::obstacle_options(list, 2, "Contact->Obstacle", parse); });
  };
  const std::string name = "\"Contact->Obstacle->Point\"";
  for (int c = 0; c < 3; ++c)
    refuses(ScalarField("formula", [c](const Point &x, const double t) { return t + x[c]; }),
            {name, "must not depend on x, y or z", "formula"});
  refuses(ScalarField("formula", [](const Point &, double) { return std::nan(""); }), {name, "finite", "formula"});
}

TEST(Obstacle, TakesAsManyCoordinatesAsThereAreDimensions)
{
  Teuchos::ParameterList list;
  list.set("Type", "circle");
  list.set("Radius", 1.);
  list.set("Centre", Teuchos::Array<std::string>(Teuchos::tuple<std::string>("t", "0", "0")));
  expect_error(ExitCode::bad_input, {"\"Contact->Obstacle->Centre\"", "must hold 2 numbers or expressions of t, got 3"},
               [&] { read(list); });
}

} // namespace
} // namespace obstacle_test
