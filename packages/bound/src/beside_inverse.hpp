// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/math.hpp"

namespace rpc::bound
{

/// Of circles around the axis.
struct Circle {
  static constexpr double pi = 3.14159265358979323846;
};

/// Of polynomials beside 1/r.
struct BesideInverse {
  static constexpr int touching =
      3; ///< places inside the interval where one from above touches it; the degree is 2 touching + 1
};

/// A polynomial of degree 2 n + 1 in x that is nowhere below, or nowhere above, 1/x on [a, b], n = BesideInverse::touching: with places x_i,
/// those inside [a, b] twice, it is (1 - prod (1 - x/x_i))/x.                                             doc/bounds.md (13.10c)
KOKKOS_INLINE_FUNCTION double beside_inverse(const double x, const double a, const double b, const bool above)
{
  const int n = BesideInverse::touching + (above ? 0 : 1);
  double product = above ? (1 - x / a) * (1 - x / b) : 1;
  for (int i = 0; i < n; ++i) {
    const double place = (a + b) / 2 + (b - a) / 2 * math::cos(Circle::pi * (2 * i + 1) / (2 * n)),
                 factor = 1 - x / place;
    product *= factor * factor;
  }
  return (1 - product) / x;
}

} // namespace rpc::bound
