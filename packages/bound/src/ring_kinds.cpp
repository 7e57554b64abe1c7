// SPDX-License-Identifier: BSD-3-Clause
#include "ring_kinds.hpp"

#include <map>

namespace rpc::bound
{

DeviceView<unsigned char *> free_components(const SpaceInput &in, const BoundaryTractions &boundary,
                                            const SlotExchange &of_facets)
{
  constexpr double straight = 1e-12;
  DeviceView<unsigned char *> free("rpc::bound::free", in.facets.size());
  Kokkos::parallel_for(
      "rpc::bound::free_components", device_range(in.facets.size()), KOKKOS_LAMBDA(const LO f) {
        int components = 7, axis = 3;
        if (in.facets.on_boundary(f)) {
          const FacetFrame frame(in, f);
          components = 0;
          double size = 0;
          for (int i = 0; i < 3; ++i) {
            if (!boundary.known(f, i)) components |= 1 << i;
            size = math::fmax(size, math::magnitude(frame.normal[i]));
          }
          for (int i = 0; i < 3; ++i)
            if (math::magnitude(frame.normal[(i + 1) % 3]) + math::magnitude(frame.normal[(i + 2) % 3]) <=
                straight * size)
              axis = i;
        }
        free(f) = static_cast<unsigned char>(components | axis << 3);
      });
  // What is known of a facet without a vertex of this rank another one tells.
  const auto served = of_facets.served();
  const DeviceView<double **> told("rpc::bound::told", served.extent(0), 1);
  Kokkos::parallel_for(
      "rpc::bound::tell_free_components", device_range(static_cast<LO>(served.extent(0))),
      KOKKOS_LAMBDA(const LO k) { told(k, 0) = free(served(k, 0)); });
  const DeviceView<double **> fetched = of_facets.fetched(told);
  const SlotExchange::Rows &row = of_facets.rows();
  Kokkos::parallel_for(
      "rpc::bound::take_free_components", device_range(in.facets.size()), KOKKOS_LAMBDA(const LO f) {
        if (row(f, 0) >= 0) free(f) = static_cast<unsigned char>(fetched(row(f, 0), 0));
      });
  Kokkos::fence();
  return free;
}

RingKinds ring_kinds(const SpaceInput &in, const DeviceView<unsigned char *> &free)
{
  const auto cells = to_host(in.facets.ring_cell), facets = to_host(in.facets.ring_facet);
  const auto toward = to_host(in.facets.toward);
  const auto first = to_host(in.facets.first);
  const auto count = to_host(in.facets.num_ring_facets), of_cell = to_host(in.kind);
  const auto cell = to_host(in.facets.cell);
  const auto ordinal = to_host(in.facets.ordinal);
  const auto on_host = to_host(free);
  RingKinds kinds;
  kinds.kind = DeviceView<int *>("rpc::bound::kind", in.facets.num_rings());
  const auto kind = Kokkos::create_mirror_view(kinds.kind);
  std::map<std::vector<int>, int> found;
  std::vector<int> key;
  const bool all_differ = 2 * in.example.extent(0) > static_cast<std::size_t>(in.num_cells());
  for (LO ring = 0; ring < in.facets.num_rings(); ++ring) {
    key.clear();
    if (all_differ) {
      kind(ring) = ring;
      kinds.example.push_back(ring);
      continue;
    }
    const std::size_t begin = first(ring);
    const int n = static_cast<int>(first(ring + 1) - begin);
    for (int k = 0; k < count(ring); ++k) {
      const LO f = facets(begin + ring + k);
      if (k < n) {
        const LO c = cells(begin + k);
        key.push_back(of_cell(c));
        key.push_back(ordinal(f, cell(f, 0) == c ? 0 : 1));
      }
      if (k > 0) {
        const LO c = cells(begin + k - 1);
        key.push_back(ordinal(f, cell(f, 0) == c ? 0 : 1));
      }
      key.push_back(toward(begin + ring + k));
      key.push_back(on_host(f));
    }
    const auto [at, is_new] = found.try_emplace(key, static_cast<int>(found.size()));
    kind(ring) = at->second;
    if (is_new) kinds.example.push_back(ring);
  }
  Kokkos::deep_copy(kinds.kind, kind);
  return kinds;
}

} // namespace rpc::bound
