// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>

namespace rpc
{

/// A point in space or a direction; absent dimensions are 0 [m].
using Point = std::array<double, 3>;

inline double inner(const Point &a, const Point &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double length(const Point &a)
{
  return std::hypot(a[0], a[1], a[2]);
}
inline Point difference(const Point &a, const Point &b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point scaled(const double factor, const Point &a)
{
  return {factor * a[0], factor * a[1], factor * a[2]};
}
inline Point cross(const Point &a, const Point &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

} // namespace rpc
