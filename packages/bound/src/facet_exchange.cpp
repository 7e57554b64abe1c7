// SPDX-License-Identifier: BSD-3-Clause
#include "facet_exchange.hpp"

#include <utility>

namespace rpc::bound
{
namespace
{

/// (facets, 2) vertices, the one with the lower gid first.
DeviceView<LO **> rising(const mesh::Mesh &mesh, const Facets &facets)
{
  const auto node = to_host(facets.node);
  const DeviceView<LO **> on_device("rpc::bound::rising", facets.size(), 2);
  const auto vertex = Kokkos::create_mirror_view(on_device);
  for (LO f = 0; f < facets.size(); ++f) {
    for (int end = 0; end < 2; ++end) vertex(f, end) = node(f, end);
    if (mesh.node_gid(vertex(f, 0)) > mesh.node_gid(vertex(f, 1))) std::swap(vertex(f, 0), vertex(f, 1));
  }
  Kokkos::deep_copy(on_device, vertex);
  return on_device;
}

} // namespace

FacetExchange::FacetExchange(const fem::Discretization &d, const Facets &facets)
    : falls_(facets.size()), ends_(*d.mesh, rising(*d.mesh, facets), {0, 1}), row_("rpc::bound::row", facets.size())
{
  const auto node = to_host(facets.node);
  const auto of = to_host(ends_.rows().of);
  const auto row = Kokkos::create_mirror_view(row_);
  for (LO f = 0; f < facets.size(); ++f) {
    falls_[f] = d.mesh->node_gid(node(f, 0)) > d.mesh->node_gid(node(f, 1));
    for (int end = 0; end < 2; ++end) row(f, end) = of.extent(0) > 0 ? of(f, end ^ falls_[f]) : -1;
  }
  Kokkos::deep_copy(row_, row);
}

DeviceView<double **> FacetExchange::fetch(const DeviceView<double ***> &values, const std::vector<double> &flip) const
{
  if (ends_.on_one_rank()) return DeviceView<double **>("rpc::bound::fetched", 0, flip.size());
  const auto place = to_host(ends_.served());
  const auto here = to_host(values);
  const DeviceView<double **> served("rpc::bound::served_ends", place.extent(0), flip.size());
  const auto sent = Kokkos::create_mirror_view(served);
  for (std::size_t k = 0; k < place.extent(0); ++k)
    for (std::size_t q = 0; q < flip.size(); ++q) {
      const LO f = place(k, 0);
      sent(k, q) = (falls_[f] ? flip[q] : 1) * here(f, place(k, 1) ^ falls_[f], q);
    }
  Kokkos::deep_copy(served, sent);
  const auto fetched = ends_.fetched(served);
  const auto to = Kokkos::create_mirror_view(fetched);
  Kokkos::deep_copy(to, fetched);
  const auto row = to_host(row_);
  for (std::size_t f = 0; f < falls_.size(); ++f)
    for (int end = 0; end < 2; ++end)
      for (std::size_t q = 0; q < flip.size() && falls_[f] && row(f, end) >= 0; ++q) to(row(f, end), q) *= flip[q];
  Kokkos::deep_copy(fetched, to);
  return fetched;
}

} // namespace rpc::bound
