// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/point.hpp"

namespace rpc
{

/// An axis-parallel box; in the plane flat, at 0. Upside down: empty.
struct Bounds {
  Point lower, upper; // [m]

  /// Nothing.
  static Bounds empty();
  bool is_empty() const { return !(lower[0] <= upper[0]); }
  void add(const Point &x);
  void add(const Bounds &other);
  int longest() const; ///< the direction in which it is longest
  /// Square of the distance to a point, at least and at most [m^2]
  double nearest(const Point &x) const;
  double farthest(const Point &x) const;
  /// Whether the line through x meets it.
  bool meets_line(const Point &x, const Point &direction) const;
};

} // namespace rpc
