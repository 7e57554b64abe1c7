// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/topology.hpp"

#include "sorted_lists.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace rpc::mesh
{
namespace
{

constexpr int most_vertices = 4; // of a quadrilateral

/// Vertices, ascending and filled up with the largest integer: compared as a whole.
using VertexKey = std::array<int, most_vertices>;

/// @param local  which nodes of the cell the entity has, vertices first
VertexKey key_of(const int *const cell, const std::vector<int> &local, const int num_vertices)
{
  VertexKey key;
  key.fill(std::numeric_limits<int>::max());
  for (int v = 0; v < num_vertices; ++v) {
    int at = v;
    for (; at > 0 && key[at - 1] > cell[local[v]]; --at) key[at] = key[at - 1];
    key[at] = cell[local[v]];
  }
  return key;
}

/// @param table  local nodes of each entity of a cell, vertices first
Entities entities_of(const Element &element, const Element::Table &table, const int num_vertices,
                     const std::vector<int> &cells)
{
  Entities entities;
  entities.per_cell = static_cast<int>(table.size());
  entities.num_vertices = num_vertices;
  const std::size_t width = element.num_nodes(), num_cells = cells.size() / width;
  const auto key_at = [&](const std::size_t occurrence) {
    return key_of(&cells[width * (occurrence / table.size())], table[occurrence % table.size()], num_vertices);
  };
  std::vector<int> &of_cell = entities.of_cell;
  of_cell.resize(num_cells * table.size());
  int last_node = -1;
  for (std::size_t k = 0; k < of_cell.size(); ++k) {
    of_cell[k] = key_at(k)[0];
    last_node = std::max(last_node, of_cell[k]);
  }
  Lists by_lowest = sorted_into_lists(of_cell, last_node + 1); // of vertices: then only a few are left to sort
  entities.occurrences.value = std::move(by_lowest.value);
  auto occurrence = entities.occurrences.value.begin();
  std::vector<std::pair<VertexKey, int>> few; // vertices, occurrence
  int entity = -1;
  for (int node = 0; node <= last_node; ++node) {
    few.clear();
    for (int k = 0; k < by_lowest.size_of(node); ++k) few.emplace_back(key_at(occurrence[k]), occurrence[k]);
    std::sort(few.begin(), few.end());
    for (std::size_t k = 0; k < few.size(); ++k, ++occurrence) {
      const VertexKey &key = few[k].first;
      if (k == 0 || key != few[k - 1].first) {
        if (++entity > 0) entities.occurrences.begin.push_back(occurrence - entities.occurrences.value.begin());
        entities.vertices.insert(entities.vertices.end(), key.begin(), key.begin() + num_vertices);
      }
      *occurrence = few[k].second;
      of_cell[*occurrence] = entity;
    }
  }
  if (entity >= 0) entities.occurrences.begin.push_back(of_cell.size());
  return entities;
}

/// Whether the vertex of each entity with the lowest gid is an owned node.
std::vector<char> owned(const Entities &entities, const Mesh &mesh)
{
  std::vector<char> owns;
  for (int e = 0; e < entities.size(); ++e) {
    const int *const vertex = &entities.vertices[std::size_t(entities.num_vertices) * e];
    const int lowest = *std::min_element(vertex, vertex + entities.num_vertices,
                                         [&](const int a, const int b) { return mesh.node_gid(a) < mesh.node_gid(b); });
    owns.push_back(lowest < mesh.num_owned_nodes() ? 1 : 0);
  }
  return owns;
}

} // namespace

std::optional<int> Entities::find(std::vector<int> with) const
{
  std::sort(with.begin(), with.end());
  int low = 0, high = size();
  while (low < high) {
    const int middle = low + (high - low) / 2;
    const auto at = vertices.begin() + std::ptrdiff_t(num_vertices) * middle;
    if (std::lexicographical_compare(at, at + num_vertices, with.begin(), with.end()))
      low = middle + 1;
    else
      high = middle;
  }
  if (low == size()) return std::nullopt;
  const auto at = vertices.begin() + std::ptrdiff_t(num_vertices) * low;
  return std::equal(at, at + num_vertices, with.begin(), with.end()) ? std::optional<int>(low) : std::nullopt;
}

Entities facets_of(const Element &element, const std::vector<int> &cells)
{
  return entities_of(element, element.facets(), element.facet().num_vertices(), cells);
}

Entities edges_of(const Element &element, const std::vector<int> &cells)
{
  return entities_of(element, element.edges(), 2, cells);
}

Lists node_to_cells(const Element &element, const std::vector<int> &cells, const int num_nodes)
{
  Lists lists = sorted_into_lists(cells, num_nodes);
  for (int &entry : lists.value) entry /= element.num_nodes(); // of an entry of `cells`, its cell
  return lists;
}

Lists node_to_nodes(const Element &element, const std::vector<int> &cells, const Lists &cells_at,
                    const std::vector<int> &owner)
{
  const int width = element.num_nodes();
  Lists lists;
  std::vector<int> seen_by(owner.size(), -1);
  for (int node = 0; node < static_cast<int>(owner.size()); ++node) {
    seen_by[node] = node;
    for (const int *cell = cells_at.first(node); cell != cells_at.last(node); ++cell)
      for (int a = 0; a < width; ++a) {
        const int other = cells[std::size_t(width) * *cell + a];
        if (owner[other] == owner[node] && std::exchange(seen_by[other], node) != node) lists.value.push_back(other);
      }
    lists.begin.push_back(lists.value.size());
  }
  return lists;
}

Topology topology(const Mesh &mesh)
{
  const auto host = to_host(mesh.cells);
  std::vector<int> cells;
  cells.reserve(host.extent(0) * host.extent(1));
  for (std::size_t c = 0; c < host.extent(0); ++c)
    for (std::size_t a = 0; a < host.extent(1); ++a) cells.push_back(host(c, a));
  Topology result;
  result.facets = facets_of(mesh.element, cells);
  result.edges = edges_of(mesh.element, cells);
  result.owns_facet = owned(result.facets, mesh);
  result.owns_edge = owned(result.edges, mesh);
  return result;
}

} // namespace rpc::mesh
