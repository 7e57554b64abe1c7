// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/rules.hpp"
#include "rpc/core/kokkos.hpp"

#include <optional>
#include <vector>

namespace rpc
{

/// Nodes sorted into kinds: those of a kind are alike.
struct AlikeNodes {
  DeviceView<int *> kind;  ///< (nodes) -1: of none
  std::vector<LO> example; ///< (kinds) a node of each
};

namespace alike_nodes
{

constexpr int no_kind = -1;

/// Nodes are taken from the middle of their numbers: inside the mesh, where most are alike.
KOKKOS_INLINE_FUNCTION LO node_at(const LO place, const LO num_nodes)
{
  const LO rest = num_nodes - num_nodes / 2;
  return place < rest ? num_nodes / 2 + place : place - rest;
}

/// Gives a kind to the nodes without one that are like its example.
template <class Alike>
struct TakeKind {
  Alike alike;            // in
  LO example;             // node
  int kind;               //
  DeviceView<int *> take; // (nodes)  inout

  /// @param took   += 1 if the node took it
  /// @param first  the first place that is left without
  KOKKOS_FUNCTION void operator()(const LO place, LO &took, LO &first) const
  {
    const LO node = node_at(place, static_cast<LO>(take.extent(0)));
    if (take(node) != no_kind) return;
    if (alike(node, example)) {
      take(node) = kind;
      ++took;
    } else if (place < first) {
      first = place;
    }
  }
};

} // namespace alike_nodes

/// Sorts nodes into kinds.
/// @param alike  bool alike(node, other) in kernels: an equivalence, but that a node with values that are not numbers may be unlike
///               itself
/// @return nothing where less than three quarters of the nodes are like another one
template <class Alike>
std::optional<AlikeNodes> alike_nodes_of(const LO num_nodes, const Alike &alike)
{
  using namespace alike_nodes;
  AlikeNodes result{DeviceView<int *>(Kokkos::ViewAllocateWithoutInitializing("rpc::core::kind_of_node"), num_nodes),
                    {}};
  Kokkos::deep_copy(result.kind, no_kind);
  LO next = 0, repeated = 0; // the first place without a kind
  while (next < num_nodes && static_cast<int>(result.example.size()) < kind_rules.most) {
    const TakeKind<Alike> take{alike, node_at(next, num_nodes), static_cast<int>(result.example.size()), result.kind};
    LO took = 0;
    Kokkos::parallel_reduce("rpc::core::take_kind", device_range(num_nodes), take, Kokkos::Sum<LO>(took),
                            Kokkos::Min<LO>(next));
    if (took == 0) return std::nullopt;
    repeated += took - 1; // all but the example
    result.example.push_back(take.example);
    // Few nodes of many kinds promise a mesh without order, and each kind costs a pass over the nodes.
    const auto kinds = static_cast<double>(result.example.size());
    if (kinds >= kind_rules.enough && repeated / kinds < kind_rules.least_part * num_nodes / kind_rules.most)
      return std::nullopt;
  }
  if (repeated < kind_rules.least_part * num_nodes) return std::nullopt;
  return result;
}

} // namespace rpc
