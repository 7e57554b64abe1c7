// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/kind.hpp"
#include "rpc/core/point.hpp"

#include <Teuchos_ParameterList.hpp>
#include <optional>

namespace rpc::contact
{

/// A plane, in 2D a straight line. What it answers: see Surface.
struct Plane {
  static constexpr const char *no_direction_at = "";

  Point normal{}; ///< unit, out of the foundation towards the body

  std::optional<Point> direction_into(const Point &x) const;
  bool lies_in(const Point &x) const;
  std::optional<double> distance_along(const Point &x, const Point &direction) const;

  static SurfaceKind kind();
  static Plane read(const Teuchos::ParameterList &list, int dim, const std::string &path);
};

} // namespace rpc::contact
