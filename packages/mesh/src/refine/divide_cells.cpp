// SPDX-License-Identifier: BSD-3-Clause
#include "divide_cells.hpp"

#include "children.hpp"

#include <algorithm>
#include <array>

namespace rpc::mesh
{
namespace
{

/// The children that a rank has of each cell.
struct Family {
  const ChildKinds &kinds;
  Lists lid; ///< of each cell's children; -1: not here
};

/// The shortest diagonal of the octahedron inside a tetrahedron; of those that differ by rounding the first.
int shortest_diagonal(const LocalMesh &mesh, const Children &children, const int *const nodes)
{
  constexpr double rounding = 1e-10;
  int shortest = 0;
  double least = 0;
  for (std::size_t d = 0; d < children.diagonal.size(); ++d) {
    double squared = 0;
    for (int i = 0; i < 3; ++i) {
      const double along = mesh.coords[3 * std::size_t(nodes[children.diagonal[d][0]]) + i] -
                           mesh.coords[3 * std::size_t(nodes[children.diagonal[d][1]]) + i];
      squared += along * along;
    }
    if (d > 0 && !(squared < (1 - rounding) * least)) continue;
    least = squared;
    shortest = static_cast<int>(d);
  }
  return shortest;
}

/// Fills cells, blocks, parents and kinds of the children that a rank is to have; ids of those that it owns are left to be told.
/// @param kinds_of_cell  (cell) -> kinds of all its children
template <class KindsOfCell>
Lists add_children(const LocalMesh &whole, const ChildKinds &kinds, const KindsOfCell &kinds_of_cell, LocalMesh &fine)
{
  const int num_owned = whole.num_owned_nodes();
  Lists lids;
  lids.begin.reserve(whole.num_cells() + 1);
  for (int c = 0; c < whole.num_cells(); ++c) {
    const int *const nodes = whole.nodes_of(c);
    const bool owned = c < whole.num_owned_cells();
    for (const int kind : kinds_of_cell(c)) {
      const auto &vertices = kinds.vertices[kind];
      const bool here =
          owned || std::any_of(vertices.begin(), vertices.end(), [&](const int v) { return nodes[v] < num_owned; });
      lids.value.push_back(here ? fine.num_cells() : -1);
      if (!here) continue;
      for (const int v : vertices) fine.cells.push_back(nodes[v]);
      fine.block.push_back(whole.block[c]);
      fine.parent.push_back(c);
      fine.kind.push_back(kind);
      if (owned) fine.cell_id.push_back(-1);
    }
    lids.begin.push_back(lids.value.size());
  }
  return lids;
}

/// The parts of facets, those of them that a rank is to have: of its own cells, or at a node that it owns.
template <class Facets>
void add_parts(const LocalMesh &fine, const Family &family, const Facets &whole, Facets &parts)
{
  for (std::size_t f = 0; f < whole.cell.size(); ++f)
    for (const int *child = family.lid.first(whole.cell[f]); child != family.lid.last(whole.cell[f]); ++child) {
      const int cell = *child;
      if (cell < 0) continue;
      const auto &facets = family.kinds.facets[fine.kind[cell]];
      for (std::size_t o = 0; o < facets.size(); ++o) {
        if (facets[o] != whole.ordinal[f]) continue;
        const auto &local = fine.element.facets()[o];
        const bool here = cell < fine.num_owned_cells() || std::any_of(local.begin(), local.end(), [&](const int v) {
                            return fine.nodes_of(cell)[v] < fine.num_owned_nodes();
                          });
        if (!here) continue;
        parts.cell.push_back(cell);
        parts.ordinal.push_back(static_cast<int>(o));
      }
    }
}

/// Leaves the nodes that cells have, and owned ones.
void take_nodes(const LocalMesh &whole, LocalMesh &fine)
{
  const int dim = whole.dim();
  std::vector<int> lid(whole.num_nodes(), -1);
  for (const int node : fine.cells) lid[node] = 0;
  int next = 0;
  for (int n = 0; n < whole.num_nodes(); ++n) {
    if (lid[n] < 0 && n >= whole.num_owned_nodes()) continue;
    lid[n] = next++;
    fine.gid.push_back(whole.gid[n]);
    fine.id.push_back(whole.id[n]);
    fine.moved.push_back(whole.moved[n]);
    fine.coords.insert(fine.coords.end(), whole.coords.begin() + std::ptrdiff_t(dim) * n,
                       whole.coords.begin() + std::ptrdiff_t(dim) * (n + 1));
  }
  for (int &node : fine.cells) node = lid[node];
}

/// The mesh of the children, but for the ids of its cells.
template <class KindsOfCell>
LocalMesh divided_by(const LocalMesh &whole, const ChildKinds &kinds, const KindsOfCell &kinds_of_cell, Lists &children)
{
  LocalMesh fine;
  fine.element = {whole.dim(), 1, whole.element.shape};
  fine.owned_nodes = whole.owned_nodes;
  Family family{kinds, add_children(whole, kinds, kinds_of_cell, fine)};
  fine.child_vertices = kinds.places();
  for (const SideData &side : whole.sides) {
    fine.sides.push_back({side.name, {}, {}});
    add_parts(fine, family, side, fine.sides.back());
  }
  for (const BoundaryPart &part : whole.geometry) {
    fine.geometry.push_back({part.shape, {}, {}});
    add_parts(fine, family, part, fine.geometry.back());
  }
  take_nodes(whole, fine);
  fine.points = whole.points;
  children = std::move(family.lid);
  return fine;
}

} // namespace

LocalMesh divided(const LocalMesh &whole)
{
  const Children &ways = children_of(whole.element);
  std::vector<int> kinds(ways.per_cell);
  const auto kinds_of_cell = [&](const int c) -> const std::vector<int> & {
    const int diagonal = shortest_diagonal(whole, ways, whole.nodes_of(c));
    for (int k = 0; k < ways.per_cell; ++k) kinds[k] = ways.kind(k, diagonal);
    return kinds;
  };
  Lists children;
  LocalMesh fine = divided_by(whole, ways.kinds, kinds_of_cell, children);
  for (int c = 0; c < whole.num_owned_cells(); ++c)
    for (int k = 0; k < ways.per_cell; ++k) fine.cell_id[children.first(c)[k]] = ways.per_cell * whole.cell_id[c] + k;
  return fine;
}

LocalMesh divided(const LocalMesh &whole, const EdgeMarks &marks)
{
  Bisection bisection(whole.element);
  const Middles &edges = marks.edges;
  std::vector<int> order(edges.per_cell);
  const auto kinds_of_cell = [&](const int c) -> const std::vector<int> & {
    for (int e = 0; e < edges.per_cell; ++e) {
      const int edge = edges.of(c)[e];
      order[e] = edge < 0 ? -1 : marks.order[edge];
    }
    return bisection.children(order);
  };
  Lists children;
  LocalMesh fine = divided_by(whole, bisection.kinds(), kinds_of_cell, children);
  std::vector<int> count;
  for (int c = 0; c < whole.num_owned_cells(); ++c) count.push_back(children.size_of(c));
  const Comm &comm = *whole.owned_nodes->getComm();
  GO total = 0;
  const std::vector<GO> first =
      sums_before(comm, sum_all(comm, static_cast<GO>(count.size())), whole.cell_id, count, total);
  for (std::size_t c = 0; c < count.size(); ++c)
    for (int k = 0; k < count[c]; ++k) fine.cell_id[children.first(static_cast<int>(c))[k]] = first[c] + k;
  return without_unused_nodes(std::move(fine));
}

} // namespace rpc::mesh
