// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/point.hpp"

#include <functional>
#include <optional>
#include <string>
#include <type_traits>

namespace rpc::contact
{

/// A shape that the foundation's surface may have. It answers for a point x, seen from the obstacle's `point`. Any struct with these members
/// converts to it:
///
///     direction_into(x), lies_in(x), distance_along(x, direction)      const; as the functions of the same names in obstacle.hpp
///     point                                                            the parameter that says where it is
///     no_direction_at                                                  the parameter that says where it has no direction; "": nowhere
///     is_flat                                                          whether a straight facet is nearest to it, or furthest in, at a corner
///     kind(), read(list, dim, path)                                    how a deck describes it, for those of the list `surfaces` alone
///
/// doc/extend.md has a new one step by step.
struct Surface {
  std::function<std::optional<Point>(const Point &x)> direction_into;
  std::function<bool(const Point &x)> lies_in;
  std::function<std::optional<double>(const Point &x, const Point &direction)> distance_along;
  std::string point, no_direction_at;
  bool is_flat;

  template <class Shape, class = std::enable_if_t<!std::is_same_v<Shape, Surface>, decltype(Shape::is_flat)>>
  Surface(const Shape &shape)
      : direction_into([shape](const Point &x) { return shape.direction_into(x); }),
        lies_in([shape](const Point &x) { return shape.lies_in(x); }),
        distance_along([shape](const Point &x, const Point &direction) { return shape.distance_along(x, direction); }),
        point(Shape::point), no_direction_at(Shape::no_direction_at), is_flat(Shape::is_flat)
  {
  }
};

} // namespace rpc::contact
