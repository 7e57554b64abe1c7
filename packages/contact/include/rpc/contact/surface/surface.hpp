// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/bounds.hpp"
#include "rpc/core/point.hpp"

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace rpc::contact
{

/// What is known of a surface that may have more detail than a mesh.
struct SurfaceDetail {
  double spacing = 0; ///< of the places by which its shape is given [m]
  /// A lower bound on how far the places of a box, seen from the obstacle's `point`, are from the foundation [m]; 0 where one may lie in it.
  std::function<double(const Bounds &)> clearance;
  std::function<std::string(const std::string &unit)> told; ///< what it is, for users; of the unit of length
};

/// A shape that the foundation's surface may have. It answers for a point x, seen from the obstacle's `point`. Any struct with these members
/// converts to it:
///
///     direction_into(x), lies_in(x), distance_along(x, direction)      const; as the functions of the same names in obstacle.hpp
///     point                                                            the parameter that says where it is
///     no_direction_at                                                  the parameter that says where it has no direction; "": nowhere
///     is_flat                                                          whether a straight facet is nearest to it, or furthest in, at a corner
///     detail()                                                         const; a SurfaceDetail; may be missing
///     kind(), read(list, dim, path)                                    how a deck describes it, for those of the list `surfaces` alone
///
/// doc/extend.md has a new one step by step.
struct Surface {
  std::function<std::optional<Point>(const Point &x)> direction_into;
  std::function<bool(const Point &x)> lies_in;
  std::function<std::optional<double>(const Point &x, const Point &direction)> distance_along;
  std::string point, no_direction_at;
  bool is_flat;
  std::optional<SurfaceDetail> detail = {}; ///< nothing: it is smooth

  template <class Shape, class = std::enable_if_t<!std::is_same_v<Shape, Surface>, decltype(Shape::is_flat)>>
  Surface(const Shape &shape)
      : direction_into([shape](const Point &x) { return shape.direction_into(x); }),
        lies_in([shape](const Point &x) { return shape.lies_in(x); }),
        distance_along([shape](const Point &x, const Point &direction) { return shape.distance_along(x, direction); }),
        point(Shape::point), no_direction_at(Shape::no_direction_at), is_flat(Shape::is_flat)
  {
    if constexpr (has_detail<Shape>(0)) detail = shape.detail();
  }

private:
  template <class Shape>
  static constexpr auto has_detail(int) -> decltype(std::declval<const Shape &>().detail(), true)
  {
    return true;
  }
  template <class Shape>
  static constexpr bool has_detail(long)
  {
    return false;
  }
};

} // namespace rpc::contact
