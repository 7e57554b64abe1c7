// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/device_values.hpp"
#include "rpc/core/dofs.hpp"
#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc
{

/// Values on the host, (nodes, components).
using NodeValues = decltype(to_host(DeviceView<double **>()));

/// What a vector has at some nodes, on the host: the rest of it stays on the device.
/// @param v  (nodes of this rank * components)   @return (nodes.size(), components)
inline NodeValues values_at(const Vector &v, const std::vector<LO> &nodes, const int components)
{
  const auto node = device_values(nodes, "rpc::nodes");
  const auto from = device_read(v);
  const DeviceView<double **> found(Kokkos::view_alloc("rpc::values_at", Kokkos::WithoutInitializing), nodes.size(),
                                    components);
  Kokkos::parallel_for(
      "rpc::values_at", device_range(static_cast<LO>(nodes.size())), KOKKOS_LAMBDA(const LO i) {
        for (int c = 0; c < components; ++c) found(i, c) = from(dof(components, node(i), c));
      });
  return to_host(found);
}

} // namespace rpc
