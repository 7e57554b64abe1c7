// SPDX-License-Identifier: BSD-3-Clause
#include "whole_mesh.hpp"

#include "refine/local_mesh.hpp"
#include "size_tree.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::mesh
{
namespace
{

/// Ends of the longest edge.
template <int dim>
std::pair<int, int> longest_edge(const SimplexVertices<dim> &x)
{
  std::pair<int, int> longest{0, 1};
  double most = -1;
  for (int a = 0; a <= dim; ++a)
    for (int b = a + 1; b <= dim; ++b) {
      double squared = 0;
      for (int d = 0; d < dim; ++d) squared += (x[b][d] - x[a][d]) * (x[b][d] - x[a][d]);
      if (squared <= most) continue;
      most = squared;
      longest = {a, b};
    }
  return longest;
}

/// Halves the cell in thought until its parts are small enough.
template <int dim>
double parts_of(const SimplexVertices<dim> &x, const SizeTree<dim> &size, const int depth)
{
  constexpr int deepest = 120;                              // 2^40 times as small, in space
  const double times = std::pow(excess<dim>(size, x), dim); // as many cells
  if (!(times > 2) || depth == deepest) return std::max(1., times);
  const auto [a, b] = longest_edge<dim>(x);
  std::array<double, dim> middle;
  for (int d = 0; d < dim; ++d) middle[d] = (x[a][d] + x[b][d]) / 2;
  SimplexVertices<dim> one = x, other = x;
  one[a] = middle;
  other[b] = middle;
  return parts_of<dim>(one, size, depth + 1) + parts_of<dim>(other, size, depth + 1);
}

template <int dim>
std::vector<double> cells_in(const MeshData &mesh, const SizeField &sizes, const int refinements)
{
  const SizeTree<dim> size(sizes);
  const int width = mesh.element.num_nodes();
  std::vector<double> cells(mesh.num_cells());
  const Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace, Kokkos::Schedule<Kokkos::Dynamic>, int> all(
      0, mesh.num_cells());
  Kokkos::parallel_for("rpc::mesh::cells_to_come", all, [&](const int c) {
    SimplexVertices<dim> x;
    for (int v = 0; v <= dim; ++v)
      std::copy_n(&mesh.coords[std::size_t(dim) * mesh.cells[std::size_t(width) * c + v]], dim, x[v].begin());
    cells[c] = std::max(parts_of<dim>(x, size, 0), std::pow(2., dim * refinements));
  });
  return cells;
}

} // namespace

MeshData whole_mesh(const Mesh &mesh)
{
  const LocalMesh local = local_mesh(mesh);
  const int dim = mesh.dim(), width = mesh.element.num_nodes(), num_cells = local.num_cells();
  MeshData whole;
  whole.element = mesh.element;
  whole.blocks = mesh.blocks;
  whole.coords.resize(local.coords.size());
  for (int n = 0; n < local.num_nodes(); ++n)
    std::copy_n(&local.coords[std::size_t(dim) * n], dim, &whole.coords[std::size_t(dim) * local.id[n]]);
  whole.cells.resize(local.cells.size());
  whole.block.resize(num_cells);
  for (int c = 0; c < num_cells; ++c) {
    whole.block[local.cell_id[c]] = local.block[c];
    for (int a = 0; a < width; ++a)
      whole.cells[std::size_t(width) * local.cell_id[c] + a] = static_cast<int>(local.id[local.nodes_of(c)[a]]);
  }
  for (SideData side : local.sides) {
    for (int &cell : side.cell) cell = static_cast<int>(local.cell_id[cell]);
    whole.sides.push_back(std::move(side));
  }
  for (PointData set : local.points) {
    for (int &node : set.node) node = static_cast<int>(local.id[node]);
    std::sort(set.node.begin(), set.node.end());
    whole.points.push_back(std::move(set));
  }
  return whole;
}

std::vector<double> cells_to_come(const MeshData &mesh, const SizeField &sizes, const int refinements)
{
  return sizes.dim == 2 ? cells_in<2>(mesh, sizes, refinements) : cells_in<3>(mesh, sizes, refinements);
}

} // namespace rpc::mesh
