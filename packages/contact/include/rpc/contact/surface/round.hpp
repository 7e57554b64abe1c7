// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/rounding.hpp"
#include "rpc/core/point.hpp"

#include <cmath>
#include <optional>

/// What sphere and cylinder have in common, in the vectors `from` their centre or, across it, from their axis.
namespace rpc::contact
{

inline std::optional<Point> direction_into_round(const Point &from, const bool encloses)
{
  const double distance = length(from);
  if (!(distance > 0)) return std::nullopt;
  return scaled((encloses ? 1 : -1) / distance, from);
}

inline bool lies_in_round(const Point &from, const double radius, const bool encloses)
{
  const double beyond = length(from) - radius;
  return (encloses ? beyond : -beyond) > Rounding::place * radius;
}

/// |from + g way| = radius: the root g that crosses the surface from the body's part of space.        (3.7)
/// @param way  of a cylinder, the direction across its axis
inline std::optional<double> distance_along_round(const Point &from, const Point &way, const double radius,
                                                  const bool encloses)
{
  const double square = inner(way, way);
  if (!(square > Rounding::place * Rounding::place)) return std::nullopt; // along the axis
  const bool inside = lies_in_round(from, radius, encloses);
  const double along = inner(from, way);
  double discriminant = along * along - square * (inner(from, from) - radius * radius);
  // A tangent meets the surface that encloses its point, whatever the rounding.
  if (encloses && discriminant < 0 && !inside) discriminant = 0;
  const bool leads_in = encloses || along < 0 || inside;
  if (!(discriminant >= 0) || !leads_in) return std::nullopt;
  const double root = std::sqrt(discriminant);
  return ((encloses ? root : -root) - along) / square;
}

} // namespace rpc::contact
