// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/topology.hpp"

#include "sorted_lists.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace rpc::mesh
{
namespace
{

constexpr int most_vertices = 4; // of a quadrilateral

/// An entity as one cell has it, compared as a whole: its vertices but the lowest one, ascending, then the occurrence.
using Ordered = std::pair<std::uint64_t, std::uint64_t>;

std::uint64_t packed(const int high, const int low)
{
  return static_cast<std::uint64_t>(high) << 32 | static_cast<std::uint64_t>(low);
}

/// @param vertices  ascending, `count` of them
Ordered ordered(const int *const vertices, const int count, const int occurrence)
{
  return {packed(vertices[1], count > 2 ? vertices[2] : 0), packed(count > 3 ? vertices[3] : 0, occurrence)};
}
bool same_vertices(const Ordered &a, const Ordered &b)
{
  return a.first == b.first && a.second >> 32 == b.second >> 32;
}

/// @param table  local nodes of each entity of a cell, vertices first
Entities entities_of(const Element &element, const Element::Table &table, const int num_vertices,
                     const std::vector<int> &cells)
{
  Entities entities;
  entities.per_cell = static_cast<int>(table.size());
  entities.num_vertices = num_vertices;
  const unsigned per_cell = entities.per_cell; // 32 bits divide faster
  const std::size_t width = element.num_nodes(), num_cells = cells.size() / width;
  std::vector<int> &of_cell = entities.of_cell;
  of_cell.resize(num_cells * per_cell);
  int last_node = -1;
  for (std::size_t c = 0, k = 0; c < num_cells; ++c)
    for (const std::vector<int> &local : table) {
      const int *const cell = &cells[width * c];
      int lowest = cell[local[0]];
      for (int v = 1; v < num_vertices; ++v) lowest = std::min(lowest, cell[local[v]]);
      of_cell[k++] = lowest;
      last_node = std::max(last_node, lowest);
    }
  Lists by_lowest = sorted_into_lists(of_cell, last_node + 1); // of vertices: then only a few are left to sort
  entities.occurrences.value = std::move(by_lowest.value);
  auto occurrence = entities.occurrences.value.begin();
  std::vector<Ordered> few;
  int entity = -1;
  for (int node = 0; node <= last_node; ++node) {
    few.clear();
    for (int k = 0; k < by_lowest.size_of(node); ++k) {
      const unsigned at = occurrence[k], c = at / per_cell;
      const std::vector<int> &local = table[at - c * per_cell];
      const int *const cell = &cells[width * c];
      int vertices[most_vertices];
      for (int v = 0; v < num_vertices; ++v) {
        int to = v;
        for (; to > 0 && vertices[to - 1] > cell[local[v]]; --to) vertices[to] = vertices[to - 1];
        vertices[to] = cell[local[v]];
      }
      few.push_back(ordered(vertices, num_vertices, static_cast<int>(at)));
    }
    std::sort(few.begin(), few.end());
    for (std::size_t k = 0; k < few.size(); ++k, ++occurrence) {
      if (k == 0 || !same_vertices(few[k], few[k - 1])) {
        if (++entity > 0) entities.occurrences.begin.push_back(occurrence - entities.occurrences.value.begin());
        const int vertices[most_vertices] = {node, static_cast<int>(few[k].first >> 32), static_cast<int>(few[k].first),
                                             static_cast<int>(few[k].second >> 32)};
        entities.vertices.insert(entities.vertices.end(), vertices, vertices + num_vertices);
      }
      *occurrence = static_cast<int>(few[k].second & std::numeric_limits<std::uint32_t>::max());
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
