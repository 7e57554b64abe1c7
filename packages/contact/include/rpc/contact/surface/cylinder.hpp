// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/kind.hpp"
#include "rpc/contact/surface/parameters.hpp"
#include "rpc/contact/surface/round.hpp"
#include "rpc/core/point.hpp"

#include <optional>

namespace rpc::contact
{

/// An endless cylinder in space; the obstacle's point lies on its axis. What it answers: see Surface.
struct Cylinder {
  static constexpr const char *point = "Point";
  static constexpr const char *no_direction_at = "Axis";
  static constexpr bool is_flat = false;

  Point axis{};          ///< unit
  double radius = 0;     ///< [m]
  bool encloses = false; ///< the body lies inside of it, the foundation outside

  std::optional<Point> direction_into(const Point &x) const { return direction_into_round(across(x), encloses); }
  bool lies_in(const Point &x) const { return lies_in_round(across(x), radius, encloses); }
  std::optional<double> distance_along(const Point &x, const Point &direction) const
  {
    return distance_along_round(across(x), across(direction), radius, encloses);
  }
  /// A vector without its part along the axis.
  Point across(const Point &v) const { return difference(v, scaled(inner(v, axis), axis)); }

  static SurfaceKind kind()
  {
    return {{"cylinder"},
            point,
            "a point on its axis",
            {{"Axis", Teuchos::Array<double>(), "the direction of its axis, of any length"},
             radius_parameter(),
             encloses_parameter()},
            "circle"};
  }
  static Cylinder read(const Teuchos::ParameterList &list, const int dim, const std::string &path)
  {
    const Point axis = unit_vector(list, "Axis", dim, path);
    return {axis, radius_of(list, path), list.get<bool>("Encloses Body")};
  }
};

} // namespace rpc::contact
