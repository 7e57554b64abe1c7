// SPDX-License-Identifier: BSD-3-Clause
#include "side_places.hpp"

#include "mesh_checks.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/mesh/topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

namespace rpc::mesh
{
namespace
{

using Place3 = std::array<double, 3>;

constexpr double on_place =
    1e-6; // of the body: facets as near to a plane or box are on it; coordinates in files have six digits or more

std::string path_of(const SidePlace &place)
{
  return "deck: \"Mesh->Sides->" + place.name + "\"";
}

Place3 coords_of(const MeshData &mesh, const int node)
{
  Place3 x{};
  std::copy_n(&mesh.coords[static_cast<std::size_t>(mesh.element.dim) * node], mesh.element.dim, x.begin());
  return x;
}

struct Extent {
  Place3 lower{}, upper{};
  double diagonal = 0;
};

Extent extent_of(const MeshData &mesh)
{
  Extent box{coords_of(mesh, 0), coords_of(mesh, 0)};
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    const Place3 x = coords_of(mesh, n);
    for (int d = 0; d < 3; ++d) {
      box.lower[d] = std::min(box.lower[d], x[d]);
      box.upper[d] = std::max(box.upper[d], x[d]);
    }
  }
  for (int d = 0; d < 3; ++d) box.diagonal = std::hypot(box.diagonal, box.upper[d] - box.lower[d]);
  return box;
}

std::string text_of(const Extent &box, const int dim)
{
  std::ostringstream text;
  for (int d = 0; d < dim; ++d)
    text << (d > 0 ? ", " : "") << "xyz"[d] << " from " << box.lower[d] << " to " << box.upper[d];
  return text.str();
}

/// All facets of the boundary whose nodes are all in some place.
SideData facets_within(const MeshData &mesh, const std::string &name, const std::function<bool(const Place3 &)> &in)
{
  const Entities facets = facets_of(mesh.element, mesh.cells);
  std::vector<char> inside(mesh.num_nodes(), 0);
  for (int n = 0; n < mesh.num_nodes(); ++n) inside[n] = in(coords_of(mesh, n)) ? 1 : 0;
  SideData side{name, {}, {}};
  for (int f = 0; f < facets.size(); ++f) {
    if (facets.num_cells_at(f) != 1) continue;
    const std::vector<int> nodes = nodes_of_facet(mesh, facets.cell(f, 0), facets.ordinal(f, 0));
    if (!std::all_of(nodes.begin(), nodes.end(), [&](const int n) { return inside[n] != 0; })) continue;
    side.cell.push_back(facets.cell(f, 0));
    side.ordinal.push_back(facets.ordinal(f, 0));
  }
  return side;
}

SideData on_plane(const SidePlace &place, const MeshData &mesh, const Extent &box)
{
  const int along = place.plane->axis;
  RPC_REQUIRE(along < mesh.element.dim, path_of(place) << ": a body in the plane has no z");
  const double at = place.plane->at, tolerance = on_place * box.diagonal;
  SideData side =
      facets_within(mesh, place.name, [&](const Place3 &x) { return std::abs(x[along] - at) <= tolerance; });
  RPC_REQUIRE(!side.cell.empty(), path_of(place) << ": no facet of the boundary lies in the plane "
                                                 << "xyz"[along] << " = " << at << "; the body reaches "
                                                 << text_of(box, mesh.element.dim));
  return side;
}

/// A box's corners, the lower one first: "{0, 0, 1, 1} (in YAML [0, 0, 1, 1])".
std::string ordered(const std::vector<double> &box)
{
  const std::size_t dim = box.size() / 2;
  std::ostringstream text;
  for (std::size_t k = 0; k < box.size(); ++k) {
    const double a = box[k % dim], b = box[dim + k % dim];
    text << (k > 0 ? ", " : "") << (k < dim ? std::min(a, b) : std::max(a, b));
  }
  return "{" + text.str() + "} (in YAML [" + text.str() + "])";
}

SideData in_box(const SidePlace &place, const MeshData &mesh, const Extent &box)
{
  const std::size_t dim = mesh.element.dim;
  RPC_REQUIRE(place.box.size() == 2 * dim, path_of(place) << ": \"Box\" must have " << 2 * dim
                                                          << " numbers, the lower corner and the upper one, got "
                                                          << place.box.size());
  for (std::size_t d = 0; d < dim; ++d)
    RPC_REQUIRE(place.box[d] <= place.box[dim + d],
                path_of(place) << ": \"Box\" must have the lower corner before the upper one, got "
                               << "xyz"[d] << " from " << place.box[d] << " to " << place.box[dim + d] << ". Write "
                               << ordered(place.box));
  const double tolerance = on_place * box.diagonal;
  SideData side = facets_within(mesh, place.name, [&](const Place3 &x) {
    for (std::size_t d = 0; d < dim; ++d)
      if (x[d] < place.box[d] - tolerance || x[d] > place.box[dim + d] + tolerance) return false;
    return true;
  });
  RPC_REQUIRE(!side.cell.empty(), path_of(place) << ": no facet of the boundary lies within the box; the body reaches "
                                                 << text_of(box, mesh.element.dim));
  return side;
}

double inner(const Place3 &a, const Place3 &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Place3 difference(const Place3 &a, const Place3 &b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double distance_to_segment(const Place3 &x, const Place3 &a, const Place3 &b)
{
  const Place3 along = difference(b, a), from = difference(x, a);
  const double length = inner(along, along), t = length > 0 ? std::clamp(inner(from, along) / length, 0., 1.) : 0;
  const Place3 off{from[0] - t * along[0], from[1] - t * along[1], from[2] - t * along[2]};
  return std::sqrt(inner(off, off));
}

double distance_to_triangle(const Place3 &x, const Place3 &a, const Place3 &b, const Place3 &c)
{
  const Place3 u = difference(b, a), v = difference(c, a), w = difference(x, a);
  const double uu = inner(u, u), uv = inner(u, v), vv = inner(v, v), wu = inner(w, u), wv = inner(w, v);
  const double area = uu * vv - uv * uv;
  if (area > 0) {
    const double s = (vv * wu - uv * wv) / area, t = (uu * wv - uv * wu) / area;
    if (s >= 0 && t >= 0 && s + t <= 1) {
      const Place3 off{w[0] - s * u[0] - t * v[0], w[1] - s * u[1] - t * v[1], w[2] - s * u[2] - t * v[2]};
      return std::sqrt(inner(off, off));
    }
  }
  return std::min({distance_to_segment(x, a, b), distance_to_segment(x, b, c), distance_to_segment(x, c, a)});
}

double distance_to_facet(const MeshData &mesh, const int cell, const int ordinal, const Place3 &x)
{
  const std::vector<int> nodes = nodes_of_facet(mesh, cell, ordinal);
  const auto corner = [&](const int v) { return coords_of(mesh, nodes[v]); };
  if (mesh.element.dim == 2) return distance_to_segment(x, corner(0), corner(1));
  double least = std::numeric_limits<double>::infinity();
  for (int v = 1; v + 1 < mesh.element.facet().num_vertices(); ++v)
    least = std::min(least, distance_to_triangle(x, corner(0), corner(v), corner(v + 1)));
  return least;
}

const char *surfaces_of(const MeshData &mesh)
{
  return mesh.element.dim == 2 ? "curves" : "surfaces";
}

void require_geometry(const SidePlace &place, const char *const parameter, const MeshData &mesh)
{
  RPC_REQUIRE(!mesh.geometry.empty(), path_of(place) << ": \"" << parameter << "\" goes with a geometry, whose "
                                                     << surfaces_of(mesh)
                                                     << " have numbers; of a mesh write \"Plane\" or \"Box\"");
}

SideData on_surfaces(const SidePlace &place, const MeshData &mesh)
{
  require_geometry(place, "Surfaces", mesh);
  SideData side{place.name, {}, {}};
  for (const int number : place.surfaces) {
    RPC_REQUIRE(std::count(place.surfaces.begin(), place.surfaces.end(), number) == 1,
                path_of(place) << ": \"Surfaces\" has " << number << " more than once; name each surface once");
    const auto part = std::find_if(mesh.geometry.begin(), mesh.geometry.end(),
                                   [&](const BoundaryPart &each) { return each.shape.tag == number; });
    std::vector<std::string> numbers;
    for (const BoundaryPart &each : mesh.geometry) numbers.push_back(std::to_string(each.shape.tag));
    RPC_REQUIRE(part != mesh.geometry.end(),
                path_of(place) << ": the boundary has no " << (mesh.element.dim == 2 ? "curve " : "surface ") << number
                               << "; it has " << join(numbers) << ". rpc --mesh-info tells where they are");
    side.cell.insert(side.cell.end(), part->cell.begin(), part->cell.end());
    side.ordinal.insert(side.ordinal.end(), part->ordinal.begin(), part->ordinal.end());
  }
  return side;
}

/// The surface that is nearest to a point.
SideData near_point(const SidePlace &place, const MeshData &mesh)
{
  require_geometry(place, "Near", mesh);
  RPC_REQUIRE(static_cast<int>(place.near.size()) == mesh.element.dim,
              path_of(place) << ": \"Near\" must have " << mesh.element.dim << " numbers, got " << place.near.size());
  Place3 x{};
  std::copy(place.near.begin(), place.near.end(), x.begin());
  const BoundaryPart *best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const BoundaryPart &part : mesh.geometry)
    for (std::size_t f = 0; f < part.cell.size(); ++f) {
      const double distance = distance_to_facet(mesh, part.cell[f], part.ordinal[f], x);
      if (distance >= least) continue;
      least = distance;
      best = &part;
    }
  RPC_REQUIRE(best, path_of(place) << ": \"Near\" must be finite");
  return {place.name, best->cell, best->ordinal};
}

} // namespace

void add_sides(const std::vector<SidePlace> &places, MeshData &mesh)
{
  if (places.empty()) return;
  const Extent box = extent_of(mesh);
  for (const SidePlace &place : places) {
    for (const SideData &side : mesh.sides)
      RPC_REQUIRE(side.name != place.name, path_of(place) << ": the file has a side of that name; choose another one");
    mesh.sides.push_back(place.plane               ? on_plane(place, mesh, box)
                         : !place.box.empty()      ? in_box(place, mesh, box)
                         : !place.surfaces.empty() ? on_surfaces(place, mesh)
                                                   : near_point(place, mesh));
  }
}

} // namespace rpc::mesh
