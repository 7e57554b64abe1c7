// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/surface_mesh.hpp"

#include "rpc/contact/rounding.hpp"
#include "rpc/contact/surface/parameters.hpp"
#include "rpc/contact/surface/stl_file.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace rpc::contact
{

double SurfaceMesh::size() const
{
  const Bounds box = surface->bounds();
  return length(difference(box.upper, box.lower));
}

std::optional<Point> SurfaceMesh::direction_into(const Point &x) const
{
  const ClosedSurface::Foot foot = surface->nearest(x);
  if (smooth) return scaled(-1, foot.smooth);
  if (!(foot.distance > Rounding::place * size())) return scaled(-1, foot.normal);
  const Point off = difference(x, foot.place);
  return scaled((inner(off, foot.normal) < 0 ? 1 : -1) / foot.distance, off);
}

bool SurfaceMesh::lies_in(const Point &x) const
{
  const ClosedSurface::Foot foot = surface->nearest(x);
  return foot.distance > Rounding::place * size() && inner(difference(x, foot.place), foot.normal) < 0;
}

std::optional<double> SurfaceMesh::distance_along(const Point &x, const Point &direction) const
{
  const auto crossings = surface->crossings(x, direction);
  const bool is_behind = std::any_of(crossings.begin(), crossings.end(), [](const auto &each) { return each.g < 0; });
  const bool inside = (is_behind || encloses) && lies_in(x); // the way to a place inside a body has crossed its surface
  const double rounding = 2 * Rounding::place * size();
  std::optional<double> found;
  for (const auto &[g, descent] : crossings) {
    if (!(descent > 0)) continue; // the line leaves the foundation
    if (inside ? g <= 0 && (!found || g > *found) : g * descent >= -rounding && (!found || g < *found)) found = g;
  }
  return found;
}

SurfaceDetail SurfaceMesh::detail() const
{
  const auto clearance = [shape = *this](const Bounds &box) {
    Point middle{};
    for (int c = 0; c < 3; ++c) middle[c] = (box.lower[c] + box.upper[c]) / 2;
    const ClosedSurface::Foot foot = shape.surface->nearest(middle);
    if (inner(difference(middle, foot.place), foot.normal) < 0) return 0.;
    return std::max(0., foot.distance - length(difference(box.upper, middle)));
  };
  const auto told = [shape = *this](const std::string &unit) {
    std::ostringstream text;
    const Bounds box = shape.surface->bounds();
    text << "\"" << shape.file << "\", " << shape.surface->size() << " facets, edges " << shape.surface->mean_edge()
         << " " << unit << " in the mean; from (" << box.lower[0] << ", " << box.lower[1] << ", " << box.lower[2]
         << ") to (" << box.upper[0] << ", " << box.upper[1] << ", " << box.upper[2] << ") " << unit
         << " seen from its origin";
    return text.str();
  };
  return {surface->mean_edge(), clearance, told};
}

SurfaceKind SurfaceMesh::kind()
{
  return {
      {"surface mesh"},
      point,
      "where the origin of its file stands",
      {{"File", std::string(), "the closed surface of a tool: an STL file, text or binary, whose facets look outwards"},
       {"Scale", 1., "what turns the file's lengths into the deck's unit of length, > 0, such as 1e-3"},
       {"Axis", Teuchos::Array<double>(), "the direction of the file's x, of any length; by default x"},
       {"Second Axis", Teuchos::Array<double>(),
        "the direction of the file's y, at right angles to `Axis`, of any length; by default y"},
       {"Smooth Normals", false, "whether the obstacle's normal interpolates those at the corners of facets"},
       encloses_parameter()},
      "another type"};
}

SurfaceMesh SurfaceMesh::read(const Teuchos::ParameterList &list, const int dim, const std::string &path,
                              const FileReader &read_file)
{
  const auto &name = list.get<std::string>("File");
  RPC_REQUIRE(!name.empty(), "deck: \"" << path << "->File\" must name an STL file, got none. Add it");
  const double scale = positive_of(list, "Scale", path, "[-]");
  const auto axes = orthonormal_axes(list, dim, path);
  const std::string where = "deck: \"" + path + "->File\": \"" + name + "\" ";
  Triangles triangles = triangles_of_stl(read_file(name, path + "->File"), where);
  const std::string fault = fault_of(triangles); // in the file's coordinates
  RPC_REQUIRE(fault.empty(), "deck: \"" << path << "->File\": in \"" << name << "\" " << fault);
  for (Point &x : triangles.points) {
    Point turned{};
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) turned[c] += scale * x[k] * axes[k][c];
    x = turned;
  }
  const bool encloses = list.get<bool>("Encloses Body");
  if (encloses)
    for (auto &corners : triangles.corners) std::swap(corners[1], corners[2]);
  return {std::make_shared<const ClosedSurface>(std::move(triangles)), list.get<bool>("Smooth Normals"), encloses,
          name};
}

} // namespace rpc::contact
