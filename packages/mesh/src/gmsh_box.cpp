// SPDX-License-Identifier: BSD-3-Clause
#include "gmsh_box.hpp"

#include <gmsh.h>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace rpc::mesh
{
namespace
{

/// A name of a group, and the entity that is the group.
using NamedEntities = std::vector<std::pair<std::string, int>>;

void add_groups(const int dim, const NamedEntities &groups)
{
  for (const auto &[name, entity] : groups)
    gmsh::model::setPhysicalName(dim, gmsh::model::addPhysicalGroup(dim, {entity}), name);
}

void add_plane_box(const GmshRequest &request)
{
  namespace geo = gmsh::model::geo;
  const double left = request.lower[0], bottom = request.lower[1], right = request.upper[0], top = request.upper[1];
  geo::addPoint(left, bottom, 0, 0, 1);
  geo::addPoint(right, bottom, 0, 0, 2);
  geo::addPoint(right, top, 0, 0, 3);
  geo::addPoint(left, top, 0, 0, 4);
  for (int line = 1; line <= 4; ++line) geo::addLine(line, line % 4 + 1, line);
  geo::addCurveLoop({1, 2, 3, 4}, 1);
  geo::addPlaneSurface({1}, 1);
  geo::synchronize();
  add_groups(1, {{"left", 4}, {"right", 2}, {"bottom", 1}, {"top", 3}});
  add_groups(0, {{"left bottom", 1}, {"right bottom", 2}, {"left top", 4}, {"right top", 3}});
  add_groups(2, {{"body", 1}});
}

/// Points are 1 + x + 2 y + 4 z, where x, y, z are 1 at the upper corner and 0 at the lower one.
void add_box_in_space(const GmshRequest &request)
{
  namespace geo = gmsh::model::geo;
  const char *const names[3][2] = {{"left", "right"}, {"bottom", "top"}, {"back", "front"}};
  NamedEntities corners, sides;
  std::map<std::pair<int, int>, int> lines; // by their ends
  for (int corner = 0; corner < 8; ++corner) {
    double x[3];
    std::string name;
    for (int d = 0; d < 3; ++d) {
      const int upper = (corner >> d) % 2;
      x[d] = upper ? request.upper[d] : request.lower[d];
      name += (d > 0 ? " " : "") + std::string(names[d][upper]);
    }
    geo::addPoint(x[0], x[1], x[2], 0, 1 + corner);
    corners.emplace_back(name, 1 + corner);
  }
  for (int corner = 0; corner < 8; ++corner)
    for (int d = 0; d < 3; ++d)
      if ((corner >> d) % 2 == 0) {
        const int from = 1 + corner, to = from + (1 << d);
        lines[{from, to}] = geo::addLine(from, to);
        lines[{to, from}] = -lines[{from, to}];
      }
  std::vector<int> surfaces;
  for (int d = 0; d < 3; ++d)
    for (const int upper : {0, 1}) {
      const int e = 1 << ((d + 1) % 3), f = 1 << ((d + 2) % 3), first = 1 + (upper << d);
      const int around[4] = {first, first + e, first + e + f, first + f};
      std::vector<int> loop;
      for (int k = 0; k < 4; ++k) loop.push_back(lines.at({around[k], around[(k + 1) % 4]}));
      surfaces.push_back(geo::addPlaneSurface({geo::addCurveLoop(loop)}));
      sides.emplace_back(names[d][upper], surfaces.back());
    }
  const int volume = geo::addVolume({geo::addSurfaceLoop(surfaces)});
  geo::synchronize();
  add_groups(2, sides);
  add_groups(0, corners);
  add_groups(3, {{"body", volume}});
}

} // namespace

void add_box(const GmshRequest &request)
{
  gmsh::model::add("box");
  if (request.box_dim == 2)
    add_plane_box(request);
  else
    add_box_in_space(request);
}

} // namespace rpc::mesh
