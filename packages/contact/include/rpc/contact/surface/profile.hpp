// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/rounding.hpp"
#include "rpc/core/point.hpp"

#include <cmath>
#include <limits>
#include <optional>

/// What cone, wedge and flat punch have in common: a convex profile that is alike on both sides of an axis, all around it in space, and rounded.
namespace rpc::contact
{

/// Of a surface, seen from a place.
struct NearestOnSurface {
  double distance = 0; ///< [m], < 0 in the foundation
  Point out{};         ///< unit normal out of the foundation, at the point nearest to the place
};

/// The same in the profile's plane: across the axis, away from it, and along it, out of the foundation.
struct NearestInProfile {
  double distance = 0;
  double across = 0, along = 0; ///< of the normal
};

/// Two sides that fall by `slope` away from the tip at (0, 0).
/// @param s  distance from the axis, >= 0 [m]   @param z  along the axis [m]
inline NearestInProfile nearest_to_tip(const double s, const double z, const double slope)
{
  const double size = std::hypot(slope, 1), from_tip = std::hypot(s, z);
  if (s - slope * z < 0) return {from_tip, s / from_tip, z / from_tip};
  return {(slope * s + z) / size, slope / size, 1 / size};
}

/// A face from (0, 0) to (half_width, 0), where a side goes down along the axis.
inline NearestInProfile nearest_to_end(const double s, const double z, const double half_width)
{
  const double beside = s - half_width, from_edge = std::hypot(beside, z);
  if (beside > 0 && z > 0) return {from_edge, beside / from_edge, z / from_edge};
  return z >= beside ? NearestInProfile{z, 0, 1} : NearestInProfile{beside, 1, 0};
}

/// Of a profile that is rounded: what its core answers, with a layer of the thickness of the radius around it.        (3.6b)
/// @param x       seen from where the axis leaves the rounded surface
/// @param axis    unit, out of the foundation
/// @param radius  >= 0 [m]
/// @param core    answers of (s, z) as nearest_to_tip
template <class Core>
NearestOnSurface nearest_to_rounded(const Point &x, const Point &axis, const double radius, const Core &core)
{
  const double z = inner(x, axis);
  const Point across = difference(x, scaled(z, axis));
  const double s = length(across);
  const NearestInProfile found = core(s, z + radius);
  NearestOnSurface nearest{found.distance - radius, axis};
  if (!(s > Rounding::place * length(x))) return nearest; // all around the axis alike
  for (int c = 0; c < 3; ++c) nearest.out[c] = found.across * across[c] / s + found.along * axis[c];
  return nearest;
}

/// Along a line the distance to a convex foundation is a convex function: Newton's method goes from outside to where the line enters, and never
/// beyond.                                                                                                          (3.7a)
/// @param shape  with nearest(x) and lies_in(x)   @param direction  unit
template <class Shape>
std::optional<double> distance_along_convex(const Shape &shape, const Point &x, const Point &direction)
{
  constexpr int most_steps = 200; // a line that touches the surface takes a step for each bit
  const auto at = [&](const double g) {
    return shape.nearest({x[0] + g * direction[0], x[1] + g * direction[1], x[2] + g * direction[2]});
  };
  double g = 0;
  if (shape.lies_in(x)) { // back to where the line is outside
    const double depth = -shape.nearest(x).distance;
    for (g = -depth; !(at(g).distance > 0); g *= 2)
      if (-g > depth / Rounding::place) return std::nullopt;
  }
  for (int step = 0; step < most_steps; ++step) {
    const NearestOnSurface here = at(g);
    const double descent = -inner(here.out, direction);
    if (!(descent > Rounding::place)) return std::nullopt;
    const double way = here.distance / descent;
    g += way;
    if (!(std::abs(way) > std::numeric_limits<double>::epsilon() * (std::abs(g) + length(x)))) break;
  }
  return g;
}

} // namespace rpc::contact
