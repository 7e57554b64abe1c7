// SPDX-License-Identifier: BSD-3-Clause
#include "slot_exchange.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <array>
#include <map>

namespace rpc::bound
{

SlotExchange::SlotExchange(const mesh::Mesh &mesh, const HostView<LO **> &node, const std::vector<int> &vertex_of)
    : comm_(mesh.owned_nodes->getComm())
{
  const int ranks = comm_->getSize(), own = comm_->getRank(), slots = static_cast<int>(vertex_of.size());
  if (ranks == 1) return;
  const GO begin = mesh.owned_nodes->getMinGlobalIndex(), count = mesh.num_owned_nodes();
  std::vector<GO> begin_of(2 * ranks);
  const GO mine[2] = {begin, count};
  Teuchos::gatherAll(*comm_, 2, mine, 2 * ranks, begin_of.data());
  const auto owner = [&](const GO gid) {
    for (int r = 0; r < ranks; ++r)
      if (gid >= begin_of[2 * r] && gid < begin_of[2 * r] + begin_of[2 * r + 1]) return r;
    return own;
  };
  constexpr int per_key = 4; // vertices of the facet, slot
  using Key = std::array<GO, per_key>;
  const LO facets = static_cast<LO>(node.extent(0));
  std::map<Key, LO> here; // facets by their vertices
  std::vector<std::vector<Key>> wanted(ranks);
  std::vector<std::vector<std::array<LO, 2>>> place(ranks);
  for (LO f = 0; f < facets; ++f) {
    Key key{mesh.node_gid(node(f, 0)), mesh.node_gid(node(f, 1)), mesh.node_gid(node(f, 2)), 0};
    here[key] = f;
    for (int s = 0; s < slots; ++s) {
      const LO vertex = node(f, vertex_of[s]);
      if (vertex < mesh.num_owned_nodes()) continue;
      const int rank = owner(mesh.node_gid(vertex));
      key[3] = s;
      wanted[rank].push_back(key);
      place[rank].push_back({f, s});
    }
  }
  rows_.of = DeviceView<LO **>("rpc::bound::rows_of_slots", facets, slots);
  const auto row = Kokkos::create_mirror_view(rows_.of);
  Kokkos::deep_copy(row, -1);
  std::vector<int> counts(ranks);
  std::vector<double> keys;
  LO rows = 0;
  for (int r = 0; r < ranks; ++r) {
    counts[r] = static_cast<int>(wanted[r].size());
    for (const auto &at : place[r]) row(at[0], at[1]) = rows++;
    for (const Key &key : wanted[r]) keys.insert(keys.end(), key.begin(), key.end());
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
                   "bound: the rank of a vertex lacks a facet at it");
  Kokkos::deep_copy(served_, served);
}

DeviceView<double **> SlotExchange::fetched(const DeviceView<double **> &values) const
{
  const std::size_t width = values.extent(1);
  if (comm_->getSize() == 1) return DeviceView<double **>("rpc::bound::fetched", 0, width);
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
