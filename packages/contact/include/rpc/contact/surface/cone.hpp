// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/rounding.hpp"
#include "rpc/contact/surface/kind.hpp"
#include "rpc/contact/surface/parameters.hpp"
#include "rpc/contact/surface/profile.hpp"
#include "rpc/core/point.hpp"

#include <optional>

namespace rpc::contact
{

/// An endless cone, in 2D its section; the obstacle's point is its tip, rounded or not. What it answers: see Surface.
struct Cone {
  static constexpr const char *point = "Point";
  static constexpr const char *no_direction_at = ""; // on the axis its direction stands for those all around
  static constexpr bool is_flat = false;

  Point axis{};          ///< unit, out of the foundation
  double slope = 0;      ///< > 0
  double tip_radius = 0; ///< [m]

  NearestOnSurface nearest(const Point &x) const
  {
    return nearest_to_rounded(x, axis, tip_radius,
                              [this](const double s, const double z) { return nearest_to_tip(s, z, slope); });
  }
  std::optional<Point> direction_into(const Point &x) const { return scaled(-1, nearest(x).out); }
  bool lies_in(const Point &x) const { return nearest(x).distance < -Rounding::place * length(x); }
  std::optional<double> distance_along(const Point &x, const Point &direction) const
  {
    return distance_along_convex(*this, x, direction);
  }

  static SurfaceKind kind()
  {
    return {{"cone"},
            point,
            "its tip",
            {{"Axis", Teuchos::Array<double>(),
              "where its tip points, out of the foundation towards the body, of any length"},
             {"Slope", 0., "what its sides fall by per length across the axis, > 0 [-]"},
             {"Tip Radius", 0., "that of the ball that rounds its tip [m]; 0: sharp"}},
            ""};
  }
  static Cone read(const Teuchos::ParameterList &list, const int dim, const std::string &path)
  {
    return {unit_vector(list, "Axis", dim, path), positive_of(list, "Slope", path, "[-]"),
            rounding_of(list, "Tip Radius", path)};
  }
};

} // namespace rpc::contact
