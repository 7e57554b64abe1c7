// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

#include <cstddef>
#include <string>

namespace rpc::fem
{

/// Exclusive prefix sum of counts (n) into offsets (n + 1).
template <class Count>
DeviceView<std::size_t *> offsets_of(const DeviceView<Count *> &count, const std::string &label)
{
  const LO n = static_cast<LO>(count.extent(0));
  DeviceView<std::size_t *> offset(label, n + 1);
  Kokkos::parallel_scan(
      "rpc::fem::offsets", device_range(n), KOKKOS_LAMBDA(const LO i, std::size_t &sum, const bool last) {
        sum += count(i);
        if (last) offset(i + 1) = sum;
      });
  return offset;
}

/// The sum of all counts; fences.
inline std::size_t last_of(const DeviceView<std::size_t *> &offset)
{
  std::size_t last = 0;
  Kokkos::deep_copy(last, Kokkos::subview(offset, offset.extent(0) - 1));
  return last;
}

} // namespace rpc::fem
