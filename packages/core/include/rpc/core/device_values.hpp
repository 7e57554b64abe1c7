// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace rpc
{

/// (n) A vector's copy on the device; fences.
template <class T>
DeviceView<T *> device_values(const std::vector<T> &values, const std::string &label)
{
  HostView<T *> host(Kokkos::view_alloc(label, Kokkos::WithoutInitializing), values.size());
  std::copy(values.begin(), values.end(), host.data());
  return to_device(host);
}

} // namespace rpc
