// SPDX-License-Identifier: BSD-3-Clause
#include "kept_vertices.hpp"

#include "../sorted_lists.hpp"
#include "rpc/mesh/rules.hpp"
#include "rpc/mesh/topology.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace rpc::mesh
{
namespace
{

using Rank = Features::Rank;

/// Vertices next to each along what those of a rank lie on: the edges of the boundary, its facets, or the body.
Lists neighbours(const MeshData &mesh, const Features &features, const Rank rank)
{
  if (rank == Rank::inside)
    return node_to_nodes(mesh.element, mesh.cells, node_to_cells(mesh.element, mesh.cells, mesh.num_nodes()),
                         std::vector<int>(mesh.num_nodes(), 0));
  std::vector<int> ends; // two of each edge
  if (rank == Rank::face)
    for (const FeatureFacet &facet : features.facets)
      for (int k = 0; k < mesh.element.dim; ++k) {
        const int next = facet.vertex[(k + 1) % mesh.element.dim];
        ends.insert(ends.end(), {facet.vertex[k], next}); // once from each side
      }
  if (rank == Rank::edge)
    for (int v = 0; v < mesh.num_nodes(); ++v)
      for (const int w : features.next_edge[v])
        if (v < w) ends.insert(ends.end(), {v, w});
  Lists lists = sorted_into_lists(ends, mesh.num_nodes());
  for (int &entry : lists.value) entry = ends[static_cast<std::size_t>(entry ^ 1)];
  return lists;
}

/// Without edges that are much longer than the shortest ones at both ends: anisotropic cells become coarser in their short directions only.
Lists without_long_edges(const MeshData &mesh, const Lists &next)
{
  const int dim = mesh.element.dim, num_nodes = mesh.num_nodes();
  const auto squared = [&](const int v, const int w) {
    double sum = 0;
    for (int d = 0; d < dim; ++d) {
      const double along = mesh.coords[std::size_t(dim) * w + d] - mesh.coords[std::size_t(dim) * v + d];
      sum += along * along;
    }
    return sum;
  };
  std::vector<double> shortest(num_nodes, std::numeric_limits<double>::infinity());
  for (int v = 0; v < num_nodes; ++v)
    for (const int *w = next.first(v); w != next.last(v); ++w) shortest[v] = std::min(shortest[v], squared(v, *w));
  Lists lists;
  for (int v = 0; v < num_nodes; ++v) {
    for (const int *w = next.first(v); w != next.last(v); ++w)
      if (squared(v, *w) <=
          contraction_rules.most_stretched * contraction_rules.most_stretched * std::max(shortest[v], shortest[*w]))
        lists.value.push_back(*w);
    lists.begin.push_back(lists.value.size());
  }
  return lists;
}

} // namespace

std::vector<char> kept_vertices(const MeshData &mesh, const Features &features)
{
  enum : char { unknown, kept, moves };
  const int num_nodes = mesh.num_nodes();
  std::vector<char> state(num_nodes, unknown);
  std::vector<int> front; // all that are kept
  for (int v = 0; v < num_nodes; ++v)
    if (features.rank[v] == Rank::corner) front.push_back(v);
  for (const Rank rank : {Rank::edge, Rank::face, Rank::inside}) {
    const Lists next = without_long_edges(mesh, neighbours(mesh, features, rank));
    const auto is_open = [&](const int v) { return state[v] == unknown && features.rank[v] == rank; };
    const auto keep = [&](const int v) {
      state[v] = kept;
      for (const int *w = next.first(v); w != next.last(v); ++w)
        if (is_open(*w)) state[*w] = moves;
    };
    for (const int v : front) keep(v);
    const auto grow = [&](std::size_t k) { // two edges at a time
      for (; k < front.size(); ++k)
        for (const int *w = next.first(front[k]); w != next.last(front[k]); ++w)
          for (const int *u = next.first(*w); u != next.last(*w); ++u)
            if (is_open(*u)) {
              front.push_back(*u);
              keep(*u);
            }
    };
    grow(0);
    for (int v = 0; v < num_nodes; ++v) { // where none leads
      if (!is_open(v)) continue;
      front.push_back(v);
      keep(v);
      grow(front.size() - 1);
    }
  }
  for (char &s : state) s = s == kept ? 1 : 0;
  return state;
}

} // namespace rpc::mesh
