// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/rounding.hpp"
#include "rpc/contact/surface/kind.hpp"
#include "rpc/contact/surface/parameters.hpp"
#include "rpc/contact/surface/profile.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/point.hpp"

#include <cmath>
#include <optional>
#include <vector>

namespace rpc::contact
{

/// Where a polynomial changes its sign between two numbers, in order. A root that it only touches may be left out.
/// @param coefficients  of x^0, x^1, ...
inline std::vector<double> sign_changes(const std::vector<double> &coefficients, const double lower, const double upper)
{
  const auto at = [&](const double x) {
    double sum = 0;
    for (std::size_t k = coefficients.size(); k-- > 0;) sum = sum * x + coefficients[k];
    return sum;
  };
  std::vector<double> derivative, ends, roots;
  for (std::size_t k = 1; k < coefficients.size(); ++k) derivative.push_back(static_cast<double>(k) * coefficients[k]);
  if (derivative.size() > 1) ends = sign_changes(derivative, lower, upper); // in between it rises or falls
  ends.push_back(upper);
  double left = lower;
  for (const double end : ends) {
    double a = left, b = end;
    const bool rises = at(b) > 0;
    if (rises != (at(a) > 0)) {
      for (double middle = (a + b) / 2; middle > a && middle < b; middle = (a + b) / 2)
        ((at(middle) > 0) == rises ? b : a) = middle;
      roots.push_back(b);
    }
    left = end;
  }
  return roots;
}

/// A torus in space about the obstacle's point. What it answers: see Surface.
struct Torus {
  static constexpr const char *point = "Centre";
  static constexpr const char *no_direction_at = "Centre";
  static constexpr bool is_flat = false;

  Point axis{};      ///< unit
  double radius = 0; ///< of the circle in the middle of its tube [m]
  double tube = 0;   ///< radius of the tube, below `radius` [m]

  /// On the axis nothing is the nearest: there the axis stands for the normals all around, and leads through the hole.
  std::optional<Point> direction_into(const Point &x) const
  {
    const double z = inner(x, axis);
    const Point across = difference(x, scaled(z, axis));
    if (length(across) > Rounding::place * (length(x) + radius)) return direction_into_tube(x);
    if (!(std::abs(z) > Rounding::place * radius)) return std::nullopt;
    return scaled(z > 0 ? -1 : 1, axis);
  }
  bool lies_in(const Point &x) const { return length(from_tube(x)) < tube * (1 - Rounding::place); }
  /// |from_tube(x + g direction)| = tube is a polynomial of degree 4 in g.                                             (3.7b)
  std::optional<double> distance_along(const Point &x, const Point &direction) const
  {
    const double size = radius + tube, nearest = -inner(x, direction), big = radius / size, small = tube / size;
    Point m{}; // the line's point nearest to the centre, in units of size
    for (int c = 0; c < 3; ++c) m[c] = (x[c] + nearest * direction[c]) / size;
    const double square = inner(m, m), high = inner(m, axis), rise = inner(direction, axis);
    const double k = square + (big - small) * (big + small), four = 4 * big * big;
    const bool inside = lies_in(x);
    std::optional<double> found;
    for (const double s : sign_changes(
             {k * k - four * (square - high * high), 2 * four * high * rise, 2 * k - four * (1 - rise * rise), 0, 1},
             -2, 2)) {
      const double g = on_surface(nearest + s * size, x, direction);
      const Point from = from_tube(at(x, direction, g));
      const double descent = -inner(from, direction) / length(from);
      if (!(descent > Rounding::place)) continue; // the line leaves the foundation
      const bool behind = g * descent < -2 * Rounding::place * tube;
      if (inside ? g <= 0 : !behind && !found) found = g;
    }
    return found;
  }

  static SurfaceKind kind()
  {
    return {{"torus"},
            point,
            "its centre",
            {{"Axis", Teuchos::Array<double>(), "the direction of its axis, of any length"},
             {"Radius", 0., "that of the circle in the middle of its tube, > 0 [m]"},
             {"Tube Radius", 0., "that of its tube, > 0, below `Radius` [m]"}},
            "circle"};
  }
  static Torus read(const Teuchos::ParameterList &list, const int dim, const std::string &path)
  {
    const Torus shape{unit_vector(list, "Axis", dim, path), radius_of(list, path),
                      positive_of(list, "Tube Radius", path)};
    RPC_REQUIRE(shape.tube < shape.radius, "deck: \"" << path << "->Tube Radius\" must be below \"" << path
                                                      << "->Radius\" = " << shape.radius << " [m], got " << shape.tube);
    return shape;
  }

private:
  static Point at(const Point &x, const Point &direction, const double g)
  {
    return {x[0] + g * direction[0], x[1] + g * direction[1], x[2] + g * direction[2]};
  }
  /// From the point of the circle in the middle of the tube that is nearest to x.
  Point from_tube(const Point &x) const
  {
    const Point across = difference(x, scaled(inner(x, axis), axis));
    const double s = length(across);
    return s > 0 ? difference(x, scaled(radius / s, across)) : Point{radius, inner(x, axis), 0};
  }
  std::optional<Point> direction_into_tube(const Point &x) const
  {
    const Point from = from_tube(x);
    if (!(length(from) > Rounding::place * radius)) return std::nullopt;
    return scaled(-1 / length(from), from);
  }
  /// A root without what rounding adds to it, by Newton's method.
  double on_surface(double g, const Point &x, const Point &direction) const
  {
    for (int step = 0; step < 3; ++step) {
      const Point from = from_tube(at(x, direction, g));
      const double distance = length(from), rate = inner(from, direction) / distance;
      if (!(std::abs(rate) > 0.01)) break; // it nearly touches, and a step may lead astray
      g -= (distance - tube) / rate;
    }
    return g;
  }
};

} // namespace rpc::contact
