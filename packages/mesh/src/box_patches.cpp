// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/box_patches.hpp"

#include "rpc/mesh/box_grid.hpp"

#include <algorithm>

namespace rpc::mesh
{
namespace
{

/// Appends the nodes of [begin, end) in each direction as a patch, x fastest.
void add_patch(const Grid &grid, const Index &begin, const Index &end, NodePatches &patches)
{
  Index at{};
  for (at[2] = begin[2]; at[2] < end[2]; ++at[2])
    for (at[1] = begin[1]; at[1] < end[1]; ++at[1])
      for (at[0] = begin[0]; at[0] < end[0]; ++at[0]) patches.node.push_back(grid.node_gid(at));
  patches.begin.push_back(patches.node.size());
}

} // namespace

NodePatches vertex_stars(const BoxOptions &box, const Comm &comm)
{
  const int dim = box.element.dim;
  const Grid grid(box, comm.getSize());
  const Block owned = grid.owned_nodes(comm.getRank());
  NodePatches stars;
  for (GO n = 0; n < owned.size(); ++n) {
    const Index vertex = owned.at(n);
    Index begin{}, end{{1, 1, 1}};
    bool is_vertex = true;
    for (int d = 0; d < dim; ++d) {
      const GO order = box.element.order_along(d);
      is_vertex = is_vertex && vertex[d] % order == 0;
      begin[d] = std::max<GO>(vertex[d] - order + 1, 0);
      end[d] = std::min<GO>(vertex[d] + order, box.intervals(d) + 1);
    }
    if (is_vertex) add_patch(grid, begin, end, stars);
  }
  return stars;
}

NodePatches inside_cells_of(const BoxOptions &coarse, const BoxOptions &box, const Comm &comm)
{
  const int dim = box.element.dim;
  const Grid grid(box, comm.getSize());
  const Block owned = grid.owned_nodes(comm.getRank());
  NodePatches interiors;
  for (GO n = 0; n < owned.size(); ++n) {
    const Index first =
        owned.at(n); // of a patch, if it follows the lower side of a cell of the coarser box in each direction
    Index end{{1, 1, 1}};
    bool is_first = true;
    for (int d = 0; d < dim; ++d) {
      const GO order = box.element.order_along(d), cells = coarse.cells[d];
      const GO length = order * (coarse.cells[d] < box.cells[d] ? 2 : 1),
               cell = first[d] / length; // of a cell, in intervals
      is_first = is_first && first[d] % length == 1 && cell < cells;
      end[d] = cell == cells - 1 ? box.intervals(d) : length * (cell + 1);
    }
    if (is_first) add_patch(grid, first, end, interiors);
  }
  return interiors;
}

} // namespace rpc::mesh
