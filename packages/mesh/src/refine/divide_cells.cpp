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
  int per_cell = 0;
  std::vector<int> lid; // (cells, per_cell) -1: not here

  const int *of(const int cell) const { return &lid[std::size_t(per_cell) * cell]; }
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

/// Fills cells, blocks, ids and parents of the children.
Family add_children(const LocalMesh &whole, LocalMesh &fine)
{
  const Children &children = children_of(whole.element);
  const int num_owned = whole.num_owned_nodes();
  Family family;
  family.per_cell = children.per_cell;
  family.lid.assign(std::size_t(children.per_cell) * whole.num_cells(), -1);
  for (int c = 0; c < whole.num_cells(); ++c) {
    const int *const nodes = whole.nodes_of(c);
    const bool owned = c < whole.num_owned_cells();
    const int diagonal = shortest_diagonal(whole, children, nodes);
    for (int k = 0; k < children.per_cell; ++k) {
      const int kind = children.kind(k, diagonal);
      const auto &vertices = children.vertices[kind];
      if (!owned && std::none_of(vertices.begin(), vertices.end(), [&](const int v) { return nodes[v] < num_owned; }))
        continue;
      family.lid[std::size_t(children.per_cell) * c + k] = fine.num_cells();
      for (const int v : vertices) fine.cells.push_back(nodes[v]);
      fine.block.push_back(whole.block[c]);
      fine.parent.push_back(c);
      fine.kind.push_back(kind);
      if (owned) fine.cell_id.push_back(children.per_cell * whole.cell_id[c] + k);
    }
  }
  return family;
}

/// The parts of facets, those of them that a rank is to have: of its own cells, or at a node that it owns.
template <class Facets>
void add_parts(const LocalMesh &fine, const Family &family, const Facets &whole, Facets &parts)
{
  const Children &children = children_of(fine.element);
  for (std::size_t f = 0; f < whole.cell.size(); ++f)
    for (int k = 0; k < family.per_cell; ++k) {
      const int cell = family.of(whole.cell[f])[k];
      if (cell < 0) continue;
      const auto &facets = children.facets[fine.kind[cell]];
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

/// Leaves the nodes that cells have; all owned ones have cells.
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

} // namespace

LocalMesh divided(const LocalMesh &whole)
{
  LocalMesh fine;
  fine.element = {whole.dim(), 1, whole.element.shape};
  fine.owned_nodes = whole.owned_nodes;
  const Family family = add_children(whole, fine);
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
  return fine;
}

} // namespace rpc::mesh
