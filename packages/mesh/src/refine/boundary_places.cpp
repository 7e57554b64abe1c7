#include "boundary_places.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/point.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

namespace rpc::mesh
{
namespace
{

/// A middle of one kind, and a part of the geometry that a facet there lies on.
using OnPart = std::pair<int, int>;

/// The middles of the edges, in space of the faces too, of facets with a shape. Sorted, each pair once.
std::vector<OnPart> on_parts(const LocalMesh &mesh, const Middles &middles)
{
  const Element &element = mesh.element;
  const Element whole{mesh.dim(), 2, element.shape};
  std::vector<OnPart> pairs;
  for (std::size_t p = 0; p < mesh.geometry.size(); ++p) {
    const BoundaryPart &part = mesh.geometry[p];
    for (std::size_t f = 0; f < part.cell.size(); ++f) {
      const auto &facet = whole.facets()[part.ordinal[f]];
      for (int e = 0; e < middles.per_cell; ++e) {
        if (std::find(facet.begin(), facet.end(), middles.slot[e]) == facet.end()) continue;
        pairs.emplace_back(middles.of_cell[std::size_t(middles.per_cell) * part.cell[f] + e], static_cast<int>(p));
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

Point point_of(const double *const x, const int dim)
{
  return {x[0], x[1], dim == 3 ? x[2] : 0};
}

/// The longest distance of a middle's vertices from each other [m].
double extent(const LocalMesh &mesh, const Middles &middles, const int m)
{
  const int dim = mesh.dim();
  double longest = 0;
  for (int v = 1; v < middles.width; ++v)
    longest =
        std::max(longest, length(difference(point_of(&mesh.coords[std::size_t(dim) * middles.vertices_of(m)[v]], dim),
                                            point_of(&mesh.coords[std::size_t(dim) * middles.owner_vertex(m)], dim))));
  return longest;
}

std::string complaint(const Point &x)
{
  std::ostringstream text;
  text << "mesh: refinement: the cells are too large for the curved boundary at (" << x[0] << ", " << x[1] << ", "
       << x[2] << "), on which no new node is found near its edge or face. Use a smaller \"Mesh->Size Factor\" and "
       << "fewer \"Mesh->Refinements\".";
  return text.str();
}

} // namespace

void move_to_boundary(const LocalMesh &mesh, const std::vector<Middles> &middles, const std::string &,
                      std::vector<std::vector<double>> &coords, std::vector<std::vector<char>> &moved)
{
  const int dim = mesh.dim();
  std::optional<std::string> bad;
  for (std::size_t k = 0; k < middles.size(); ++k) {
    moved[k].assign(middles[k].size(), 0);
    const std::vector<OnPart> pairs = on_parts(mesh, middles[k]);
    for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
      const int m = pairs[begin].first;
      std::vector<BoundaryShape> shapes;
      bool curved = false;
      for (; end < pairs.size() && pairs[end].first == m; ++end) {
        shapes.push_back(mesh.geometry[pairs[end].second].shape);
        curved = curved || shapes.back().kind != BoundaryShape::Kind::flat;
      }
      if (!curved || middles[k].owner_vertex(m) >= mesh.num_owned_nodes()) continue;
      double *const to = &coords[k][std::size_t(dim) * m];
      const Point x = point_of(to, dim);
      const auto nearest = nearest_point(shapes, x);
      if (!nearest || length(difference(*nearest, x)) > extent(mesh, middles[k], m) / 2) {
        bad = complaint(x);
        continue;
      }
      std::copy_n(nearest->begin(), dim, to);
      moved[k][m] = 1;
    }
  }
  throw_if_any(*mesh.owned_nodes->getComm(), ExitCode::bad_mesh, bad);
}

} // namespace rpc::mesh
