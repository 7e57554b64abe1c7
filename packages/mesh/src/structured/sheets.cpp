// SPDX-License-Identifier: BSD-3-Clause
#include "sheets.hpp"

#include "parity_sets.hpp"

#include <cmath>

namespace rpc::mesh
{
namespace
{

/// The edges of a cell by their direction: local nodes of both ends, in that direction.
struct DirectedEdge {
  int direction, begin, end;
};

std::vector<DirectedEdge> directed_edges(const Element &element)
{
  std::vector<DirectedEdge> directed;
  for (const auto &edge : element.edges()) {
    const auto &a = element.lattice()[edge[0]], &b = element.lattice()[edge[1]];
    int direction = 0;
    while (a[direction] == b[direction]) ++direction;
    const bool along = a[direction] < b[direction];
    directed.push_back({direction, edge[along ? 0 : 1], edge[along ? 1 : 0]});
  }
  return directed;
}

} // namespace

std::optional<Sheets> sheets_of(const MeshData &mesh)
{
  const Element &element = mesh.element;
  const int dim = element.dim, width = element.num_nodes(), num_cells = mesh.num_cells();
  const Entities edges = edges_of(element, mesh.cells);
  const auto directed = directed_edges(element);
  const auto nodes_of = [&](const int cell) { return &mesh.cells[std::size_t(width) * cell]; };
  // An edge is directed from its lower node to the higher one; its parity tells whether its class is directed the other way.
  const auto is_reversed = [&](const int cell, const DirectedEdge &edge) {
    return nodes_of(cell)[edge.begin] > nodes_of(cell)[edge.end];
  };
  ParitySets parallel(edges.size());
  std::vector<int> first(dim); // edge of a cell in each direction
  for (int e = edges.per_cell - 1; e >= 0; --e) first[directed[e].direction] = e;
  for (int c = 0; c < num_cells; ++c) {
    const int *const of_cell = &edges.of_cell[std::size_t(edges.per_cell) * c];
    for (int e = 0; e < edges.per_cell; ++e) {
      const int f = first[directed[e].direction];
      if (!parallel.join(of_cell[e], of_cell[f], is_reversed(c, directed[e]) != is_reversed(c, directed[f])))
        return std::nullopt;
    }
  }
  Sheets sheets;
  sheets.dim = dim;
  std::vector<int> number(edges.size(), -1), num_edges; // of the classes
  for (int c = 0; c < num_cells; ++c)
    for (int d = 0; d < dim; ++d) {
      const auto [root, odd] = parallel.find(edges.of_cell[std::size_t(edges.per_cell) * c + first[d]]);
      if (number[root] < 0) {
        number[root] = sheets.count++;
        sheets.thickness.push_back(0);
        num_edges.push_back(0);
      }
      sheets.of_cell.push_back(number[root]);
      sheets.sign.push_back(is_reversed(c, directed[first[d]]) != odd ? -1 : 1);
    }
  for (int e = 0; e < edges.size(); ++e) {
    const int sheet = number[parallel.find(e).root];
    const double *const a = &mesh.coords[std::size_t(dim) * edges.vertices[2 * std::size_t(e)]];
    const double *const b = &mesh.coords[std::size_t(dim) * edges.vertices[2 * std::size_t(e) + 1]];
    double squared = 0;
    for (int d = 0; d < dim; ++d) squared += (b[d] - a[d]) * (b[d] - a[d]);
    sheets.thickness[sheet] += std::sqrt(squared);
    ++num_edges[sheet];
  }
  for (int s = 0; s < sheets.count; ++s) sheets.thickness[s] /= num_edges[s];
  return sheets;
}

std::vector<FacetPlace> facet_places(const Element &element)
{
  std::vector<FacetPlace> places;
  for (const auto &facet : element.facets())
    for (int d = 0; d < element.dim; ++d) {
      const int at = element.lattice()[facet[0]][d];
      bool all = true;
      for (const int node : facet) all = all && element.lattice()[node][d] == at;
      if (all) places.push_back({d, at > 0});
    }
  return places;
}

} // namespace rpc::mesh
