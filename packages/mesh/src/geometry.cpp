// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/geometry.hpp"

#include "rpc/core/point.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::mesh
{
namespace
{

/// How far a point is from a shape, with the sign of its side, and which way leads away from it.
struct Distance {
  double value = 0; ///< [m]
  Point gradient{}; ///< of length 1; 0 where there is none, as in a sphere's centre
};

Distance from_middle(const Point &arm, const double radius)
{
  const double r = length(arm);
  return r > 0 ? Distance{r - radius, scaled(1 / r, arm)} : Distance{-radius, {}};
}

Distance distance_to(const BoundaryShape &shape, const Point &x)
{
  const Point arm = difference(x, shape.point);
  const double along = inner(arm, shape.direction);
  switch (shape.kind) {
  case BoundaryShape::Kind::flat:
    return {along, shape.direction};
  case BoundaryShape::Kind::sphere:
    return from_middle(arm, shape.radius);
  case BoundaryShape::Kind::cylinder:
    return from_middle(difference(arm, scaled(along, shape.direction)), shape.radius);
  case BoundaryShape::Kind::other:
    break;
  }
  return {};
}

/// One step towards all shapes.                                                                       doc/theory.md (2.17)
Point step_towards(const std::vector<BoundaryShape> &shapes, Point x)
{
  constexpr double parallel = 1e-4; // sin^2 of the angle between two of them that are taken one after the other
  const auto go = [&x](const double by, const Point &along) { x = difference(x, scaled(by, along)); };
  if (shapes.size() == 2) {
    const Distance a = distance_to(shapes[0], x), b = distance_to(shapes[1], x);
    const double cosine = inner(a.gradient, b.gradient), determinant = 1 - cosine * cosine;
    if (determinant > parallel && length(a.gradient) > 0 && length(b.gradient) > 0) {
      go((a.value - cosine * b.value) / determinant, a.gradient);
      go((b.value - cosine * a.value) / determinant, b.gradient);
      return x;
    }
  }
  for (const BoundaryShape &shape : shapes) {
    const Distance distance = distance_to(shape, x);
    go(distance.value, distance.gradient);
  }
  return x;
}

} // namespace

std::optional<std::array<double, 3>> nearest_point(const std::vector<BoundaryShape> &shapes, std::array<double, 3> x)
{
  constexpr int most_steps = 100;
  constexpr double tolerance = 1e-9; // of the way: what shapes are found to
  const Point start = x;
  const auto farthest = [&] {
    double value = 0;
    for (const BoundaryShape &shape : shapes) value = std::max(value, std::abs(distance_to(shape, x).value));
    return value;
  };
  double last = farthest();
  for (int step = 0; step < most_steps && last > 0; ++step) {
    const Point before = x;
    x = step_towards(shapes, x);
    const double now = farthest();
    if (!(now < last)) { // rounding is reached, or there is no progress
      x = before;
      break;
    }
    last = now;
  }
  double scale = length(difference(x, start));
  for (const BoundaryShape &shape : shapes) scale = std::max(scale, shape.radius);
  return last <= tolerance * scale || last == 0 ? std::optional<Point>(x) : std::nullopt;
}

} // namespace rpc::mesh
