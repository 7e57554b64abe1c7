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

/// A round punch with a flat face and an endless shank, in 2D a strip; its edge may be rounded. The obstacle's point is the middle of the face. What it
/// answers: see Surface.
struct FlatPunch {
  static constexpr const char *point = "Point";
  static constexpr const char *no_direction_at = ""; // on the axis of the shank the normal stands for those all around
  static constexpr bool is_flat = false;

  Point normal{};         ///< unit, of the face, out of the foundation
  double radius = 0;      ///< of the shank [m]
  double edge_radius = 0; ///< at most `radius` [m]

  NearestOnSurface nearest(const Point &x) const
  {
    return nearest_to_rounded(x, normal, edge_radius, [this](const double s, const double z) {
      return nearest_to_end(s, z, radius - edge_radius);
    });
  }
  std::optional<Point> direction_into(const Point &x) const { return scaled(-1, nearest(x).out); }
  bool lies_in(const Point &x) const { return nearest(x).distance < -Rounding::place * radius; }
  std::optional<double> distance_along(const Point &x, const Point &direction) const
  {
    return distance_along_convex(*this, x, direction);
  }

  static SurfaceKind kind()
  {
    return {{"flat punch"},
            point,
            "the middle of its face",
            {{"Normal", Teuchos::Array<double>(),
              "that of its face, out of the foundation towards the body, of any length"},
             {"Radius", 0., "that of its shank, in 2D half its width, > 0 [m]"},
             {"Edge Radius", 0.,
              "by which its edge is rounded, at most `Radius`: the face is flat up to their difference [m]; 0: sharp"}},
            ""};
  }
  static FlatPunch read(const Teuchos::ParameterList &list, const int dim, const std::string &path)
  {
    const FlatPunch punch{unit_vector(list, "Normal", dim, path), radius_of(list, path),
                          rounding_of(list, "Edge Radius", path)};
    RPC_REQUIRE(punch.edge_radius <= punch.radius, "deck: \"" << path << "->Edge Radius\" must be at most \"" << path
                                                              << "->Radius\" = " << punch.radius << " [m], got "
                                                              << punch.edge_radius);
    return punch;
  }
};

} // namespace rpc::contact
