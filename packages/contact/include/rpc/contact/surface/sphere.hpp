// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/kind.hpp"
#include "rpc/contact/surface/parameters.hpp"
#include "rpc/contact/surface/round.hpp"
#include "rpc/core/point.hpp"

#include <optional>

namespace rpc::contact
{

/// A sphere, in 2D a circle, about the obstacle's point. What it answers: see Surface.
struct Sphere {
  static constexpr const char *point = "Centre";
  static constexpr const char *no_direction_at = "Centre";
  static constexpr bool is_flat = false;

  double radius = 0;     ///< [m]
  bool encloses = false; ///< the body lies inside of it, the foundation outside

  std::optional<Point> direction_into(const Point &x) const { return direction_into_round(x, encloses); }
  bool lies_in(const Point &x) const { return lies_in_round(x, radius, encloses); }
  std::optional<double> distance_along(const Point &x, const Point &direction) const
  {
    return distance_along_round(x, direction, radius, encloses);
  }

  static SurfaceKind kind()
  {
    return {{"sphere", "circle"}, point, "its centre", {radius_parameter(), encloses_parameter()}, ""};
  }
  static Sphere read(const Teuchos::ParameterList &list, int, const std::string &path)
  {
    return {radius_of(list, path), list.get<bool>("Encloses Body")};
  }
};

} // namespace rpc::contact
