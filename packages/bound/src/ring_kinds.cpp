// SPDX-License-Identifier: BSD-3-Clause
#include "ring_kinds.hpp"

#include <vector>

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

Kinds ring_kinds(const SpaceInput &in, const DeviceView<unsigned char *> &free)
{
  const LO rings = in.facets.num_rings();
  Kinds kinds = all_different(rings);
  if (all_differ(in)) return kinds;
  const auto cells = to_host(in.facets.ring_cell), facets = to_host(in.facets.ring_facet);
  const auto toward = to_host(in.facets.toward);
  const auto first = to_host(in.facets.first);
  const auto count = to_host(in.facets.num_ring_facets), of_cell = to_host(in.kind);
  const auto cell = to_host(in.facets.cell);
  const auto ordinal = to_host(in.facets.ordinal);
  const auto on_host = to_host(free);
  const auto kind = Kokkos::create_mirror_view(kinds.kind);
  Found<int> found;
  std::vector<int> key;
  for (LO ring = 0; ring < rings; ++ring) {
    key.clear();
    const std::size_t begin = first(ring);
    const int n = static_cast<int>(first(ring + 1) - begin);
    for (int k = 0; k < count(ring); ++k) {
      const LO f = facets(begin + ring + k);
      const auto ordinal_in = [&](const int of) { // 4: there is no such cell
        if (of < 0 || of >= n) return 4;
        return static_cast<int>(ordinal(f, cell(f, 0) == cells(begin + of) ? 0 : 1));
      };
      key.push_back(k < n ? of_cell(cells(begin + k)) : -1);
      key.push_back(((on_host(f) * 5 + ordinal_in(k)) * 5 + ordinal_in(k - 1)) * 2 + (toward(begin + ring + k) > 0));
    }
    kind(ring) = found(key, ring);
  }
  Kokkos::deep_copy(kinds.kind, kind);
  kinds.example = device_values(found.example, "rpc::bound::example");
  return kinds;
}

} // namespace rpc::bound
