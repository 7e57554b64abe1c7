// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/kind.hpp"
#include "rpc/core/point.hpp"

#include <Teuchos_ParameterList.hpp>
#include <optional>

namespace rpc::contact
{

/// A sphere, in 2D a circle, about the obstacle's point. What it answers: see Surface.
struct Sphere {
  static constexpr const char *no_direction_at = "Centre";

  double radius = 0;     ///< [m]
  bool encloses = false; ///< the body lies inside of it, the foundation outside

  std::optional<Point> direction_into(const Point &x) const;
  bool lies_in(const Point &x) const;
  std::optional<double> distance_along(const Point &x, const Point &direction) const;

  static SurfaceKind kind();
  static Sphere read(const Teuchos::ParameterList &list, int dim, const std::string &path);
};

} // namespace rpc::contact
