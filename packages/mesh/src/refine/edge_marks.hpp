// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "middles.hpp"

#include <vector>

namespace rpc::mesh
{

/// How a cell is to be halved.
enum class Halving : char { none, longest_edge, all_edges };

/// Edges that are halved, from the longest to the shortest.
struct EdgeMarks {
  Middles edges;          ///< those alone
  std::vector<int> order; ///< (marked edges) ascending from the longest; equal on all ranks that have both edges
};

/// The edges to halve so that cells are halved as asked for: with an edge of a cell or face its longest one is marked too, which keeps
/// angles away from 0. The order is that of lengths rounded to a few digits, then of the vertices' ids. Collective.
///
/// (M.-C. Rivara, 1984; in space A. Plaza, G. F. Carey, 2000.)
/// @param edges    of `mesh`, all of them
/// @param halving  (owned cells)
/// @param marked   (edges) 1: to be halved whatever cells ask for
EdgeMarks marked_edges(const LocalMesh &mesh, const Middles &edges, const std::vector<Halving> &halving,
                       std::vector<char> marked);

} // namespace rpc::mesh
