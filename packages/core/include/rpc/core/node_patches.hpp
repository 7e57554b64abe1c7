// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

#include <cstddef>
#include <vector>

namespace rpc
{

/// Sets of nodes, of this rank; their nodes may be those of any ranks.
struct NodePatches {
  std::vector<std::size_t> begin{0}; ///< (patches + 1) where a patch's nodes begin
  std::vector<GO> node;              ///< gids

  int size() const { return static_cast<int>(begin.size()) - 1; }
};

} // namespace rpc
