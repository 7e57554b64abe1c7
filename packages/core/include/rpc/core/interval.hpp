// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/point.hpp"

#include <limits>

namespace rpc
{

/// The numbers from `low` to `high`.
struct Interval {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();

  bool contains(const double x) const { return low <= x && x <= high; }
};

/// The points between two corners.
struct Box {
  Point low{}, high{}; ///< [m]
};

} // namespace rpc
