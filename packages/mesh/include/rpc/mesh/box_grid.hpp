// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/box.hpp"
#include "rpc/mesh/lattice.hpp"

#include <algorithm>
#include <vector>

/// The lattices of a box, their division among ranks and the numbers of its nodes: closed formulas, by which each rank knows the parts of all others.
namespace rpc::mesh
{

/// The whole box and its division into blocks of cells, at most one on a rank. Every rank can compute every other rank's block, in kernels
/// too.
///
/// A node on the border of two blocks belongs to the lower one. Gids run block by block, along x first, in the order of each
/// block; ranks with higher blocks are higher.
class Grid
{
public:
  /// @throws rpc::Error (bad_mesh) if there are fewer cells than blocks in every direction
  Grid(const BoxOptions &options, int num_ranks);
  /// Whether there are cells enough for options.blocks blocks.
  static bool can_divide(const BoxOptions &options);

  KOKKOS_INLINE_FUNCTION Block owned_cells(const int rank) const
  {
    Block block = empty_block();
    const int number = block_from(rank);
    if (rank_of(number) != rank) return block;
    for (int d = 0; d < 3; ++d) {
      block.begin[d] = first_cell(d, along(number, d));
      block.end[d] = first_cell(d, along(number, d) + 1);
    }
    return block;
  }
  /// The cells that touch an owned node: one layer more on the upper borders.
  Block local_cells(const int rank) const
  {
    Block block = owned_cells(rank);
    for (int d = 0; d < dim_ && block.end[d] > 0; ++d) block.end[d] = std::min<GO>(block.end[d] + 1, cells_[d]);
    return block;
  }
  KOKKOS_INLINE_FUNCTION Block owned_nodes(const int rank) const
  {
    const int number = block_from(rank);
    return rank_of(number) == rank ? nodes_of_block(number) : empty_block();
  }
  Block local_nodes(const int rank) const
  {
    Block block = nodes_of(local_cells(rank));
    for (int d = 0; d < dim_; ++d)
      if (wraps_[d] && block.end[d] > 0) --block.end[d];
    return block;
  }
  /// All nodes of a block of cells; where the box is periodic with the images of the first ones.
  Block nodes_of(Block block) const
  {
    for (int d = 0; d < dim_ && block.end[d] > 0; ++d) {
      block.begin[d] = order_[d] * block.begin[d];
      block.end[d] = order_[d] * block.end[d] + 1;
    }
    return block;
  }
  /// All cells of the box.
  Block cells() const
  {
    Block block = empty_block();
    for (int d = 0; d < 3; ++d) block.end[d] = cells_[d];
    return block;
  }
  KOKKOS_INLINE_FUNCTION GO node_gid(const Index &node) const
  {
    int b[3] = {0, 0, 0};
    for (int d = 0; d < dim_; ++d) {
      const GO cell = node[d] == 0 ? 0 : (node[d] - 1) / order_[d]; // the lower one of the two that share the node
      b[d] = static_cast<int>(((cell + 1) * blocks_[d] - 1) / cells_[d]); // first_cell(b) <= cell < first_cell(b + 1)
    }
    const int number = b[0] + blocks_[0] * (b[1] + blocks_[1] * b[2]);
    return offset_of_block(number) + nodes_of_block(number).index_of(node);
  }
  int num_blocks() const { return num_blocks_; }
  GO num_nodes_total() const { return num_nodes(0) * num_nodes(1) * num_nodes(2); }
  GO num_cells_total() const { return GO(cells_[0]) * cells_[1] * cells_[2]; }
  KOKKOS_INLINE_FUNCTION int num_cells(const int direction) const { return cells_[direction]; }
  KOKKOS_INLINE_FUNCTION int order(const int direction) const { return order_[direction]; }
  KOKKOS_INLINE_FUNCTION bool wraps(const int direction) const { return wraps_[direction]; }
  /// The node of which a position of the lattice may be an image.
  KOKKOS_INLINE_FUNCTION Index node_of(Index position) const
  {
    for (int d = 0; d < dim_; ++d)
      if (wraps_[d] && position[d] == GO(order_[d]) * cells_[d]) position[d] = 0;
    return position;
  }

private:
  KOKKOS_INLINE_FUNCTION Block empty_block() const
  {
    Block block;
    block.axes = axes_;
    return block;
  }
  /// The block of this rank, or where it has none, of the next rank that has one; num_blocks_ where none has.
  KOKKOS_INLINE_FUNCTION int block_from(const int rank) const
  {
    return static_cast<int>((GO(rank) * num_blocks_ + num_ranks_ - 1) / num_ranks_);
  }
  /// Ranks with a block are spread over all of them.
  KOKKOS_INLINE_FUNCTION int rank_of(const int block) const
  {
    return static_cast<int>(GO(block) * num_ranks_ / num_blocks_);
  }
  /// A block's place along a direction.
  KOKKOS_INLINE_FUNCTION int along(const int block, const int d) const
  {
    return d == 0 ? block % blocks_[0] : d == 1 ? block / blocks_[0] % blocks_[1] : block / (blocks_[0] * blocks_[1]);
  }
  KOKKOS_INLINE_FUNCTION Block nodes_of_block(const int number) const
  {
    Block block = empty_block();
    for (int d = 0; d < 3; ++d) {
      block.begin[d] = first_node(d, along(number, d));
      block.end[d] = first_node(d, along(number, d) + 1);
    }
    return block;
  }
  KOKKOS_INLINE_FUNCTION GO offset_of_block(const int number) const
  {
    const int x = along(number, 0), y = along(number, 1), z = along(number, 2);
    return first_node(0, x) * width(1, y) * width(2, z) +
           num_nodes(0) * (first_node(1, y) * width(2, z) + num_nodes(1) * first_node(2, z));
  }
  KOKKOS_INLINE_FUNCTION GO first_cell(const int d, const int b) const { return GO(cells_[d]) * b / blocks_[d]; }
  KOKKOS_INLINE_FUNCTION GO first_node(const int d, const int b) const
  {
    return b == 0 ? 0 : (d < dim_ ? order_[d] * first_cell(d, b) + (wraps_[d] ? 0 : 1) : 1);
  }
  KOKKOS_INLINE_FUNCTION GO width(const int d, const int b) const { return first_node(d, b + 1) - first_node(d, b); }
  KOKKOS_INLINE_FUNCTION GO num_nodes(const int d) const { return first_node(d, blocks_[d]); }

  Grid(int num_ranks, const BoxOptions &options); // divided or not
  bool choose_blocks();

  int dim_, num_ranks_, num_blocks_;
  bool divided_ = false;
  Kokkos::Array<bool, 3> whole_{{false, false, false}}, wraps_{{false, false, false}}; // not divided, periodic
  Kokkos::Array<int, 3> order_{{1, 1, 1}}, cells_{{1, 1, 1}}, axes_{{0, 1, 2}}, blocks_{{1, 1, 1}};
};

/// Positions of `outer` that `inner` does not contain, in outer's order.
inline std::vector<Index> shell(const Block &outer, const Block &inner)
{
  std::vector<Index> positions;
  const int fast = outer.axes[0], mid = outer.axes[1], slow = outer.axes[2];
  Index at{};
  for (at[slow] = outer.begin[slow]; at[slow] < outer.end[slow]; ++at[slow]) {
    for (at[mid] = outer.begin[mid]; at[mid] < outer.end[mid]; ++at[mid]) {
      at[fast] = inner.begin[fast];
      const bool row_crosses = inner.contains(at);
      for (at[fast] = outer.begin[fast]; at[fast] < outer.end[fast]; ++at[fast]) {
        if (row_crosses && at[fast] == inner.begin[fast]) at[fast] = inner.end[fast];
        if (at[fast] < outer.end[fast]) positions.push_back(at);
      }
    }
  }
  return positions;
}

} // namespace rpc::mesh
