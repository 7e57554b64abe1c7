// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/contracted.hpp"

#include "../sorted_lists.hpp"
#include "features.hpp"
#include "kept_vertices.hpp"
#include "rpc/mesh/rules.hpp"
#include "rpc/mesh/topology.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace rpc::mesh
{
namespace
{

double cubed(const double x)
{
  return x * x * x;
}

/// The mesh while edges are contracted.
template <int dim>
class Contraction
{
public:
  Contraction(const MeshData &mesh, const Features &features)
      : mesh_(mesh), features_(features), facets_(features.facets), next_edge_(features.next_edge),
        cells_at_(mesh.num_nodes()), facets_at_(mesh.num_nodes()), seen_by_(mesh.num_nodes(), -1),
        worst_3_(mesh.num_nodes(), 1)
  {
    cells_.reserve(mesh.num_cells());
    for (int c = 0; c < mesh.num_cells(); ++c) {
      std::array<int, dim + 1> cell;
      for (int k = 0; k <= dim; ++k) cells_at_[cell[k] = mesh.cells[std::size_t(dim + 1) * c + k]].push_back(c);
      cells_.push_back(cell);
    }
    for (const auto &cell : cells_) {
      const double quality = quality_3(cell);
      for (const int v : cell) worst_3_[v] = std::min(worst_3_[v], quality);
    }
    for (std::size_t f = 0; f < facets_.size(); ++f)
      for (int k = 0; k < dim; ++k) facets_at_[facets_[f].vertex[k]].push_back(static_cast<int>(f));
  }

  MeshData made(const std::vector<char> &kept)
  {
    contract_all_but(kept);
    return result();
  }

private:
  void contract_all_but(const std::vector<char> &kept)
  {
    std::vector<int> left;
    for (const auto rank : {Features::Rank::edge, Features::Rank::face, Features::Rank::inside})
      for (int v = 0; v < mesh_.num_nodes(); ++v)
        if (!kept[v] && features_.rank[v] == rank) left.push_back(v);
    while (!left.empty()) {
      std::vector<int> stay;
      for (const int v : left)
        if (!contract(v, kept)) stay.push_back(v);
      if (stay.size() == left.size()) break;
      left = std::move(stay);
    }
  }

  MeshData result() const
  {
    MeshData coarse;
    coarse.element = mesh_.element;
    coarse.blocks = mesh_.blocks;
    std::vector<int> number(mesh_.num_nodes(), -1);
    for (int v = 0; v < mesh_.num_nodes(); ++v) {
      if (cells_at_[v].empty()) continue;
      number[v] = coarse.num_nodes();
      coarse.coords.insert(coarse.coords.end(), &mesh_.coords[std::size_t(dim) * v],
                           &mesh_.coords[std::size_t(dim) * v] + dim);
    }
    std::vector<int> cell_number(cells_.size(), -1);
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (cells_[c][0] < 0) continue;
      cell_number[c] = coarse.num_cells();
      for (int k = 0; k <= dim; ++k) coarse.cells.push_back(number[cells_[c][k]]);
      coarse.block.push_back(mesh_.block[c]);
    }
    for (const SideData &side : mesh_.sides) coarse.sides.push_back({side.name, {}, {}});
    const Element::Table &ordinals = mesh_.element.facets();
    for (const FeatureFacet &facet : facets_) {
      if (facet.label < 0 || features_.sides[facet.label].empty()) continue;
      int first = -1; // of the cells that have the facet
      for (const int c : cells_at_[facet.vertex[0]])
        if ((first < 0 || c < first) && std::all_of(facet.vertex.begin(), facet.vertex.begin() + dim,
                                                    [&](const int v) { return has(cells_[c].data(), dim + 1, v); }))
          first = c;
      const auto ordinal = std::find_if(ordinals.begin(), ordinals.end(), [&](const std::vector<int> &local) {
        return std::all_of(local.begin(), local.begin() + dim,
                           [&](const int k) { return has(facet.vertex.data(), dim, cells_[first][k]); });
      });
      for (const int side : features_.sides[facet.label]) {
        coarse.sides[side].cell.push_back(cell_number[first]);
        coarse.sides[side].ordinal.push_back(static_cast<int>(ordinal - ordinals.begin()));
      }
    }
    for (PointData set : mesh_.points) {
      for (int &node : set.node) node = number[node];
      coarse.points.push_back(std::move(set));
    }
    return coarse;
  }

  static bool has(const std::vector<int> &list, const int v)
  {
    return std::find(list.begin(), list.end(), v) != list.end();
  }
  static bool has(const int *const vertices, const int count, const int v)
  {
    return std::find(vertices, vertices + count, v) != vertices + count;
  }
  const double *x(const int v) const { return &mesh_.coords[std::size_t(dim) * v]; }

  /// The cube of 1 for an equilateral cell, 0 for a flat one, negative for an inverted one.
  double quality_3(const std::array<int, dim + 1> &cell) const
  {
    double edge[3][3], sum = 0;
    for (int k = 0; k < dim; ++k)
      for (int d = 0; d < dim; ++d) edge[k][d] = x(cell[k + 1])[d] - x(cell[0])[d];
    for (int k = 0; k < dim; ++k)
      for (int d = 0; d < dim; ++d) {
        sum += edge[k][d] * edge[k][d];
        for (int l = 0; l < k; ++l) sum += (edge[k][d] - edge[l][d]) * (edge[k][d] - edge[l][d]);
      }
    if (dim == 2) {
      const double q = 2 * 1.7320508075688772 * (edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0]) / sum;
      return q * q * q;
    }
    double six_volumes = 0;
    for (int d = 0; d < 3; ++d) {
      const int e = (d + 1) % 3, f = (d + 2) % 3;
      six_volumes += edge[0][d] * (edge[1][e] * edge[2][f] - edge[1][f] * edge[2][e]);
    }
    return 432 * six_volumes * std::abs(six_volumes) / (sum * sum * sum); // (12 (3 V)^(2/3) / sum)^3
  }

  /// Neighbours onto which a vertex may move as far as the boundary is concerned.
  const std::vector<int> &neighbours_of(const int v)
  {
    if (features_.rank[v] == Features::Rank::edge && dim == 3) return next_edge_[v];
    around_.clear();
    const auto add = [&](const int *const vertices, const int count) {
      for (int k = 0; k < count; ++k)
        if (std::exchange(seen_by_[vertices[k]], v) != v) around_.push_back(vertices[k]);
    };
    seen_by_[v] = v;
    if (features_.rank[v] == Features::Rank::inside)
      for (const int c : cells_at_[v]) add(cells_[c].data(), dim + 1);
    else
      for (const int f : facets_at_[v]) add(facets_[f].vertex.data(), dim);
    seen_by_[v] = -1;
    for (const int w : around_) seen_by_[w] = -1;
    return around_;
  }

  /// The least quality of the cells that the contraction of v onto w would leave around v; none where it is worse than `best`.
  std::optional<double> quality_after(const int v, const int w, double best) const
  {
    double least = 1;
    for (const int c : cells_at_[v]) {
      std::array<int, dim + 1> cell = cells_[c];
      if (has(cell.data(), dim + 1, w)) continue;
      *std::find(cell.begin(), cell.end(), v) = w;
      least = std::min(least, quality_3(cell));
      if (!(least > best)) return std::nullopt;
    }
    return least;
  }

  /// Whether the boundary stays one: its facets turn by little, and none falls onto another one.
  bool keeps_boundary(const int v, const int w) const
  {
    if (features_.rank[v] == Features::Rank::inside) return true;
    std::vector<int> around_v, around_w;
    int shared = 0;
    const auto add = [&](std::vector<int> &around, const int f) {
      for (int k = 0; k < dim; ++k) {
        const int other = facets_[f].vertex[k];
        if (other != v && other != w) around.push_back(other);
      }
    };
    for (const int f : facets_at_[v]) {
      add(around_v, f);
      std::array<int, 3> vertex = facets_[f].vertex;
      if (has(vertex.data(), dim, w)) {
        ++shared;
        continue;
      }
      const auto before = facet_normal(mesh_, vertex);
      *std::find(vertex.begin(), vertex.end(), v) = w;
      const auto after = facet_normal(mesh_, vertex);
      double ab = 0, aa = 0, bb = 0;
      for (int d = 0; d < 3; ++d) {
        ab += before[d] * after[d];
        aa += before[d] * before[d];
        bb += after[d] * after[d];
      }
      if (!(ab > 0 && ab * ab > contraction_rules.least_cosine * contraction_rules.least_cosine * aa * bb))
        return false;
    }
    for (const int f : facets_at_[w]) add(around_w, f);
    std::sort(around_v.begin(), around_v.end());
    around_v.erase(std::unique(around_v.begin(), around_v.end()), around_v.end());
    int common = 0;
    for (const int other : around_v) common += has(around_w, other) ? 1 : 0;
    if (dim == 2) return shared == 1 && common == 0;
    if (common != shared) return false;
    if (features_.rank[v] != Features::Rank::edge) return true;
    for (const int other : next_edge_[v]) // an edge around a hole keeps three parts
      if (other != w && has(next_edge_[w], other)) return false;
    return true;
  }

  bool contract(const int v, const std::vector<char> &kept)
  {
    const std::vector<int> &neighbours = neighbours_of(v);
    int onto = -1;
    const double enough =
        std::min(cubed(contraction_rules.least_quality), cubed(contraction_rules.part_kept) * worst_3_[v]);
    for (const bool to_kept : {true, false}) {
      double best = enough;
      for (const int w : neighbours) {
        if ((kept[w] != 0) != to_kept || !keeps_boundary(v, w)) continue;
        const auto quality = quality_after(v, w, best);
        if (!quality) continue;
        best = *quality;
        onto = w;
      }
      if (onto >= 0) break;
    }
    if (onto < 0) return false;
    move(v, onto);
    return true;
  }

  void move(const int v, const int w)
  {
    for (const int c : cells_at_[v]) {
      std::array<int, dim + 1> &cell = cells_[c];
      if (has(cell.data(), dim + 1, w)) {
        for (int k = 0; k <= dim; ++k)
          if (cell[k] != v) erase(cells_at_[cell[k]], c);
        cell[0] = -1;
      } else {
        *std::find(cell.begin(), cell.end(), v) = w;
        cells_at_[w].push_back(c);
      }
    }
    cells_at_[v] = {};
    for (const int f : facets_at_[v]) {
      FeatureFacet &facet = facets_[f];
      if (has(facet.vertex.data(), dim, w)) {
        for (int k = 0; k < dim; ++k)
          if (facet.vertex[k] != v) erase(facets_at_[facet.vertex[k]], f);
        facet.label = -1;
      } else {
        *std::find(facet.vertex.begin(), facet.vertex.end(), v) = w;
        facets_at_[w].push_back(f);
      }
    }
    facets_at_[v] = {};
    for (const int other : next_edge_[v]) {
      auto &back = next_edge_[other];
      if (other == w) {
        erase(back, v);
      } else {
        *std::find(back.begin(), back.end(), v) = w;
        next_edge_[w].push_back(other);
      }
    }
    next_edge_[v] = {};
  }
  static void erase(std::vector<int> &list, const int value)
  {
    *std::find(list.begin(), list.end(), value) = list.back();
    list.pop_back();
  }

  const MeshData &mesh_;
  const Features &features_;
  std::vector<std::array<int, dim + 1>> cells_;                    // vertices; the first is -1 once it is gone
  std::vector<FeatureFacet> facets_;                               // the label is -1 once it is gone
  std::vector<std::vector<int>> next_edge_, cells_at_, facets_at_; // (vertices)
  std::vector<int> around_, seen_by_;                              // of neighbours_of()
  std::vector<double> worst_3_; // (vertices) quality of the worst cell around at first
};

/// The vertices and straight cells of a mesh of order 2; of order 1 itself.
MeshData of_order_one(const MeshData &mesh)
{
  if (mesh.element.order == 1) return mesh;
  const int width = mesh.element.num_nodes(), dim = mesh.element.dim, vertices = mesh.element.num_vertices();
  MeshData linear;
  linear.element = mesh.element;
  linear.element.order = 1;
  linear.blocks = mesh.blocks;
  linear.block = mesh.block;
  linear.sides = mesh.sides;
  std::vector<int> number(mesh.num_nodes(), -1);
  for (int c = 0; c < mesh.num_cells(); ++c)
    for (int k = 0; k < vertices; ++k) number[mesh.cells[std::size_t(width) * c + k]] = 0;
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    if (number[n] < 0) continue;
    number[n] = linear.num_nodes();
    linear.coords.insert(linear.coords.end(), &mesh.coords[std::size_t(dim) * n],
                         &mesh.coords[std::size_t(dim) * n] + dim);
  }
  for (int c = 0; c < mesh.num_cells(); ++c)
    for (int k = 0; k < vertices; ++k) linear.cells.push_back(number[mesh.cells[std::size_t(width) * c + k]]);
  for (const PointData &set : mesh.points) {
    linear.points.push_back({set.name, {}});
    for (const int node : set.node)
      if (number[node] >= 0) linear.points.back().node.push_back(number[node]);
  }
  return linear;
}

} // namespace

std::optional<MeshData> contracted(const MeshData &mesh)
{
  if (mesh.element.shape != Shape::simplex) return std::nullopt;
  const MeshData linear = of_order_one(mesh);
  for (std::size_t s = 0; s < mesh.points.size(); ++s)
    if (linear.points[s].node.size() < mesh.points[s].node.size()) return std::nullopt; // a middle node has a name
  const Features features = features_of(linear);
  const std::vector<char> kept = kept_vertices(linear, features);
  MeshData coarse = linear.element.dim == 2 ? Contraction<2>(linear, features).made(kept)
                                            : Contraction<3>(linear, features).made(kept);
  if (coarse.num_nodes() > coarsening_rules.most_kept * linear.num_nodes()) return std::nullopt;
  return coarse;
}

} // namespace rpc::mesh
