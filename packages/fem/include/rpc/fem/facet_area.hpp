// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

namespace rpc::fem
{

/// The area of a facet [m^(dim-1), axisymmetric: m^2].
/// @param measure  of the points of a side, see facet_measure()   @param points  of a facet
KOKKOS_INLINE_FUNCTION double facet_area(const DeviceView<double *> &measure, const int points, const LO facet)
{
  double area = 0;
  for (int q = 0; q < points; ++q) area += measure(facet * points + q);
  return area;
}

} // namespace rpc::fem
