// SPDX-License-Identifier: BSD-3-Clause
#include "cell_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace rpc::bound
{

Kinds kinds_of_cells(const Comm &comm, const DeviceView<double **> &coords, const DeviceView<LO **> &cells,
                     const DeviceView<int *> &block, const int vertices)
{
  constexpr double equal = 1e-11; // of the body: what rounding may make of coordinates
  const auto x = to_host(coords);
  const auto node = to_host(cells);
  const auto material = to_host(block);
  const int dim = static_cast<int>(x.extent(1));
  double size = 0;
  for (int d = 0; d < dim; ++d) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < x.extent(0); ++i) {
      low = std::min(low, x(i, d));
      high = std::max(high, x(i, d));
    }
    size = std::max(size, max_all(comm, high) - min_all(comm, low));
  }
  const LO count = static_cast<LO>(node.extent(0));
  Kinds kinds = all_different(count);
  const auto kind = Kokkos::create_mirror_view(kinds.kind);
  Found<long long> found;
  std::vector<long long> key;
  for (LO c = 0; c < count; ++c) {
    key.assign(1, material(c));
    for (int v = 1; v < vertices; ++v)
      for (int d = 0; d < dim; ++d) key.push_back(std::llround((x(node(c, v), d) - x(node(c, 0), d)) / (equal * size)));
    kind(c) = found(key, c);
  }
  Kokkos::deep_copy(kinds.kind, kind);
  kinds.example = device_values(found.example, "rpc::bound::example");
  return kinds;
}

Kinds all_different(const LO count)
{
  std::vector<int> each(count);
  std::iota(each.begin(), each.end(), 0);
  return {device_values(each, "rpc::bound::kind"),
          device_values(std::vector<LO>(each.begin(), each.end()), "rpc::bound::example")};
}

} // namespace rpc::bound
