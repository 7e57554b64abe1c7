// SPDX-License-Identifier: BSD-3-Clause
// Ellipsoid, cone, wedge, flat punch and torus as obstacles, and formulas of their surfaces that share nothing with the code.
#pragma once

#include "read_obstacle.hpp"

#include <Teuchos_Array.hpp>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace rpc::test
{

using contact::Obstacle;
using Numbers = Teuchos::Array<double>;

constexpr double two_pi = 6.28318530717959;

inline Numbers numbers(const Point &x, const int dim)
{
  return Numbers(x.begin(), x.begin() + dim);
}

/// A shape in a frame of its own: coordinates (a, b, c) are along `frame`, seen from `place`.
struct ShapeCase {
  std::string name;
  int dim = 3;
  Obstacle obstacle;
  std::function<bool(const Point &)> holds; // of local coordinates, whether the foundation holds them
  std::function<Point(double along, double around)>
      at; // local coordinates of a place on the surface, of two numbers in [0, 1]
  std::array<Point, 3> frame = {};
  Point place = {};
  bool encloses = false;

  Point local(const Point &x) const
  {
    const Point seen = difference(x, place);
    return {inner(seen, frame[0]), inner(seen, frame[1]), inner(seen, frame[2])};
  }
  Point global(const Point &y) const
  {
    Point x = place;
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < 3; ++c) x[c] += y[i] * frame[i][c];
    return x;
  }
};

/// In the plane the third direction of the frame, which shapes of a profile have as their axis, is (0.6, 0.8).
inline std::array<Point, 3> frame_of(const int dim)
{
  if (dim == 2) return {{{0.8, -0.6, 0}, {0, 0, 1}, {0.6, 0.8, 0}}};
  const Point c = {2. / 3, -1. / 3, 2. / 3}, a = {1 / std::sqrt(5.), 2 / std::sqrt(5.), 0};
  return {{a, cross(c, a), c}};
}

inline ShapeCase started(const std::string &name, const int dim, Teuchos::ParameterList &list)
{
  ShapeCase c;
  c.name = name + " in " + std::to_string(dim) + "D";
  c.dim = dim;
  c.frame = frame_of(dim);
  c.place = {0.3, -0.2, dim == 3 ? 0.1 : 0.};
  list.set("Type", name);
  return c;
}

/// Height of a tip that falls by a slope, rounded with a radius: the highest point is at 0.
inline double tip_height(const double s, const double slope, const double radius)
{
  const double touch = radius * slope / std::hypot(slope, 1);
  return s < touch ? std::sqrt(radius * radius - s * s) - radius : radius * (std::hypot(slope, 1) - 1) - slope * s;
}

inline ShapeCase tip(const std::string &name, const int dim, const double slope, const double radius)
{
  Teuchos::ParameterList list;
  ShapeCase c = started(name, dim, list);
  const bool wedge = name == "wedge";
  list.set("Point", numbers(c.place, dim));
  list.set("Slope", slope);
  list.set(wedge ? "Edge Radius" : "Tip Radius", radius);
  list.set(wedge ? "Normal" : "Axis", numbers(scaled(7, c.frame[2]), dim));
  if (wedge && dim == 3) list.set("Axis", numbers(scaled(-2, c.frame[1]), dim));
  c.obstacle = read_obstacle(list, dim);
  const auto off = [=](const Point &y) { return wedge ? std::abs(y[0]) : std::hypot(y[0], y[1]); };
  c.holds = [=](const Point &y) { return y[2] < tip_height(off(y), slope, radius); };
  c.at = [=](const double along, const double around) -> Point {
    const double s = 6 * along, z = tip_height(s, slope, radius);
    if (wedge || dim == 2) return {around < 0.5 ? s : -s, dim == 2 ? 0. : 12 * std::fmod(2 * around, 1.) - 6, z};
    return {s * std::cos(two_pi * around), s * std::sin(two_pi * around), z};
  };
  return c;
}

inline ShapeCase flat_punch(const int dim, const double radius, const double edge)
{
  Teuchos::ParameterList list;
  ShapeCase c = started("flat punch", dim, list);
  list.set("Point", numbers(c.place, dim));
  list.set("Normal", numbers(scaled(3, c.frame[2]), dim));
  list.set("Radius", radius);
  list.set("Edge Radius", edge);
  c.obstacle = read_obstacle(list, dim);
  const double flat = radius - edge;
  c.holds = [=](const Point &y) {
    const double s = std::hypot(y[0], y[1]);
    if (s >= radius) return false;
    return y[2] < (s < flat ? 0 : std::sqrt(edge * edge - (s - flat) * (s - flat)) - edge);
  };
  c.at = [=](const double along, const double around) -> Point {
    const double way = along * (flat + two_pi / 4 * edge + 4); // along the profile
    double s = way, z = 0;
    if (way > flat + two_pi / 4 * edge) {
      s = radius;
      z = -edge - (way - flat - two_pi / 4 * edge);
    } else if (way > flat) {
      s = flat + edge * std::sin((way - flat) / edge);
      z = edge * std::cos((way - flat) / edge) - edge;
    }
    if (dim == 2) return {around < 0.5 ? s : -s, 0, z};
    return {s * std::cos(two_pi * around), s * std::sin(two_pi * around), z};
  };
  return c;
}

inline ShapeCase ellipsoid(const int dim, const Point &semi, const bool encloses = false)
{
  Teuchos::ParameterList list;
  ShapeCase c = started("ellipsoid", dim, list);
  if (dim == 2) c.frame = {{{0.6, 0.8, 0}, {-0.8, 0.6, 0}, {0, 0, 1}}};
  list.set("Centre", numbers(c.place, dim));
  list.set("Axis", numbers(scaled(5, c.frame[0]), dim));
  if (dim == 3) list.set("Second Axis", numbers(scaled(2, c.frame[1]), dim));
  list.set("Semi-Axes", numbers(semi, dim));
  list.set("Encloses Body", encloses);
  c.encloses = encloses;
  c.obstacle = read_obstacle(list, dim);
  c.holds = [=](const Point &y) {
    double sum = 0;
    for (int k = 0; k < dim; ++k) sum += y[k] * y[k] / (semi[k] * semi[k]);
    return encloses ? sum > 1 : sum < 1;
  };
  c.at = [=](const double along, const double around) -> Point {
    const double up = two_pi / 2 * along, turn = two_pi * around;
    if (dim == 2) return {semi[0] * std::cos(2 * up), semi[1] * std::sin(2 * up), 0};
    return {semi[0] * std::cos(turn) * std::sin(up), semi[1] * std::sin(turn) * std::sin(up), semi[2] * std::cos(up)};
  };
  return c;
}

inline ShapeCase torus(const double radius, const double tube)
{
  Teuchos::ParameterList list;
  ShapeCase c = started("torus", 3, list);
  list.set("Centre", numbers(c.place, 3));
  list.set("Axis", numbers(scaled(4, c.frame[2]), 3));
  list.set("Radius", radius);
  list.set("Tube Radius", tube);
  c.obstacle = read_obstacle(list, 3);
  c.holds = [=](const Point &y) { return std::hypot(std::hypot(y[0], y[1]) - radius, y[2]) < tube; };
  c.at = [=](const double along, const double around) -> Point {
    const double s = radius + tube * std::cos(two_pi * along);
    return {s * std::cos(two_pi * around), s * std::sin(two_pi * around), tube * std::sin(two_pi * along)};
  };
  return c;
}

inline std::vector<ShapeCase> shape_cases()
{
  return {tip("cone", 3, 0.4, 0),
          tip("cone", 3, 2, 0.5),
          tip("cone", 2, 0.4, 0.3),
          tip("wedge", 3, 0.7, 0),
          tip("wedge", 3, 0.3, 1),
          tip("wedge", 2, 0.3, 0),
          flat_punch(3, 1.2, 0),
          flat_punch(3, 1.2, 0.4),
          flat_punch(2, 1.2, 0.4),
          flat_punch(3, 1, 1),
          ellipsoid(3, {1.5, 1, 0.7}),
          ellipsoid(3, {0.6, 1.4, 1.4}),
          ellipsoid(3, {1.5, 1, 0.7}, true),
          ellipsoid(2, {1.5, 0.6, 0}),
          ellipsoid(2, {0.6, 1.5, 0}, true),
          torus(1.3, 0.5),
          torus(1.3, 0.2)};
}

} // namespace rpc::test
