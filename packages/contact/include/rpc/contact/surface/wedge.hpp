// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/rounding.hpp"
#include "rpc/contact/surface/kind.hpp"
#include "rpc/contact/surface/parameters.hpp"
#include "rpc/contact/surface/profile.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/point.hpp"

#include <optional>

namespace rpc::contact
{

/// An endless wedge; the obstacle's point lies on its edge, rounded or not. What it answers: see Surface.
struct Wedge {
  static constexpr const char *point = "Point";
  static constexpr const char *no_direction_at = ""; // below the edge the normal stands for those of both sides
  static constexpr bool is_flat = false;

  Point normal{};         ///< unit, out of the foundation, in the middle between its sides
  double slope = 0;       ///< > 0
  double edge_radius = 0; ///< [m]
  Point axis{};           ///< along its edge: unit, at right angles to the normal; 0 in 2D

  NearestOnSurface nearest(const Point &x) const
  {
    return nearest_to_rounded(difference(x, scaled(inner(x, axis), axis)), normal, edge_radius,
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
    return {{"wedge"},
            point,
            "a point on its edge",
            {{"Normal", Teuchos::Array<double>(),
              "where its edge points, out of the foundation towards the body, of any length"},
             {"Slope", 0., "what its sides fall by per length across the normal, > 0 [-]"},
             {"Axis", Teuchos::Array<double>(), "in 3D, the direction of its edge, of any length"},
             {"Edge Radius", 0., "that of the cylinder that rounds its edge [m]; 0: sharp"}},
            ""};
  }
  static Wedge read(const Teuchos::ParameterList &list, const int dim, const std::string &path)
  {
    Point axis{}, normal = unit_vector(list, "Normal", dim, path);
    if (dim == 3) {
      axis = unit_vector(list, "Axis", dim, path);
      const Point across = difference(normal, scaled(inner(normal, axis), axis));
      RPC_REQUIRE(length(across) > Rounding::place,
                  "deck: \"" << path << "->Normal\" must lead across \"" << path
                             << "->Axis\", got the same direction. \"Axis\" is that of the wedge's edge.");
      normal = scaled(1 / length(across), across);
    } else {
      RPC_REQUIRE(list.get<Teuchos::Array<double>>("Axis").empty(),
                  "deck: \"" << path
                             << "->Axis\" goes with a wedge in space; in the plane its edge is a point. Remove it.");
    }
    return {normal, positive_of(list, "Slope", path, "[-]"), rounding_of(list, "Edge Radius", path), axis};
  }
};

} // namespace rpc::contact
