// SPDX-License-Identifier: BSD-3-Clause
#include "slot_exchange.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace rpc::bound
{

SlotExchange::SlotExchange(const mesh::Mesh &mesh, const DeviceView<LO **> &node_of_facet,
                           const std::vector<int> &node_of)
    : comm_(mesh.owned_nodes->getComm())
{
  const int ranks = comm_->getSize(), slots = static_cast<int>(node_of.size());
  if (ranks == 1) return;
  const auto node = to_host(node_of_facet);
  constexpr int per_key = 4; // vertices of the facet, slot
  using Key = std::array<GO, per_key>;
  const LO facets = static_cast<LO>(node.extent(0));
  std::map<Key, LO> here; // facets by their vertices
  std::vector<Key> wanted;
  std::vector<std::array<LO, 2>> place; // facet and slot of each
  std::vector<GO> vertex;
  for (LO f = 0; f < facets; ++f) {
    Key key{};
    for (std::size_t k = 0; k < std::min(node.extent(1), key.size() - 1); ++k) key[k] = mesh.node_gid(node(f, k));
    here[key] = f;
    for (int s = 0; s < slots; ++s) {
      if (node(f, node_of[s]) < mesh.num_owned_nodes()) continue;
      key[per_key - 1] = s;
      wanted.push_back(key);
      place.push_back({f, s});
      vertex.push_back(mesh.node_gid(node(f, node_of[s])));
    }
  }
  std::vector<int> rank(vertex.size()), counts(ranks);
  mesh.owned_nodes->getRemoteIndexList(Teuchos::ArrayView<const GO>(vertex), Teuchos::ArrayView<int>(rank));
  for (const int r : rank) ++counts[r];
  std::vector<std::size_t> order(wanted.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](const auto a, const auto b) { return rank[a] < rank[b]; });
  rows_.of = DeviceView<LO **>("rpc::bound::rows_of_slots", facets, slots);
  const auto row = Kokkos::create_mirror_view(rows_.of);
  Kokkos::deep_copy(row, -1);
  std::vector<double> keys;
  for (std::size_t k = 0; k < order.size(); ++k) {
    row(place[order[k]][0], place[order[k]][1]) = static_cast<LO>(k);
    keys.insert(keys.end(), wanted[order[k]].begin(), wanted[order[k]].end());
  }
  Kokkos::deep_copy(rows_.of, row);
  exchange_.emplace(*comm_, counts);
  const std::vector<double> of_others = exchange_->forward(keys, per_key);
  const std::size_t asked = exchange_->num_received();
  served_ = DeviceView<LO *[2]>("rpc::bound::served_slots", asked);
  const auto served = Kokkos::create_mirror_view(served_);
  int missing = 0;
  for (std::size_t k = 0; k < asked; ++k) {
    const double *const key = of_others.data() + per_key * k;
    const auto found = here.find({static_cast<GO>(key[0]), static_cast<GO>(key[1]), static_cast<GO>(key[2]), 0});
    if (found == here.end()) {
      ++missing;
      continue;
    }
    served(k, 0) = found->second;
    served(k, 1) = static_cast<LO>(key[3]);
  }
  RPC_REQUIRE_CODE(max_all(*comm_, missing) == 0, ExitCode::internal_error,
                   "bound: the rank of a node lacks a facet at it");
  Kokkos::deep_copy(served_, served);
}

DeviceView<double **> SlotExchange::fetched(const DeviceView<double **> &values) const
{
  const std::size_t width = values.extent(1);
  if (on_one_rank()) return DeviceView<double **>("rpc::bound::fetched", 0, width);
  Kokkos::fence();
  const auto here = to_host(values);
  std::vector<double> sent(here.extent(0) * width);
  for (std::size_t k = 0; k < here.extent(0); ++k)
    for (std::size_t q = 0; q < width; ++q) sent[width * k + q] = here(k, q);
  const std::vector<double> all = exchange_->back(sent, static_cast<int>(width));
  const DeviceView<double **> fetched("rpc::bound::fetched", width > 0 ? all.size() / width : 0, width);
  const auto to = Kokkos::create_mirror_view(fetched);
  for (std::size_t k = 0; k < to.extent(0); ++k)
    for (std::size_t q = 0; q < width; ++q) to(k, q) = all[width * k + q];
  Kokkos::deep_copy(fetched, to);
  return fetched;
}

} // namespace rpc::bound
