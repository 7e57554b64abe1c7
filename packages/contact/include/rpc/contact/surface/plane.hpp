// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/rounding.hpp"
#include "rpc/contact/surface/kind.hpp"
#include "rpc/contact/surface/parameters.hpp"
#include "rpc/core/point.hpp"

#include <optional>

namespace rpc::contact
{

/// A plane, in 2D a straight line. What it answers: see Surface.
struct Plane {
  static constexpr const char *point = "Point";
  static constexpr const char *no_direction_at = "";
  static constexpr bool is_flat = true;

  Point normal{}; ///< unit, out of the foundation towards the body

  std::optional<Point> direction_into(const Point &) const { return scaled(-1, normal); }
  bool lies_in(const Point &x) const { return inner(x, normal) < -Rounding::place * length(x); }
  std::optional<double> distance_along(const Point &x, const Point &direction) const
  {
    const double descent = -inner(direction, normal);
    if (!(descent > Rounding::place)) return std::nullopt;
    return inner(x, normal) / descent;
  }

  static SurfaceKind kind()
  {
    return {{"plane"},
            point,
            "a point on it",
            {{"Normal", Teuchos::Array<double>(), "its normal, out of the foundation towards the body, of any length"}},
            ""};
  }
  static Plane read(const Teuchos::ParameterList &list, const int dim, const std::string &path)
  {
    return {unit_vector(list, "Normal", dim, path)};
  }
};

} // namespace rpc::contact
