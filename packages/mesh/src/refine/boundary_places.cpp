// SPDX-License-Identifier: BSD-3-Clause
#include "boundary_places.hpp"

#include "../gmsh_nearest.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
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
        const int m = middles.of(part.cell[f])[e];
        if (m >= 0) pairs.emplace_back(m, static_cast<int>(p));
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
       << x[2] << "), on which no new node is found near its edge or face. " << remedy_for_curved_boundaries;
  return text.str();
}

/// A middle that is to move, with the shapes of its facets.
struct Move {
  std::size_t kind = 0; // of middles
  int middle = 0;
  std::vector<BoundaryShape> shapes;
  std::optional<Point> to;
};

bool any_of_kind(const std::vector<BoundaryShape> &shapes, const BoundaryShape::Kind kind)
{
  return std::any_of(shapes.begin(), shapes.end(), [&](const BoundaryShape &shape) { return shape.kind == kind; });
}

/// The rank's own middles at facets of which some are curved.
std::vector<Move> moves_of(const LocalMesh &mesh, const std::vector<Middles> &middles)
{
  std::vector<Move> moves;
  for (std::size_t k = 0; k < middles.size(); ++k) {
    const std::vector<OnPart> pairs = on_parts(mesh, middles[k]);
    for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
      Move move{k, pairs[begin].first, {}, std::nullopt};
      for (; end < pairs.size() && pairs[end].first == move.middle; ++end)
        move.shapes.push_back(mesh.geometry[pairs[end].second].shape);
      const bool flat = std::all_of(move.shapes.begin(), move.shapes.end(),
                                    [](const BoundaryShape &shape) { return shape.kind == BoundaryShape::Kind::flat; });
      const bool in_place = !middles[k].in_place.empty() && middles[k].in_place[move.middle];
      if (!flat && !in_place && middles[k].owner_vertex(move.middle) < mesh.num_owned_nodes())
        moves.push_back(std::move(move));
    }
  }
  return moves;
}

/// Has gmsh tell the places on shapes without closed formulas; rank 0 asks for all. Collective.
void ask_gmsh(const Comm &comm, const std::string &file, const std::vector<std::vector<double>> &coords, const int dim,
              std::vector<Move> &moves)
{
  std::vector<double> rows; // two tags, three coordinates
  std::vector<GO> wanted;
  std::vector<Move *> asking;
  for (Move &move : moves) {
    if (!any_of_kind(move.shapes, BoundaryShape::Kind::other)) continue;
    const Point x = point_of(&coords[move.kind][std::size_t(dim) * move.middle], dim);
    const int second = move.shapes.size() > 1 ? move.shapes[1].tag : 0;
    rows.insert(rows.end(), {double(move.shapes[0].tag), double(second), x[0], x[1], x[2]});
    asking.push_back(&move);
  }
  const GO mine = static_cast<GO>(asking.size()), before = sum_before(comm, mine);
  if (sum_all(comm, mine) == 0) return;
  for (GO k = 0; k < 3 * mine; ++k) wanted.push_back(3 * before + k);
  const std::vector<double> all = gathered_by_root(comm, rows);
  std::vector<double> places;
  on_root(comm, ExitCode::bad_mesh, [&] {
    std::vector<int> tags;
    std::vector<double> near;
    for (std::size_t k = 0; k < all.size(); k += 5) {
      tags.insert(tags.end(), {static_cast<int>(all[k]), static_cast<int>(all[k + 1])});
      near.insert(near.end(), &all[k + 2], &all[k + 2] + 3);
    }
    places = nearest_of_geo(file, tags, near);
  });
  const std::vector<double> got = scattered_from_root(comm, places, wanted);
  for (std::size_t k = 0; k < asking.size(); ++k)
    if (std::isfinite(got[3 * k] + got[3 * k + 1] + got[3 * k + 2]))
      asking[k]->to = Point{got[3 * k], got[3 * k + 1], got[3 * k + 2]};
}

} // namespace

void move_to_boundary(const LocalMesh &mesh, const std::vector<Middles> &middles, const std::string &file,
                      std::vector<std::vector<double>> &coords, std::vector<std::vector<char>> &moved)
{
  const int dim = mesh.dim();
  const Comm &comm = *mesh.owned_nodes->getComm();
  for (std::size_t k = 0; k < middles.size(); ++k) moved[k].assign(middles[k].size(), 0);
  std::vector<Move> moves = moves_of(mesh, middles);
  ask_gmsh(comm, file, coords, dim, moves);
  std::optional<std::string> bad;
  for (Move &move : moves) {
    double *const place = &coords[move.kind][std::size_t(dim) * move.middle];
    const Point x = point_of(place, dim);
    if (!any_of_kind(move.shapes, BoundaryShape::Kind::other)) move.to = nearest_point(move.shapes, x);
    if (!move.to || length(difference(*move.to, x)) > extent(mesh, middles[move.kind], move.middle) / 2) {
      bad = complaint(x);
      continue;
    }
    std::copy_n(move.to->begin(), dim, place);
    moved[move.kind][move.middle] = 1;
  }
  throw_if_any(comm, ExitCode::bad_mesh, bad);
}

} // namespace rpc::mesh
