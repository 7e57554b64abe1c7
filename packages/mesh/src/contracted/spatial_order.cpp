// SPDX-License-Identifier: BSD-3-Clause
#include "spatial_order.hpp"

#include "../sorted_lists.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

namespace rpc::mesh
{
namespace
{

/// Bits of coordinates in turns, from the highest. @param steps  below 2^bits
std::uint64_t interleaved(const std::array<std::uint32_t, 3> &steps, const int dim, const int bits)
{
  std::uint64_t key = 0;
  for (int bit = bits; bit-- > 0;)
    for (int d = 0; d < dim; ++d) key = key << 1 | (steps[d] >> bit & 1U);
  return key;
}

/// Values in the order in which `id` names them.
template <class T>
std::vector<T> taken(const std::vector<T> &from, const std::vector<int> &id, const int width)
{
  std::vector<T> to;
  to.reserve(from.size());
  for (const int n : id)
    to.insert(to.end(), from.begin() + std::ptrdiff_t(width) * n, from.begin() + std::ptrdiff_t(width) * (n + 1));
  return to;
}

std::vector<int> inverse(const std::vector<int> &id)
{
  std::vector<int> place(id.size());
  for (std::size_t n = 0; n < id.size(); ++n) place[id[n]] = static_cast<int>(n);
  return place;
}

} // namespace

std::vector<int> along_morton_curve(const MeshData &mesh)
{
  const int dim = mesh.element.dim, num_nodes = mesh.num_nodes(), bits = 63 / dim;
  std::array<double, 3> lower{};
  double length = 0;
  for (int d = 0; d < dim; ++d) {
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
    for (int n = 0; n < num_nodes; ++n) {
      const double x = mesh.coords[std::size_t(dim) * n + d];
      least = std::min(least, x);
      greatest = std::max(greatest, x);
    }
    lower[d] = least;
    length = std::max(length, greatest - least);
  }
  const double scale = static_cast<double>((std::uint64_t(1) << bits) - 1) / length;
  std::vector<std::pair<std::uint64_t, int>> keys;
  keys.reserve(num_nodes);
  for (int n = 0; n < num_nodes; ++n) {
    std::array<std::uint32_t, 3> steps{};
    for (int d = 0; d < dim; ++d)
      steps[d] = static_cast<std::uint32_t>((mesh.coords[std::size_t(dim) * n + d] - lower[d]) * scale);
    keys.emplace_back(interleaved(steps, dim, bits), n);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> order;
  order.reserve(num_nodes);
  for (const auto &[key, node] : keys) order.push_back(node);
  return order;
}

SpatialOrder renumbered(MeshData mesh, std::vector<int> node_id)
{
  const int width = mesh.element.num_nodes(), num_nodes = mesh.num_nodes(), num_cells = mesh.num_cells();
  const std::vector<int> node_place = inverse(node_id);
  mesh.coords = taken(mesh.coords, node_id, mesh.element.dim);
  std::vector<int> lowest;
  lowest.reserve(num_cells);
  for (auto cell = mesh.cells.begin(); cell != mesh.cells.end(); cell += width) {
    for (auto node = cell; node != cell + width; ++node) *node = node_place[*node];
    lowest.push_back(*std::min_element(cell, cell + width));
  }
  std::vector<int> cell_id = sorted_into_lists(lowest, num_nodes).value;
  if (mesh.blocks.size() > 1) {
    const std::vector<int> block = taken(mesh.block, cell_id, 1);
    const Lists of_block = sorted_into_lists(block, static_cast<int>(mesh.blocks.size()));
    cell_id = taken(cell_id, of_block.value, 1);
  }
  mesh.cells = taken(mesh.cells, cell_id, width);
  mesh.block = taken(mesh.block, cell_id, 1);
  const std::vector<int> cell_place = inverse(cell_id);
  for (SideData &side : mesh.sides)
    for (int &cell : side.cell) cell = cell_place[cell];
  for (BoundaryPart &part : mesh.geometry)
    for (int &cell : part.cell) cell = cell_place[cell];
  for (PointData &set : mesh.points) {
    for (int &node : set.node) node = node_place[node];
    std::sort(set.node.begin(), set.node.end());
  }
  return {std::move(mesh), std::move(node_id), std::move(cell_id)};
}

} // namespace rpc::mesh
