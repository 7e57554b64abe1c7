// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/kind.hpp"
#include "rpc/contact/surface/parameters.hpp"
#include "rpc/contact/surface/round.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace rpc::contact
{

/// An ellipsoid, in 2D an ellipse, about the obstacle's point. What it answers: see Surface.
struct Ellipsoid {
  static constexpr const char *point = "Centre";
  static constexpr const char *no_direction_at = "Centre";
  static constexpr bool is_flat = false;

  std::array<Point, 3> axes{}; ///< unit, at right angles to each other
  Point semi_axes{};           ///< > 0 [m]; in 2D the third is the larger one of the others
  bool encloses = false;       ///< the body lies inside of it, the foundation outside

  /// The nearest point is e_i^2 y_i/(t + e_i^2), with the largest t for which it lies on the surface.                  (3.6a)
  std::optional<Point> direction_into(const Point &x) const
  {
    const Point y = along_axes(x);
    const double least = *std::min_element(semi_axes.begin(), semi_axes.end());
    Point beyond{};   // e_i^2 - least^2
    double shift = 0; // t + least^2, from below: each term of the sum alone is at most 1 there
    for (int i = 0; i < 3; ++i) {
      beyond[i] = (semi_axes[i] - least) * (semi_axes[i] + least);
      shift = std::max(shift, semi_axes[i] * std::abs(y[i]) - beyond[i]);
    }
    constexpr int most_steps =
        100; // a decreasing convex function: Newton's method goes up to its root, and never beyond
    for (int step = 0; step < most_steps; ++step) {
      double excess = -1, slope = 0;
      for (int i = 0; i < 3; ++i) {
        if (y[i] == 0) continue;
        const double term = semi_axes[i] * y[i] / (shift + beyond[i]);
        excess += term * term;
        slope -= 2 * term * term / (shift + beyond[i]);
      }
      if (shift == 0 && !(excess >= 0))
        return std::nullopt; // between points that are as near, on both sides of a shortest axis
      const double way = -excess / slope;
      shift += way;
      if (!(way > std::numeric_limits<double>::epsilon() * shift)) break;
    }
    Point normal{};
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < 3 && y[i] != 0; ++c) normal[c] += y[i] / (shift + beyond[i]) * axes[i][c];
    return direction_into_round(normal, encloses);
  }
  bool lies_in(const Point &x) const { return lies_in_round(seen_as_ball(x), 1, encloses); }
  std::optional<double> distance_along(const Point &x, const Point &direction) const
  {
    return distance_along_round(seen_as_ball(x), seen_as_ball(direction), 1, encloses);
  }
  Point along_axes(const Point &v) const { return {inner(v, axes[0]), inner(v, axes[1]), inner(v, axes[2])}; }
  /// In lengths of its semi-axes.
  Point seen_as_ball(const Point &v) const
  {
    const Point y = along_axes(v);
    return {y[0] / semi_axes[0], y[1] / semi_axes[1], y[2] / semi_axes[2]};
  }

  static SurfaceKind kind()
  {
    return {{"ellipsoid", "ellipse"},
            point,
            "its centre",
            {{"Semi-Axes", Teuchos::Array<double>(), "half its lengths, one for each direction, > 0 [m]"},
             {"Axis", Teuchos::Array<double>(), "the direction of its first semi-axis, of any length; by default x"},
             {"Second Axis", Teuchos::Array<double>(),
              "in 3D, the direction of its second semi-axis, at right angles to `Axis`, of any length; by default y"},
             encloses_parameter()},
            ""};
  }
  static Ellipsoid read(const Teuchos::ParameterList &list, const int dim, const std::string &path)
  {
    const auto &numbers = list.get<Teuchos::Array<double>>("Semi-Axes");
    RPC_REQUIRE(numbers.size() == dim,
                "deck: \"" << path << "->Semi-Axes\" must hold " << dim << " numbers, got " << numbers.size());
    Ellipsoid shape;
    for (int c = 0; c < dim; ++c) {
      RPC_REQUIRE(numbers[c] > 0 && std::isfinite(numbers[c]),
                  "deck: \"" << path << "->Semi-Axes\" must be > 0 and finite [m], got " << numbers[c]);
      shape.semi_axes[c] = numbers[c];
    }
    if (dim == 2) shape.semi_axes[2] = std::max(numbers[0], numbers[1]);
    shape.axes = orthonormal_axes(list, dim, path);
    shape.encloses = list.get<bool>("Encloses Body");
    return shape;
  }
};

} // namespace rpc::contact
