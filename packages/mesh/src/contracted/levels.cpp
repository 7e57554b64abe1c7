// SPDX-License-Identifier: BSD-3-Clause
#include "../division.hpp"
#include "../middle_nodes.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/contracted.hpp"
#include "rpc/mesh/rules.hpp"
#include "spatial_order.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace rpc::mesh
{
namespace
{

/// (nodes) The plane of a lattice that each lies in, by its coordinate in a direction; coordinates that differ by less than 1e-9 of all are equal.
std::vector<int> planes_of(const MeshData &mesh, const int direction)
{
  constexpr double equal = 1e-9;
  const int num_nodes = mesh.num_nodes();
  const auto x = [&](const int n) { return mesh.coords[std::size_t(mesh.element.dim) * n + direction]; };
  std::vector<int> sorted(num_nodes), plane(num_nodes);
  std::iota(sorted.begin(), sorted.end(), 0);
  std::sort(sorted.begin(), sorted.end(), [&](const int a, const int b) { return x(a) < x(b); });
  const double tolerance = equal * (x(sorted.back()) - x(sorted.front()));
  for (int k = 1; k < num_nodes; ++k)
    plane[sorted[k]] = plane[sorted[k - 1]] + (x(sorted[k]) - x(sorted[k - 1]) > tolerance ? 1 : 0);
  return plane;
}

/// (nodes) Along the axes, where the nodes fill at least half of a lattice of planes across these, the one with the fewest planes fastest:
/// neighbours lie alike then, and where cells are alike rows of the matrix repeat as those of a box do. Else none.
std::vector<int> order_along_axes(const MeshData &mesh)
{
  const int dim = mesh.element.dim, num_nodes = mesh.num_nodes();
  std::vector<std::pair<int, std::vector<int>>> axes; // number of planes, plane of each node
  double places = 1;
  for (int d = 0; d < dim; ++d) {
    std::vector<int> plane = planes_of(mesh, d);
    const int count = *std::max_element(plane.begin(), plane.end()) + 1;
    if ((places *= count) > 2. * num_nodes) return {};
    axes.emplace_back(count, std::move(plane));
  }
  std::stable_sort(axes.begin(), axes.end(), [](const auto &a, const auto &b) { return a.first > b.first; });
  std::vector<GO> place(num_nodes, 0);
  for (const auto &[count, plane] : axes)
    for (int n = 0; n < num_nodes; ++n) place[n] = place[n] * count + plane[n];
  std::vector<int> order(num_nodes);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](const int a, const int b) { return place[a] < place[b]; });
  return order;
}

/// From the finest to the coarsest, on rank 0.
std::vector<MeshData> contracted_levels(MeshData finest)
{
  std::vector<MeshData> levels;
  levels.push_back(std::move(finest));
  if (levels.front().element.shape != Shape::simplex) return levels;
  const int dim = levels.front().element.dim, order = levels.front().element.order;
  for (MeshData mesh = levels.front();;) { // of order 1 but for the first
    const int vertices = mesh.num_nodes();
    if (dim * vertices <= coarsening_rules.few) break;
    auto coarse = contracted(mesh);
    if (!coarse || coarse->num_cells() < coarsening_rules.least_cells_of_rank) break;
    levels.push_back(order == 2 ? with_middle_nodes(*coarse) : *coarse);
    mesh = std::move(*coarse);
  }
  return levels;
}

} // namespace

std::shared_ptr<const Mesh> distribute_with_contracted(MeshData whole, const RCP<const Comm> &comm)
{
  std::vector<MeshData> levels;
  std::vector<int> node_id, cell_id; // of the finest
  bool along_axes = false;
  on_root(*comm, ExitCode::internal_error, [&] {
    std::vector<int> order = order_along_axes(whole);
    along_axes = !order.empty();
    if (!along_axes) order = along_morton_curve(whole);
    SpatialOrder finest = renumbered(std::move(whole), std::move(order));
    node_id = std::move(finest.node_id);
    cell_id = std::move(finest.cell_id);
    levels = contracted_levels(std::move(finest.mesh));
  });
  const GO num_levels = sum_all(*comm, static_cast<GO>(levels.size()));
  levels.resize(num_levels); // empty ones on other ranks
  std::shared_ptr<const Mesh> coarse;
  for (GO k = num_levels; k-- > 0;) {
    Division division;
    on_root(*comm, ExitCode::internal_error, [&] {
      const MeshData &whole_level = levels[k];
      std::vector<int> order;
      if (k == 0 && along_axes) {
        order.resize(whole_level.num_nodes());
        std::iota(order.begin(), order.end(), 0);
      }
      const int ranks = k == 0 ? comm->getSize() : ranks_for(whole_level, comm->getSize());
      division = divide_by(whole_level, comm->getSize(), ranks_of_cells(whole_level, ranks), order);
      division.sorts_cells = !order.empty();
      if (k > 0) return;
      division.node_id = std::move(node_id);
      division.cell_id = std::move(cell_id);
    });
    auto mesh = std::make_shared<Mesh>(distribute(levels[k], comm, division));
    levels[k] = {};
    if (coarse) {
      auto parents = std::make_shared<Parents>();
      parents->mesh = coarse;
      parents->nested = false;
      mesh->parents = std::move(parents);
    }
    coarse = std::move(mesh);
  }
  return coarse;
}

} // namespace rpc::mesh
