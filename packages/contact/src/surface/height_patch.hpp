// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/height_grid.hpp"

#include <algorithm>
#include <array>
#include <limits>

/// The surface of a height grid over one of its cells.
namespace rpc::contact
{

/// A polynomial of degree 3 by its Bezier points, at t from 0 to 1: its value and two derivatives.
struct Cubic {
  std::array<double, 4> weight, slope, curvature;
};
inline std::array<double, 4> weights_at(const double t)
{
  const double s = 1 - t;
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}
inline Cubic cubic_at(const double t)
{
  const double s = 1 - t;
  return {weights_at(t),
          {-3 * s * s, 3 * s * (s - 2 * t), 3 * t * (2 * s - t), 3 * t * t},
          {6 * s, 6 * (t - 2 * s), 6 * (s - 2 * t), 6 * t}};
}

/// Bezier points of the Catmull-Rom spline between the second and the third of four values, or of a straight line.
inline std::array<double, 4> bezier_points(const std::array<double, 4> &p, const Interpolation interpolation)
{
  if (interpolation == Interpolation::bilinear) return {p[1], (2 * p[1] + p[2]) / 3, (p[1] + 2 * p[2]) / 3, p[2]};
  return {p[1], p[1] + (p[2] - p[0]) / 6, p[2] - (p[3] - p[1]) / 6, p[2]};
}

inline double outside(const double x, const Interval &of)
{
  return std::max({of.low - x, x - of.high, 0.});
}
inline double apart(const Interval &a, const Interval &b)
{
  return std::max({a.low - b.high, b.low - a.high, 0.});
}
inline Interval nothing_between()
{
  return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
}
inline Interval both(const Interval &a, const Interval &b)
{
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

/// The surface over a cell, by Bezier points; of a profile the first four alone.
struct HeightGrid::Patch {
  std::array<std::array<double, 4>, 4> point{}; // (along y, along x)
  int rows = 4;

  struct Jet {
    double height = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0; // derivatives by the place in the cell
  };
  Jet at(const double u, const double v) const
  {
    const Cubic x = cubic_at(u), y = rows == 1 ? Cubic{{1, 0, 0, 0}, {}, {}} : cubic_at(v);
    Jet jet;
    for (int b = 0; b < rows; ++b) {
      double value = 0, slope = 0, curvature = 0;
      for (int a = 0; a < 4; ++a) {
        value += x.weight[a] * point[b][a];
        slope += x.slope[a] * point[b][a];
        curvature += x.curvature[a] * point[b][a];
      }
      jet.height += y.weight[b] * value;
      jet.u += y.weight[b] * slope;
      jet.uu += y.weight[b] * curvature;
      jet.v += y.slope[b] * value;
      jet.uv += y.slope[b] * slope;
      jet.vv += y.curvature[b] * value;
    }
    return jet;
  }
  /// The same as at(u, v).height.
  double height(const double u, const double v) const
  {
    const auto x = weights_at(u), y = rows == 1 ? std::array<double, 4>{{1, 0, 0, 0}} : weights_at(v);
    double height = 0;
    for (int b = 0; b < rows; ++b) {
      double value = 0;
      for (int a = 0; a < 4; ++a) value += x[a] * point[b][a];
      height += y[b] * value;
    }
    return height;
  }
  Interval range() const
  {
    Interval all = nothing_between();
    for (int b = 0; b < rows; ++b)
      for (const double z : point[b]) all = both(all, {z, z});
    return all;
  }
};

} // namespace rpc::contact
