// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/node_points.hpp"

#include "rpc/core/device_values.hpp"

#include <algorithm>

namespace rpc
{

DeviceView<LO *> distinct_nodes(const std::vector<DeviceView<LO *>> &lists)
{
  std::vector<LO> nodes;
  for (const auto &list : lists) {
    const auto host = to_host(list);
    nodes.insert(nodes.end(), host.data(), host.data() + host.extent(0));
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return device_values(nodes, "rpc::algebra::distinct_nodes");
}

} // namespace rpc
