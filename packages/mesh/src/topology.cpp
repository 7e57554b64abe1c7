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
using Key = std::array<int, most_vertices>;

/// @param local  which nodes of the cell the entity has, vertices first
Key key_of(const int *const cell, const std::vector<int> &local, const int num_vertices)
{
  Key key;
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
  std::vector<std::pair<Key, int>> all; // vertices, occurrence
  all.reserve(num_cells * table.size());
  for (std::size_t c = 0; c < num_cells; ++c)
    for (const auto &local : table)
      all.emplace_back(key_of(&cells[width * c], local, num_vertices), static_cast<int>(all.size()));
  std::sort(all.begin(), all.end());
  entities.of_cell.resize(all.size());
  entities.occurrences.value.reserve(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto &[key, occurrence] = all[k];
    if (k == 0 || key != all[k - 1].first) {
      if (k > 0) entities.occurrences.begin.push_back(k);
      entities.vertices.insert(entities.vertices.end(), key.begin(), key.begin() + num_vertices);
    }
    entities.of_cell[occurrence] = entities.size();
    entities.occurrences.value.push_back(occurrence);
  }
  if (!all.empty()) entities.occurrences.begin.push_back(all.size());
  return entities;
}

/// Whether the vertex of each entity with the lowest gid is an owned node.
std::vector<char> owned(const Entities &entities, const Mesh &mesh)
{
  std::vector<char> owns;
  for (int e = 0; e < entities.size(); ++e) {
    const int *const vertex = &entities.vertices[std::size_t(entities.num_vertices) * e];
    const int lowest = *std::min_element(vertex, vertex + entities.num_vertices, [&](const int a, const int b) {
      return mesh.overlap_nodes->getGlobalElement(a) < mesh.overlap_nodes->getGlobalElement(b);
    });
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
