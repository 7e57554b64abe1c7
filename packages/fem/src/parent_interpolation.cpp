// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/parent_interpolation.hpp"

#include "interpolation_matrix.hpp"
#include "rpc/mesh/refinement.hpp"

#include <utility>
#include <vector>

namespace rpc::fem
{

RCP<CrsMatrix> interpolation_from_parents(const mesh::Mesh &coarse, const mesh::Mesh &fine,
                                          const mesh::Parents &parents)
{
  const auto weights = mesh::child_weights(coarse.element, fine.element, parents.vertices);
  const auto cells = to_host(fine.cells), coarse_cells = to_host(coarse.cells);
  const LO num_owned = fine.num_owned_nodes();
  std::vector<std::pair<LO, int>> seen(num_owned,
                                       {-1, 0}); // a cell, and the node's place there: others give the same row
  for (std::size_t c = 0; c < cells.extent(0); ++c)
    for (std::size_t a = 0; a < cells.extent(1); ++a)
      if (cells(c, a) < num_owned && seen[cells(c, a)].first < 0)
        seen[cells(c, a)] = {static_cast<LO>(c), static_cast<int>(a)};
  InterpolationRows rows;
  for (LO n = 0; n < num_owned; ++n) {
    const auto [cell, a] = seen[n];
    const LO parent = parents.cell[cell];
    const std::vector<double> &weight = weights[parents.kind[cell]][a];
    for (std::size_t b = 0; b < weight.size(); ++b) rows.add(coarse_cells(parent, b), weight[b]);
    rows.end_row();
  }
  return rows.matrix(fine.owned_nodes, coarse.overlap_nodes(), coarse.owned_nodes);
}

} // namespace rpc::fem
