// SPDX-License-Identifier: BSD-3-Clause
#include "division.hpp"

#include "rpc/core/error.hpp"
#include "rpc/mesh/rules.hpp"
#include "rpc/mesh/topology.hpp"
#include "sorted_lists.hpp"

#include <algorithm>
#include <cmath>
#include <metis.h>
#include <numeric>
#include <utility>

namespace rpc::mesh
{
std::vector<int> ranks_of_cells(const MeshData &whole, const int num_parts, const std::vector<double> &weights)
{
  const int num_cells = whole.num_cells(), width = whole.element.num_nodes();
  RPC_REQUIRE_CODE(num_cells >= num_parts, ExitCode::bad_mesh,
                   "mesh: " << num_cells << " cells cannot be divided among " << num_parts
                            << " ranks. Use fewer ranks or more cells.");
  std::vector<int> part(num_cells, 0);
  if (num_parts == 1) return part; // METIS wants two or more

  const int vertices = whole.element.num_vertices();
  idx_t cells = num_cells, nodes = whole.num_nodes(), parts = num_parts, cut = 0;
  idx_t common = whole.element.facet().num_vertices(); // of neighbours
  std::vector<idx_t> begin, vertex, cell_part(num_cells), node_part(nodes);
  for (int c = 0; c <= num_cells; ++c) begin.push_back(idx_t(vertices) * c);
  for (int c = 0; c < num_cells; ++c)
    for (int v = 0; v < vertices; ++v) vertex.push_back(whole.cells[std::size_t(width) * c + v]);
  std::vector<idx_t> weight;
  constexpr double whole_weight = 1e8; // fits in METIS' numbers, several times
  const double scale = whole_weight / std::max(1., std::accumulate(weights.begin(), weights.end(), 0.));
  for (const double w : weights) weight.push_back(static_cast<idx_t>(std::max(1., std::round(w * scale))));
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1; // the same cut in every run
  const int status =
      METIS_PartMeshDual(&cells, &nodes, begin.data(), vertex.data(), weight.empty() ? nullptr : weight.data(), nullptr,
                         &common, &parts, nullptr, options, &cut, cell_part.data(), node_part.data());
  RPC_REQUIRE_CODE(status == METIS_OK, ExitCode::internal_error,
                   "mesh: METIS could not divide " << num_cells << " cells among " << num_parts
                                                   << " ranks: its status is " << status);
  std::copy(cell_part.begin(), cell_part.end(), part.begin());

  // Where there are hardly more cells than parts, METIS leaves parts empty.
  std::vector<int> size(num_parts, 0);
  for (const int p : part) ++size[p];
  for (int p = 0; p < num_parts; ++p) {
    if (size[p] > 0) continue;
    const int largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
    *std::find(part.begin(), part.end(), largest) = p;
    --size[largest];
    ++size[p];
  }
  return part;
}

int ranks_for(const MeshData &coarse, const int num_ranks)
{
  return std::clamp(coarse.num_cells() / coarsening_rules.least_cells_of_rank, 1, num_ranks);
}

Division divide(const MeshData &whole, const int num_ranks, const std::vector<double> &weights)
{
  return divide_by(whole, num_ranks, ranks_of_cells(whole, num_ranks, weights));
}

Division divide_by(const MeshData &whole, const int num_ranks, const std::vector<int> &part,
                   const std::vector<int> &given_order)
{
  Division division;
  division.cells = sorted_into_lists(part, num_ranks);
  const Lists cells_at = node_to_cells(whole.element, whole.cells, whole.num_nodes());
  auto &owner = division.node_owner;
  for (int n = 0; n < whole.num_nodes(); ++n) {
    int lowest = num_ranks;
    for (const int *cell = cells_at.first(n); cell != cells_at.last(n); ++cell) lowest = std::min(lowest, part[*cell]);
    owner.push_back(lowest);
  }

  // No edge of the graph leads from rank to rank: one call orders the nodes of each.
  const std::vector<int> order = given_order.empty()
                                     ? reverse_cuthill_mckee(node_to_nodes(whole.element, whole.cells, cells_at, owner))
                                     : given_order;
  std::vector<int> owner_in_order;
  for (const int node : order) owner_in_order.push_back(owner[node]);
  division.nodes = sorted_into_lists(owner_in_order, num_ranks);
  division.gid.resize(owner.size());
  for (std::size_t gid = 0; gid < order.size(); ++gid) {
    int &node = division.nodes.value[gid];
    node = order[node];
    division.gid[node] = static_cast<int>(gid);
  }

  std::vector<std::vector<int>> halo(num_ranks);
  const int width = whole.element.num_nodes();
  for (int c = 0; c < whole.num_cells(); ++c)
    for (int a = 0; a < width; ++a) {
      const int rank = owner[whole.cells[std::size_t(width) * c + a]];
      if (rank != part[c] && (halo[rank].empty() || halo[rank].back() != c)) halo[rank].push_back(c);
    }
  for (const auto &cells : halo) {
    division.halo.value.insert(division.halo.value.end(), cells.begin(), cells.end());
    division.halo.begin.push_back(division.halo.value.size());
  }
  return division;
}

} // namespace rpc::mesh
