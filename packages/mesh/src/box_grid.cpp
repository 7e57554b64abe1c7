// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/box_grid.hpp"

#include "rpc/core/error.hpp"

#include <array>
#include <limits>
#include <string>

namespace rpc::mesh
{

Grid::Grid(const BoxOptions &options, const int num_ranks) : Grid(num_ranks, options)
{
  RPC_REQUIRE_CODE(num_blocks_ <= num_ranks_, ExitCode::internal_error,
                   "box mesh: " << num_blocks_ << " blocks on " << num_ranks_ << " ranks");
  RPC_REQUIRE_CODE(
      divided_, ExitCode::bad_mesh,
      "box mesh: " << cells_[0] << " x " << cells_[1] << (dim_ == 3 ? " x " + std::to_string(cells_[2]) : "")
                   << " cells cannot be divided among " << num_blocks_ << " ranks"
                   << (whole_[0] || whole_[1] || whole_[2] ? ", which do not share directions in which it is periodic"
                                                           : "")
                   << ". Use fewer ranks or more cells.");
}

bool Grid::can_divide(const BoxOptions &options)
{
  return Grid(options.blocks, options).divided_;
}

Grid::Grid(const int num_ranks, const BoxOptions &options)
    : dim_(options.element.dim), num_ranks_(num_ranks), num_blocks_(options.blocks > 0 ? options.blocks : num_ranks)
{
  for (int d = 0; d < dim_; ++d) {
    order_[d] = options.element.order_along(d);
    cells_[d] = options.cells[d];
    whole_[d] = options.periodic[d];
    wraps_[d] = options.wraps(d);
  }
  // The shortest direction runs fastest: least bandwidth, and blocks along the longest one share short borders. Equal ones keep
  // their order.
  std::stable_sort(axes_.data(), axes_.data() + dim_, [&](const int a, const int b) { return cells_[a] < cells_[b]; });
  divided_ = choose_blocks();
}

/// @return whether there are any
bool Grid::choose_blocks()
{
  double least = std::numeric_limits<double>::max();
  for (int x = 1; x <= num_blocks_; ++x) {
    for (int y = 1; num_blocks_ % x == 0 && y <= num_blocks_ / x; ++y) {
      const int z = num_blocks_ / x / y;
      if (x * y * z != num_blocks_ || x > cells_[0] || y > cells_[1] || z > cells_[2]) continue;
      const std::array<int, 3> blocks{x, y, z};
      bool cuts = false;
      for (int d = 0; d < 3; ++d) cuts = cuts || (whole_[d] && blocks[d] > 1);
      if (cuts) continue;
      double shared = 0; // faces between blocks
      for (int d = 0; d < 3; ++d) shared += (blocks[d] - 1) * (double(num_cells_total()) / cells_[d]);
      if (shared >= least) continue;
      least = shared;
      for (int d = 0; d < 3; ++d) blocks_[d] = blocks[d];
    }
  }
  return least < std::numeric_limits<double>::max();
}

BoxOptions divided(BoxOptions options, const int num_ranks, const GO least_nodes)
{
  GO nodes = 1;
  for (int d = 0; d < options.element.dim; ++d) nodes *= options.intervals(d) + 1;
  options.blocks = static_cast<int>(std::clamp<GO>(nodes / least_nodes, 1, num_ranks));
  while (options.blocks > 1 && !Grid::can_divide(options)) --options.blocks;
  return options;
}

} // namespace rpc::mesh
