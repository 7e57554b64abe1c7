#include "rpc/mesh/box_grid.hpp"

#include "rpc/core/error.hpp"

#include <array>
#include <limits>
#include <string>

namespace rpc::mesh
{

Grid::Grid(const BoxOptions &options, const int num_ranks) : dim_(options.element.dim)
{
  for (int d = 0; d < dim_; ++d) {
    order_[d] = options.element.order_along(d);
    cells_[d] = options.cells[d];
  }
  // The shortest direction runs fastest: least bandwidth, and blocks along the longest one share short borders.
  std::sort(axes_.data(), axes_.data() + dim_, [&](const int a, const int b) { return cells_[a] < cells_[b]; });
  choose_blocks(num_ranks);
}

void Grid::choose_blocks(const int num_ranks)
{
  double least = std::numeric_limits<double>::max();
  for (int x = 1; x <= num_ranks; ++x) {
    for (int y = 1; num_ranks % x == 0 && y <= num_ranks / x; ++y) {
      const int z = num_ranks / x / y;
      if (x * y * z != num_ranks || x > cells_[0] || y > cells_[1] || z > cells_[2]) continue;
      const std::array<int, 3> blocks{x, y, z};
      double shared = 0; // faces between blocks
      for (int d = 0; d < 3; ++d) shared += (blocks[d] - 1) * (double(num_cells_total()) / cells_[d]);
      if (shared >= least) continue;
      least = shared;
      for (int d = 0; d < 3; ++d) blocks_[d] = blocks[d];
    }
  }
  RPC_REQUIRE_CODE(
      least < std::numeric_limits<double>::max(), ExitCode::bad_mesh,
      "box mesh: " << cells_[0] << " x " << cells_[1] << (dim_ == 3 ? " x " + std::to_string(cells_[2]) : "")
                   << " cells cannot be divided among " << num_ranks << " ranks. Use fewer ranks or more cells.");
}

} // namespace rpc::mesh
