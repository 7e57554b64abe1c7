// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/result.hpp"

namespace rpc::contact
{

/// Where the contact pressure is largest.
struct HighestPressure {
  /// Of the largest pressure: points that have this share of it have it too, as those that yield, or those of a symmetric body. What solves leave
  /// is less.
  static constexpr double share = 1 - 1e-6;

  GO num_places = 0; ///< nodes that have it, over all ranks; 0: nothing is pressed
  Point place{};     ///< of the undeformed body [m], of these the one with the smallest x, then y, then z
  int side = 0;      ///< which contact side
};

/// Collective. @param c  the points of the result
HighestPressure highest_pressure(const fem::Discretization &d, const ContactNodes &c, const ContactResult &result);

} // namespace rpc::contact
