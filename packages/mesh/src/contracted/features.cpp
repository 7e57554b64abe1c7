// SPDX-License-Identifier: BSD-3-Clause
#include "features.hpp"

#include "../sorted_lists.hpp"
#include "rpc/mesh/rules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace rpc::mesh
{
namespace
{

double cosine(const std::array<double, 3> &a, const std::array<double, 3> &b)
{
  double ab = 0, aa = 0, bb = 0;
  for (int d = 0; d < 3; ++d) {
    ab += a[d] * b[d];
    aa += a[d] * a[d];
    bb += b[d] * b[d];
  }
  return ab / std::sqrt(aa * bb);
}

/// A facet of the boundary, or between two blocks.
struct Found {
  int cell, ordinal, beyond; ///< the block beyond; -1: none
};

/// In the order of their lowest vertices. What lies beyond a facet is found among those with the same lowest vertex, which are few.
std::vector<Found> feature_facets(const MeshData &mesh)
{
  const int dim = mesh.element.dim, width = mesh.element.num_nodes(), per_cell = dim + 1;
  const auto &facets = mesh.element.facets();
  std::vector<std::array<int, 3>> key; // (cells, facets) vertices, ascending
  std::vector<int> lowest;
  for (int c = 0; c < mesh.num_cells(); ++c)
    for (int f = 0; f < per_cell; ++f) {
      std::array<int, 3> vertices;
      vertices.fill(std::numeric_limits<int>::max());
      for (int k = 0; k < dim; ++k) vertices[k] = mesh.cells[std::size_t(width) * c + facets[f][k]];
      std::sort(vertices.begin(), vertices.end());
      key.push_back(vertices);
      lowest.push_back(vertices[0]);
    }
  const Lists at = sorted_into_lists(lowest, mesh.num_nodes());
  std::vector<Found> found;
  std::vector<int> open; // facets with one cell so far
  for (int v = 0; v < mesh.num_nodes(); ++v) {
    open.clear();
    const std::size_t first = found.size();
    for (const int *f = at.first(v); f != at.last(v); ++f) {
      const auto same = std::find_if(open.begin(), open.end(), [&](const int g) { return key[g] == key[*f]; });
      if (same == open.end()) {
        open.push_back(*f);
        continue;
      }
      const int here = mesh.block[*same / per_cell], beyond = mesh.block[*f / per_cell];
      if (here != beyond) found.push_back({*same / per_cell, *same % per_cell, beyond});
      *same = open.back();
      open.pop_back();
    }
    for (const int f : open) found.push_back({f / per_cell, f % per_cell, -1});
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(),
              [](const Found &a, const Found &b) { return std::tie(a.cell, a.ordinal) < std::tie(b.cell, b.ordinal); });
  }
  return found;
}

/// (cells, facets) A number for the list of sides that each facet belongs to; 0: none.
std::vector<int> sides_at(const MeshData &mesh, std::vector<std::vector<int>> &lists)
{
  const int per_cell = mesh.element.dim + 1;
  std::vector<int> list(std::size_t(per_cell) * mesh.num_cells(), 0);
  std::map<std::pair<int, int>, int> longer; // by a list, and the side that is added to it
  lists = {{}};
  for (std::size_t s = 0; s < mesh.sides.size(); ++s)
    for (std::size_t f = 0; f < mesh.sides[s].cell.size(); ++f) {
      int &here = list[std::size_t(per_cell) * mesh.sides[s].cell[f] + mesh.sides[s].ordinal[f]];
      const auto [at, is_new] =
          longer.emplace(std::make_pair(here, static_cast<int>(s)), static_cast<int>(lists.size()));
      if (is_new) {
        lists.push_back(lists[here]);
        lists.back().push_back(static_cast<int>(s));
      }
      here = at->second;
    }
  return list;
}

/// Finds edges and corners among the facets.
class Ranks
{
public:
  Ranks(const MeshData &mesh, Features &features)
      : mesh_(mesh), features_(features), dim_(mesh.element.dim), facets_at_(facets_at())
  {
  }
  void find()
  {
    using Rank = Features::Rank;
    const int num_nodes = mesh_.num_nodes();
    features_.rank.assign(num_nodes, Rank::inside);
    features_.next_edge.resize(num_nodes);
    for (const FeatureFacet &facet : features_.facets)
      for (int k = 0; k < dim_; ++k) features_.rank[facet.vertex[k]] = Rank::face;
    if (dim_ == 3) find_edges();
    for (int n = 0; n < num_nodes; ++n) {
      if (features_.rank[n] == Rank::inside) continue;
      if (dim_ == 2 ? is_corner_in_plane(n) : is_corner_in_space(n))
        features_.rank[n] = Rank::corner;
      else if (!features_.next_edge[n].empty())
        features_.rank[n] = Rank::edge;
    }
    for (const PointData &set : mesh_.points)
      for (const int node : set.node) features_.rank[node] = Rank::corner;
  }

private:
  Lists facets_at() const
  {
    std::vector<int> vertices;
    for (const FeatureFacet &facet : features_.facets)
      vertices.insert(vertices.end(), facet.vertex.begin(), facet.vertex.begin() + dim_);
    Lists lists = sorted_into_lists(vertices, mesh_.num_nodes());
    for (int &entry : lists.value) entry /= dim_;
    return lists;
  }
  /// Whether two facets that meet go on into each other.
  bool go_on(const int f, const int g) const
  {
    const FeatureFacet &a = features_.facets[f], &b = features_.facets[g];
    return a.label == b.label &&
           cosine(facet_normal(mesh_, a.vertex), facet_normal(mesh_, b.vertex)) > contraction_rules.least_cosine;
  }
  void find_edges()
  {
    std::map<std::pair<int, int>, std::vector<int>> around;
    for (std::size_t f = 0; f < features_.facets.size(); ++f)
      for (int k = 0; k < 3; ++k) {
        const int a = features_.facets[f].vertex[k], b = features_.facets[f].vertex[(k + 1) % 3];
        around[{std::min(a, b), std::max(a, b)}].push_back(static_cast<int>(f));
      }
    for (const auto &[ends, facets] : around) {
      if (facets.size() == 2 && go_on(facets[0], facets[1])) continue;
      features_.next_edge[ends.first].push_back(ends.second);
      features_.next_edge[ends.second].push_back(ends.first);
    }
  }
  bool turns(const int from, const int at, const int to) const
  {
    std::array<double, 3> before{}, after{};
    for (int d = 0; d < dim_; ++d) {
      const auto x = [&](const int n) { return mesh_.coords[std::size_t(dim_) * n + d]; };
      before[d] = x(at) - x(from);
      after[d] = x(to) - x(at);
    }
    return !(cosine(before, after) > contraction_rules.least_cosine);
  }
  bool is_corner_in_plane(const int n) const
  {
    const int *const facets = facets_at_.first(n);
    return facets_at_.size_of(n) != 2 || !go_on(facets[0], facets[1]);
  }
  bool is_corner_in_space(const int n) const
  {
    const auto &next = features_.next_edge[n];
    if (!next.empty() && (next.size() != 2 || turns(next[0], n, next[1]))) return true;
    return !hangs_together(n);
  }
  /// Whether the facets at a vertex lead to each other across edges.
  bool hangs_together(const int n) const
  {
    std::vector<int> left(facets_at_.first(n), facets_at_.last(n)), reached{left.back()};
    left.pop_back();
    for (std::size_t k = 0; k < reached.size(); ++k)
      for (std::size_t l = left.size(); l-- > 0;) {
        if (num_common(reached[k], left[l]) < 2) continue;
        reached.push_back(left[l]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(l));
      }
    return left.empty();
  }
  int num_common(const int f, const int g) const
  {
    const auto &a = features_.facets[f].vertex, &b = features_.facets[g].vertex;
    return static_cast<int>(
        std::count_if(a.begin(), a.end(), [&b](const int v) { return std::find(b.begin(), b.end(), v) != b.end(); }));
  }

  const MeshData &mesh_;
  Features &features_;
  const int dim_;
  const Lists facets_at_;
};

} // namespace

std::array<double, 3> facet_normal(const MeshData &mesh, const std::array<int, 3> &vertex)
{
  const int dim = mesh.element.dim;
  double edge[2][3] = {};
  for (int k = 1; k < dim; ++k)
    for (int d = 0; d < dim; ++d)
      edge[k - 1][d] = mesh.coords[std::size_t(dim) * vertex[k] + d] - mesh.coords[std::size_t(dim) * vertex[0] + d];
  if (dim == 2) return {edge[0][1], -edge[0][0], 0};
  std::array<double, 3> normal{};
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    normal[d] = edge[0][e] * edge[1][f] - edge[0][f] * edge[1][e];
  }
  return normal;
}

Features features_of(const MeshData &mesh)
{
  std::vector<std::vector<int>> lists;
  const std::vector<int> sides = sides_at(mesh, lists);
  const int width = mesh.element.num_nodes(), per_cell = mesh.element.dim + 1;
  Features features;
  std::map<std::array<int, 3>, int> labels; // by the list of sides, and the blocks
  for (const Found &found : feature_facets(mesh)) {
    const int list = sides[std::size_t(per_cell) * found.cell + found.ordinal];
    const auto [label, is_new] =
        labels.emplace(std::array<int, 3>{list, mesh.block[found.cell], found.beyond}, static_cast<int>(labels.size()));
    if (is_new) features.sides.push_back(lists[list]);
    FeatureFacet facet{{-1, -1, -1}, label->second};
    for (int k = 0; k < mesh.element.dim; ++k)
      facet.vertex[k] = mesh.cells[std::size_t(width) * found.cell + mesh.element.facets()[found.ordinal][k]];
    features.facets.push_back(facet);
  }
  Ranks(mesh, features).find();
  return features;
}

} // namespace rpc::mesh
