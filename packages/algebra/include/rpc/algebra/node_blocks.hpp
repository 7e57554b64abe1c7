// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

namespace rpc
{

/// A block of a matrix for each owned node, of which nodes may share some: on a box of equal cells nearly all share one.
struct NodeBlocks {
  DeviceView<LO *> place;       ///< (owned nodes) of a node's block in `block`; empty: its lid
  DeviceView<double ***> block; ///< (blocks, dim, dim)

  KOKKOS_INLINE_FUNCTION LO of(const LO node) const { return place.extent(0) == 0 ? node : place(node); }
  LO num_nodes() const { return static_cast<LO>(place.extent(0) == 0 ? block.extent(0) : place.extent(0)); }
  LO num_blocks() const { return static_cast<LO>(block.extent(0)); }
  int dim() const { return static_cast<int>(block.extent(1)); }
};

} // namespace rpc
