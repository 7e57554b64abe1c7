// SPDX-License-Identifier: BSD-3-Clause
#include "features.hpp"

#include "../sorted_lists.hpp"
#include "rpc/mesh/topology.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace rpc::mesh
{
namespace
{

constexpr double cos_of_edge = 0.766; // of 40 degrees

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

/// (facets) The sides that each belongs to.
std::vector<std::vector<int>> sides_at(const MeshData &mesh, const Entities &facets)
{
  std::vector<std::vector<int>> sides(facets.size());
  for (std::size_t s = 0; s < mesh.sides.size(); ++s)
    for (std::size_t f = 0; f < mesh.sides[s].cell.size(); ++f)
      sides[facets.of_cell[std::size_t(facets.per_cell) * mesh.sides[s].cell[f] + mesh.sides[s].ordinal[f]]].push_back(
          static_cast<int>(s));
  return sides;
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
           cosine(facet_normal(mesh_, a.vertex), facet_normal(mesh_, b.vertex)) > cos_of_edge;
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
    return !(cosine(before, after) > cos_of_edge);
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
  const Entities facets = facets_of(mesh.element, mesh.cells);
  const auto sides = sides_at(mesh, facets);
  const int width = mesh.element.num_nodes();
  Features features;
  using Kind = std::pair<std::vector<int>, std::pair<int, int>>; // sides, blocks
  std::map<Kind, int> labels;
  for (int f = 0; f < facets.size(); ++f) {
    const int cell = facets.cell(f, 0), block = mesh.block[cell];
    const int beyond = facets.num_cells_at(f) == 1 ? -1 : mesh.block[facets.cell(f, 1)];
    if (beyond == block) continue;
    const auto [label, is_new] = labels.emplace(Kind{sides[f], {block, beyond}}, static_cast<int>(labels.size()));
    if (is_new) features.sides.push_back(sides[f]);
    FeatureFacet facet{{-1, -1, -1}, label->second};
    for (int k = 0; k < mesh.element.dim; ++k)
      facet.vertex[k] = mesh.cells[std::size_t(width) * cell + mesh.element.facets()[facets.ordinal(f, 0)][k]];
    features.facets.push_back(facet);
  }
  Ranks(mesh, features).find();
  return features;
}

} // namespace rpc::mesh
