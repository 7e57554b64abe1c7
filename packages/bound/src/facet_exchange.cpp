// SPDX-License-Identifier: BSD-3-Clause
#include "facet_exchange.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"

#include <map>
#include <set>

namespace rpc::bound
{

FacetExchange::FacetExchange(const fem::Discretization &d, const Facets &facets)
    : comm_(d.mesh->owned_nodes->getComm()), row_("rpc::bound::row", facets.size())
{
  const mesh::Mesh &mesh = *d.mesh;
  if (comm_->getSize() == 1) {
    Kokkos::deep_copy(row_, -1);
    return;
  }
  const LO owned = mesh.num_owned_nodes();
  const auto node = to_host(facets.node);
  const auto row = Kokkos::create_mirror_view(row_);
  using Key = std::pair<GO, GO>; // gids of the vertex and of the other one
  std::map<Key, LO> mine;        // ends at owned vertices
  std::vector<Key> wanted;
  for (LO f = 0; f < facets.size(); ++f)
    for (int end = 0; end < 2; ++end) {
      const GO vertex = mesh.node_gid(node(f, end)), other = mesh.node_gid(node(f, 1 - end));
      row(f, end) = -1;
      if (node(f, end) < owned) {
        mine[{vertex, other}] = 2 * f + end;
        continue;
      }
      row(f, end) = static_cast<LO>(wanted.size());
      wanted.push_back({vertex, other});
      reversed_.push_back(end == 0 ? vertex > other : other > vertex);
    }
  Kokkos::deep_copy(row_, row);
  std::vector<GO> asked;
  for (const Key &key : wanted) asked.insert(asked.end(), {key.first, key.second});
  asked = gathered_by_all(*comm_, asked);
  std::set<Key> keys;
  for (std::size_t k = 0; k + 1 < asked.size(); k += 2) keys.insert({asked[k], asked[k + 1]});
  std::vector<GO> served;
  for (const Key &key : keys) {
    const auto found = mine.find(key);
    if (found == mine.end()) continue;
    const int end = found->second % 2;
    served_.push_back(found->second);
    served_reversed_.push_back(end == 0 ? key.first > key.second : key.second > key.first);
    served.insert(served.end(), {key.first, key.second});
  }
  served = gathered_by_all(*comm_, served);
  std::map<Key, std::size_t> place;
  for (std::size_t k = 0; k + 1 < served.size(); k += 2) place[{served[k], served[k + 1]}] = k / 2;
  for (const Key &key : wanted) {
    const auto found = place.find(key);
    RPC_REQUIRE_CODE(found != place.end(), ExitCode::internal_error, "bound: a facet is on one of two ranks only");
    place_.push_back(found->second);
  }
}

DeviceView<double **> FacetExchange::fetch(const DeviceView<double ***> &values, const std::vector<double> &flip) const
{
  const std::size_t width = flip.size();
  DeviceView<double **> fetched("rpc::bound::fetched", place_.size(), width);
  if (comm_->getSize() == 1) return fetched;
  const auto here = to_host(values);
  std::vector<double> mine;
  for (std::size_t k = 0; k < served_.size(); ++k)
    for (std::size_t q = 0; q < width; ++q)
      mine.push_back((served_reversed_[k] ? flip[q] : 1) * here(served_[k] / 2, served_[k] % 2, q));
  const std::vector<double> all = gathered_by_all(*comm_, mine);
  const auto to = Kokkos::create_mirror_view(fetched);
  for (std::size_t k = 0; k < place_.size(); ++k)
    for (std::size_t q = 0; q < width; ++q) to(k, q) = (reversed_[k] ? flip[q] : 1) * all[place_[k] * width + q];
  Kokkos::deep_copy(fetched, to);
  return fetched;
}

} // namespace rpc::bound
