// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

#include <algorithm>
#include <string>
#include <vector>

/// Plain arrays as the views of a mesh.
namespace rpc::mesh
{

template <class T, class Value>
HostView<T *> host_array(const std::string &label, const std::vector<Value> &values)
{
  HostView<T *> view(label, values.size());
  std::copy(values.begin(), values.end(), view.data());
  return view;
}

/// @param values  (rows, width), row by row
template <class T>
DeviceView<T **> device_table(const std::string &label, const std::vector<T> &values, const int width)
{
  DeviceView<T **> table(label, values.size() / width, width);
  const auto host = Kokkos::create_mirror_view(table);
  for (std::size_t k = 0; k < values.size(); ++k) host(k / width, k % width) = values[k];
  Kokkos::deep_copy(table, host);
  return table;
}

} // namespace rpc::mesh
