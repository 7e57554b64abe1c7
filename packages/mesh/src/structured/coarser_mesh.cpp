// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/structured.hpp"

#include "../mesh_checks.hpp"
#include "layers.hpp"
#include "parity_sets.hpp"
#include "rpc/mesh/shape_functions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace rpc::mesh
{
namespace
{

/// How a cell lies in the coarser one.
struct Place {
  std::array<int, 3> direction{};      ///< (local directions) the coarser cell's local direction
  std::array<bool, 3> along{};         ///< (local directions) whether it runs in the same sense
  std::array<double, 3> low{}, high{}; ///< (coarser directions) where it begins and ends, 0 to 1

  /// A point of the cell's, 0 to 1, in coarser coordinates.
  std::array<double, 3> outward(const std::array<double, 3> &x, const int dim) const
  {
    std::array<double, 3> X{};
    for (int d = 0; d < dim; ++d) {
      const int D = direction[d];
      const double part = along[d] ? x[d] : 1 - x[d];
      X[D] = part < 1 ? low[D] + part * (high[D] - low[D]) : high[D]; // ends without rounding
    }
    return X;
  }
};

/// Joins the cells of a mesh by its layers.
class Joined
{
public:
  Joined(const MeshData &fine, const Entities &facets, const Sheets &sheets, const Layers &layers)
      : fine_(fine), facets_(facets), sheets_(sheets), layers_(layers), dim_(fine.element.dim),
        width_(fine.element.num_nodes()), facet_place_(facet_places(fine.element))
  {
  }
  /// None where nodes or cells do not fit, or a cell is inverted.
  std::optional<CoarserMesh> made()
  {
    number_cells();
    if (!take_vertices()) return std::nullopt;
    if (fine_.element.order == 2) add_middle_nodes();
    take_sides();
    take_points();
    std::vector<int> all(result_.mesh.num_cells());
    std::iota(all.begin(), all.end(), 0);
    if (!inverted_cells(result_.mesh.element, result_.mesh.coords, result_.mesh.cells, all).empty())
      return std::nullopt;
    return std::move(result_);
  }

private:
  int group_at(const int cell, const int d) const { return layers_.group[sheets_.at(cell, d)]; }
  const int *nodes_of(const int cell) const { return &fine_.cells[std::size_t(width_) * cell]; }
  bool runs_along_stack(const int cell, const int d) const
  {
    return (sheets_.sign_at(cell, d) > 0) == (layers_.sign[sheets_.at(cell, d)] > 0);
  }

  void number_cells()
  {
    ParitySets joined(fine_.num_cells());
    for (int f = 0; f < facets_.size(); ++f) {
      if (facets_.num_cells_at(f) != 2) continue;
      const int a = facets_.cell(f, 0), b = facets_.cell(f, 1);
      const int s = sheets_.at(a, facet_place_[facets_.ordinal(f, 0)].direction),
                t = sheets_.at(b, facet_place_[facets_.ordinal(f, 1)].direction);
      if (s != t && layers_.group[s] == layers_.group[t]) joined.join(a, b, false);
    }
    std::vector<int> number(fine_.num_cells(), -1);
    for (int c = 0; c < fine_.num_cells(); ++c) {
      int &of_root = number[joined.find(c).root];
      if (of_root < 0) {
        of_root = static_cast<int>(first_.size());
        first_.push_back(c);
        result_.mesh.block.push_back(fine_.block[c]);
      }
      result_.parent.push_back(of_root);
    }
    result_.mesh.element = fine_.element;
    result_.mesh.blocks = fine_.blocks;
  }

  /// The coarser cell's directions are those of its first one.
  std::optional<Place> place_of(const int cell) const
  {
    Place place;
    const int first = first_[result_.parent[cell]];
    for (int d = 0; d < dim_; ++d) {
      int D = 0, found = 0;
      for (int k = 0; k < dim_; ++k)
        if (group_at(first, k) == group_at(cell, d)) {
          D = k;
          ++found;
        }
      if (found != 1) return std::nullopt;
      const int sheet = sheets_.at(cell, d);
      const bool forward = runs_along_stack(first, D);
      place.direction[d] = D;
      place.along[d] = runs_along_stack(cell, d) == forward;
      place.low[D] = forward ? layers_.begin[sheet] : 1 - layers_.end[sheet];
      place.high[D] = forward ? layers_.end[sheet] : 1 - layers_.begin[sheet];
    }
    return place;
  }

  int kind_of(const Place &place)
  {
    std::vector<std::array<double, 3>> at;
    for (int v = 0; v < fine_.element.num_vertices(); ++v) {
      std::array<double, 3> X = place.outward(reference(v), dim_);
      for (int d = 0; d < dim_; ++d) X[d] = 2 * X[d] - 1;
      at.push_back(X);
    }
    const auto [entry, is_new] = kinds_.emplace(at, static_cast<int>(result_.vertices.size()));
    if (is_new) result_.vertices.push_back(at);
    return entry->second;
  }
  /// Of a node, 0 to 1.
  std::array<double, 3> reference(const int node) const
  {
    std::array<double, 3> x{};
    for (int d = 0; d < dim_; ++d) x[d] = double(fine_.element.lattice()[node][d]) / fine_.element.order;
    return x;
  }

  bool take_vertices()
  {
    const int vertices = fine_.element.num_vertices();
    std::vector<int> corner(std::size_t(vertices) * first_.size(), -1); // nodes of the fine mesh
    std::vector<signed char> inside(fine_.num_nodes(), -1);             // directions in which a vertex is not kept
    for (int c = 0; c < fine_.num_cells(); ++c) {
      const auto place = place_of(c);
      if (!place) return false;
      result_.kind.push_back(kind_of(*place));
      for (int v = 0; v < vertices; ++v) {
        const auto X = place->outward(reference(v), dim_);
        signed char directions = 0;
        for (int d = 0; d < dim_; ++d) directions += X[d] > 0 && X[d] < 1;
        signed char &known = inside[nodes_of(c)[v]];
        if (known >= 0 && known != directions) return false;
        known = directions;
        if (directions > 0) continue;
        int &node = corner[std::size_t(vertices) * result_.parent[c] + vertex_at(X)];
        if (node >= 0) return false;
        node = nodes_of(c)[v];
      }
    }
    number_.assign(fine_.num_nodes(), -1);
    for (int n = 0; n < fine_.num_nodes(); ++n) {
      if (inside[n] != 0) continue;
      number_[n] = result_.mesh.num_nodes();
      result_.mesh.coords.insert(result_.mesh.coords.end(), &fine_.coords[std::size_t(dim_) * n],
                                 &fine_.coords[std::size_t(dim_) * n] + dim_);
    }
    result_.mesh.cells.assign(std::size_t(width_) * first_.size(), -1);
    for (std::size_t k = 0; k < corner.size(); ++k) {
      if (corner[k] < 0) return false;
      result_.mesh.cells[width_ * (k / vertices) + k % vertices] = number_[corner[k]];
    }
    return true;
  }
  int vertex_at(const std::array<double, 3> &X) const
  {
    for (int v = 0; v < fine_.element.num_vertices(); ++v)
      if (reference(v) == X) return v;
    return 0;
  }

  /// Nodes in the middle of edges, faces and cells of order 2, where the finer mesh has the point of these coordinates.
  void add_middle_nodes()
  {
    const Element &element = fine_.element, linear{dim_, 1, Shape::tensor};
    MeshData &mesh = result_.mesh;
    std::vector<int> corners;
    const int vertices = element.num_vertices(), num_cells = static_cast<int>(first_.size());
    for (int c = 0; c < num_cells; ++c)
      corners.insert(corners.end(), &mesh.cells[std::size_t(width_) * c],
                     &mesh.cells[std::size_t(width_) * c] + vertices);
    int next = mesh.num_nodes();
    const auto add = [&](const Entities &entities, const Element::Table &table) {
      for (int c = 0; c < num_cells; ++c)
        for (int e = 0; e < entities.per_cell; ++e)
          mesh.cells[std::size_t(width_) * c + table[e].back()] =
              next + entities.of_cell[std::size_t(entities.per_cell) * c + e];
      next += entities.size();
    };
    add(edges_of(linear, corners), element.edges());
    if (dim_ == 3) add(facets_of(linear, corners), element.facets());
    for (int c = 0; c < num_cells; ++c) {
      const auto first = mesh.cells.begin() + std::ptrdiff_t(width_) * c;
      *std::find(first, first + width_, -1) = next++;
    }
    mesh.coords.resize(std::size_t(dim_) * next);
    std::vector<char> placed(next, 0);
    with_static_extents(element, [&](const auto dim, const auto nodes) {
      const ShapeFunctions<dim, nodes> shape;
      for (int c = 0; c < fine_.num_cells(); ++c) {
        const Place place = *place_of(c);
        for (int a = vertices; a < width_; ++a) {
          const int node = mesh.cells[std::size_t(width_) * result_.parent[c] + a];
          double x[dim], N[nodes], dN[nodes][dim];
          if (placed[node] || !inward(place, reference(a), x)) continue;
          placed[node] = 1;
          shape.evaluate(x, N, dN);
          for (int b = 0; b < nodes; ++b) {
            if (std::abs(N[b] - 1) < 1e-12) number_[nodes_of(c)[b]] = node;
            for (int d = 0; d < dim; ++d)
              mesh.coords[std::size_t(dim) * node + d] += N[b] * fine_.coords[std::size_t(dim) * nodes_of(c)[b] + d];
          }
        }
      }
    });
  }
  /// The reference coordinates of a cell where the coarser one has those of a point. @return whether it lies in the cell
  template <int Dim>
  static bool inward(const Place &place, const std::array<double, 3> &X, double (&x)[Dim])
  {
    for (int d = 0; d < Dim; ++d) {
      const int D = place.direction[d];
      if (X[D] < place.low[D] || X[D] > place.high[D]) return false;
      const double part = (X[D] - place.low[D]) / (place.high[D] - place.low[D]);
      x[d] = place.along[d] ? 2 * part - 1 : 1 - 2 * part;
    }
    return true;
  }

  void take_sides()
  {
    std::vector<int> taken(first_.size() * facet_place_.size(), -1); // by which side
    for (std::size_t s = 0; s < fine_.sides.size(); ++s) {
      const SideData &side = fine_.sides[s];
      SideData mine{side.name, {}, {}};
      for (std::size_t f = 0; f < side.cell.size(); ++f) {
        const Place place = *place_of(side.cell[f]);
        const auto [d, upper] = facet_place_[side.ordinal[f]];
        const FacetPlace at{place.direction[d], upper == place.along[d]};
        const auto ordinal = std::find_if(facet_place_.begin(), facet_place_.end(),
                                          [&](const FacetPlace &other) {
                                            return other.direction == at.direction && other.upper == at.upper;
                                          }) -
                             facet_place_.begin();
        const int cell = result_.parent[side.cell[f]];
        if (std::exchange(taken[facet_place_.size() * cell + ordinal], static_cast<int>(s)) == static_cast<int>(s))
          continue;
        mine.cell.push_back(cell);
        mine.ordinal.push_back(static_cast<int>(ordinal));
      }
      result_.mesh.sides.push_back(std::move(mine));
    }
  }
  void take_points()
  {
    for (PointData set : fine_.points) {
      for (int &node : set.node) node = number_[node];
      std::sort(set.node.begin(), set.node.end());
      result_.mesh.points.push_back(std::move(set));
    }
  }

  const MeshData &fine_;
  const Entities &facets_;
  const Sheets &sheets_;
  const Layers &layers_;
  const int dim_, width_;
  std::vector<FacetPlace> facet_place_;
  CoarserMesh result_;
  std::vector<int> first_;  // (coarser cells) the first of the finer ones
  std::vector<int> number_; // (finer nodes) the coarser mesh's; -1: it has none there
  std::map<std::vector<std::array<double, 3>>, int> kinds_;
};

/// Nodes block by block, where cells of a block lie in the same stacks.
std::vector<int> order_along_layers(const MeshData &mesh, const Sheets &sheets, const Layers &layers)
{
  const int dim = mesh.element.dim, width = mesh.element.num_nodes(), order = mesh.element.order;
  std::map<std::array<int, 3>, int> blocks;
  using Key = std::array<int, 4>; // block, places along its stacks, the slowest first
  std::vector<Key> key(mesh.num_nodes(), Key{std::numeric_limits<int>::max(), 0, 0, 0});
  for (int c = 0; c < mesh.num_cells(); ++c) {
    std::array<std::array<int, 3>, 3> stacks; // length, stack, direction
    stacks.fill({1, 0, 0});                   // behind all others
    std::array<int, 3> named{};
    for (int d = 0; d < dim; ++d) {
      const int stack = layers.stack[sheets.at(c, d)];
      stacks[d] = {-layers.length[stack], stack, d};
    }
    std::sort(stacks.begin(), stacks.end());
    for (int k = 0; k < dim; ++k) named[k] = stacks[k][1];
    const int block = blocks.emplace(named, static_cast<int>(blocks.size())).first->second;
    for (int a = 0; a < width; ++a) {
      Key here{block, 0, 0, 0};
      for (int k = 0; k < dim; ++k) {
        const int d = stacks[k][2], sheet = sheets.at(c, d), place = mesh.element.lattice()[a][d];
        const bool along = (sheets.sign_at(c, d) > 0) == (layers.sign[sheet] > 0);
        here[1 + k] = order * layers.number[sheet] + (along ? place : order - place);
      }
      Key &known = key[mesh.cells[std::size_t(width) * c + a]];
      known = std::min(known, here);
    }
  }
  std::vector<int> nodes(mesh.num_nodes());
  std::iota(nodes.begin(), nodes.end(), 0);
  std::stable_sort(nodes.begin(), nodes.end(), [&](const int a, const int b) { return key[a] < key[b]; });
  return nodes;
}

} // namespace

LayeredMesh layered(const MeshData &mesh)
{
  LayeredMesh result;
  if (mesh.element.shape != Shape::tensor) return result;
  const auto sheets = sheets_of(mesh);
  if (!sheets) return result;
  const Entities facets = facets_of(mesh.element, mesh.cells);
  const Layers layers = layers_of(mesh, facets, *sheets);
  if (!layers.coarser) return result;
  result.coarser = Joined(mesh, facets, *sheets, layers).made();
  if (result.coarser) result.order = order_along_layers(mesh, *sheets, layers);
  return result;
}

} // namespace rpc::mesh
