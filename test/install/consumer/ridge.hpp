// SPDX-License-Identifier: BSD-3-Clause
// An obstacle that the library does not have, doc/extend.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <rpc/core/point.hpp>

/// A roof that slopes down on both sides of its ridge, which goes through the obstacle's point along z: y < -slope |x| is the foundation.
struct Ridge {
  static constexpr const char *point = "Point";      // the parameter of a deck that says where it is
  static constexpr const char *no_direction_at = ""; // there is a normal everywhere outside
  static constexpr bool is_flat = false;

  double slope = 0; // > 0

  /// Of the roof's right (+1) or left (-1) side: unit, out of the foundation.
  rpc::Point normal(const int side) const
  {
    const double size = std::hypot(slope, 1);
    return {side * slope / size, 1 / size, 0};
  }
  std::optional<rpc::Point> direction_into(const rpc::Point &x) const
  {
    const rpc::Point n = normal(x[0] < 0 ? -1 : 1);
    const rpc::Point foot = rpc::difference(x, rpc::scaled(rpc::inner(x, n), n)); // on that side, or beyond the ridge
    const double distance = std::hypot(x[0], x[1]);
    if (foot[0] * x[0] >= 0 || !(distance > 0)) return rpc::scaled(-1, n);
    return rpc::Point{-x[0] / distance, -x[1] / distance, 0};
  }
  bool lies_in(const rpc::Point &x) const { return x[1] < -slope * std::abs(x[0]) - 1e-9 * rpc::length(x); }
  std::optional<double> distance_along(const rpc::Point &x, const rpc::Point &direction) const
  {
    double enters = -std::numeric_limits<double>::infinity(), leaves = -enters;
    for (const int side : {-1, 1}) {
      const double high = rpc::inner(x, normal(side)), descent = -rpc::inner(direction, normal(side));
      if (descent > 0)
        enters = std::max(enters, high / descent);
      else if (descent < 0)
        leaves = std::min(leaves, high / descent);
      else if (high > 0)
        return std::nullopt;
    }
    if (!std::isfinite(enters) || enters > leaves) return std::nullopt;
    return enters;
  }
};
