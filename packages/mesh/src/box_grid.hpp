#pragma once

#include "rpc/core/error.hpp"
#include "rpc/mesh/box.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

/// The lattices of a box and their division among ranks; private to make_box().
namespace rpc::mesh
{

/// A position on the lattice of cells or nodes; absent dimensions are 0. (Kokkos 3.4 takes a view of Kokkos::Array for
/// a view of one more dimension, hence no Kokkos::Array here.)
struct Index {
  GO along[3];
  KOKKOS_INLINE_FUNCTION GO &operator[](const int d) { return along[d]; }
  KOKKOS_INLINE_FUNCTION GO operator[](const int d) const { return along[d]; }
};

/// A block of lattice positions, [begin, end) in each direction, in the storage order of this mesh.
struct Block {
  Index begin{}, end{};
  Kokkos::Array<int, 3> axes{}; // from the fastest running one to the slowest

  KOKKOS_INLINE_FUNCTION GO size() const { return (end[0] - begin[0]) * (end[1] - begin[1]) * (end[2] - begin[2]); }
  KOKKOS_INLINE_FUNCTION bool contains(const Index &at) const
  {
    for (int d = 0; d < 3; ++d)
      if (at[d] < begin[d] || at[d] >= end[d]) return false;
    return true;
  }
  KOKKOS_INLINE_FUNCTION GO index_of(const Index &at) const
  {
    GO index = 0;
    for (int s = 2; s >= 0; --s) {
      const int d = axes[s];
      index = index * (end[d] - begin[d]) + (at[d] - begin[d]);
    }
    return index;
  }
  KOKKOS_INLINE_FUNCTION Index at(GO index) const
  {
    Index position{};
    for (int s = 0; s < 3; ++s) {
      const int d = axes[s];
      position[d] = begin[d] + index % (end[d] - begin[d]);
      index /= end[d] - begin[d];
    }
    return position;
  }
};

/// The whole box and its division into blocks of cells, one per rank. Every rank can compute every other rank's block.
///
/// A node on the border of two blocks belongs to the lower one.
class Grid
{
public:
  Grid(const BoxOptions &options, const int num_ranks) : dim_(options.element.dim), order_(options.element.order)
  {
    for (int d = 0; d < dim_; ++d) cells_[d] = options.cells[d];
    // The shortest direction runs fastest: least bandwidth, and blocks along the longest one share short borders.
    std::sort(axes_.begin(), axes_.begin() + dim_, [&](const int a, const int b) { return cells_[a] < cells_[b]; });
    choose_blocks(num_ranks);
    offsets_.assign(num_ranks + 1, 0);
    for (int rank = 0; rank < num_ranks; ++rank) offsets_[rank + 1] = offsets_[rank] + owned_nodes(rank).size();
  }

  Block owned_cells(const int rank) const
  {
    Block block = empty_block();
    const auto b = block_of(rank);
    for (int d = 0; d < 3; ++d) {
      block.begin[d] = first_cell(d, b[d]);
      block.end[d] = first_cell(d, b[d] + 1);
    }
    return block;
  }
  /// The cells that touch an owned node: one layer more on the upper borders.
  Block local_cells(const int rank) const
  {
    Block block = owned_cells(rank);
    for (int d = 0; d < dim_; ++d) block.end[d] = std::min<GO>(block.end[d] + 1, cells_[d]);
    return block;
  }
  Block owned_nodes(const int rank) const
  {
    Block block = owned_cells(rank);
    for (int d = 0; d < dim_; ++d) {
      block.begin[d] = block.begin[d] == 0 ? 0 : order_ * block.begin[d] + 1;
      block.end[d] = order_ * block.end[d] + 1;
    }
    return block;
  }
  Block local_nodes(const int rank) const
  {
    Block block = local_cells(rank);
    for (int d = 0; d < dim_; ++d) {
      block.begin[d] = order_ * block.begin[d];
      block.end[d] = order_ * block.end[d] + 1;
    }
    return block;
  }
  GO node_offset(const int rank) const { return offsets_[rank]; }
  GO node_gid(const Index &node) const
  {
    std::array<int, 3> b{};
    for (int d = 0; d < dim_; ++d) {
      const GO cell = node[d] == 0 ? 0 : (node[d] - 1) / order_; // the lower one of the two that share the node
      while (first_cell(d, b[d] + 1) <= cell) ++b[d];
    }
    const int rank = b[0] + blocks_[0] * (b[1] + blocks_[1] * b[2]);
    return offsets_[rank] + owned_nodes(rank).index_of(node);
  }
  const std::array<int, 3> &num_cells() const { return cells_; }
  GO num_cells_total() const { return GO(cells_[0]) * cells_[1] * cells_[2]; }

private:
  Block empty_block() const
  {
    Block block;
    for (int d = 0; d < 3; ++d) block.axes[d] = axes_[d];
    return block;
  }
  std::array<int, 3> block_of(const int rank) const
  {
    return {rank % blocks_[0], rank / blocks_[0] % blocks_[1], rank / (blocks_[0] * blocks_[1])};
  }
  GO first_cell(const int d, const int b) const { return GO(cells_[d]) * b / blocks_[d]; }

  void choose_blocks(const int num_ranks)
  {
    double least = std::numeric_limits<double>::max();
    for (int x = 1; x <= num_ranks; ++x) {
      for (int y = 1; num_ranks % x == 0 && y <= num_ranks / x; ++y) {
        const int z = num_ranks / x / y;
        if (x * y * z != num_ranks || x > cells_[0] || y > cells_[1] || z > cells_[2]) continue;
        const std::array<int, 3> blocks{x, y, z};
        double shared = 0; // faces between blocks
        for (int d = 0; d < 3; ++d) shared += (blocks[d] - 1) * (double(num_cells_total()) / cells_[d]);
        if (shared < least) {
          least = shared;
          blocks_ = blocks;
        }
      }
    }
    RPC_REQUIRE_CODE(
        least < std::numeric_limits<double>::max(), ExitCode::bad_mesh,
        "box mesh: " << cells_[0] << " x " << cells_[1] << (dim_ == 3 ? " x " + std::to_string(cells_[2]) : "")
                     << " cells cannot be divided among " << num_ranks << " ranks. Use fewer ranks or more cells.");
  }

  int dim_, order_;
  std::array<int, 3> cells_{1, 1, 1};
  std::array<int, 3> axes_{0, 1, 2};
  std::array<int, 3> blocks_{1, 1, 1};
  std::vector<GO> offsets_;
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
