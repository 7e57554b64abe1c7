// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/height_map.hpp"

#include "rpc/contact/rounding.hpp"
#include "rpc/contact/surface/height_file.hpp"
#include "rpc/contact/surface/parameters.hpp"
#include "rpc/core/error.hpp"

#include <Teuchos_Array.hpp>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace rpc::contact
{
namespace
{

/// A factor or a spacing. @param rule  what it must be
double checked_number(const Teuchos::ParameterList &list, const std::string &name, const std::string &path,
                      const bool may_be_zero, const std::string &rule)
{
  const double value = list.get<double>(name);
  RPC_REQUIRE(std::isfinite(value) && (value > 0 || (may_be_zero && value == 0)),
              "deck: \"" << path << "->" << name << "\" must be " << rule << ", got " << value);
  return value;
}

/// The direction of a grid's rows before it is turned: the global x, made perpendicular to the normal, or the global y where the normal
/// is along x.
Point unturned_x(const Point &normal, const int dim)
{
  const bool along_x = std::abs(normal[0]) > 1 - Rounding::place;
  const Point axis = along_x ? Point{0, 1, 0} : Point{1, 0, 0};
  if (dim == 2 && along_x) return axis;
  const Point across = difference(axis, scaled(inner(axis, normal), normal));
  return scaled(1 / length(across), across);
}

} // namespace

std::optional<Point> HeightMap::direction_into(const Point &x) const
{
  const Point at = in_grid(x);
  const HeightGrid::Nearest nearest = grid->nearest(at);
  Point direction = scaled(-1, nearest.normal);
  // At its edge the nearest point need not be a foot: the way to it counts, for what is above the surface or below it.
  if (nearest.at_edge && grid->covers(at[0], at[1])) {
    const Point way = difference(nearest.point, at);
    const double size = length(way);
    if (std::abs(way[2]) > Rounding::place * length(at)) direction = scaled((way[2] < 0 ? 1 : -1) / size, way);
  }
  Point global{};
  for (int c = 0; c < 3; ++c)
    global[c] = direction[0] * along_x[c] + direction[1] * along_y[c] + direction[2] * normal[c];
  return global;
}

bool HeightMap::lies_in(const Point &x) const
{
  const Point at = in_grid(x);
  return grid->covers(at[0], at[1]) && at[2] - grid->at(at[0], at[1]).height < -Rounding::place * length(at);
}

std::optional<double> HeightMap::distance_along(const Point &x, const Point &direction) const
{
  return grid->crossing(in_grid(x), in_grid(direction));
}

double HeightMap::clearance(const Bounds &places) const
{
  Box box{in_grid(places.lower), in_grid(places.lower)};
  for (int corner = 1; corner < 8; ++corner) {
    Point x{};
    for (int c = 0; c < 3; ++c) x[c] = (corner >> c & 1) == 0 ? places.lower[c] : places.upper[c];
    const Point at = in_grid(x);
    for (int c = 0; c < 3; ++c) {
      box.low[c] = std::min(box.low[c], at[c]);
      box.high[c] = std::max(box.high[c], at[c]);
    }
  }
  return grid->clearance(box);
}

std::string HeightMap::told(const std::string &unit) const
{
  std::ostringstream text;
  const auto size = grid->extent();
  const auto &spacing = grid->spacing();
  text << what << ", ";
  if (grid->is_profile()) {
    text << size[0] << " " << unit << " long, spacing " << spacing[0];
  } else {
    text << size[0] << " x " << size[1] << " " << unit << ", spacing " << spacing[0];
    if (spacing[0] != spacing[1]) text << " x " << spacing[1];
  }
  const Interval heights = grid->heights();
  text << " " << unit << "; heights from " << heights.low << " to " << heights.high << " " << unit << ", rms height "
       << grid->rms_height() << " " << unit << ", rms slope " << grid->rms_slope();
  return text.str();
}

SurfaceDetail HeightMap::detail() const
{
  const auto &spacing = grid->spacing();
  return {std::min(spacing[0], spacing[1]), [map = *this](const Bounds &places) { return map.clearance(places); },
          [map = *this](const std::string &unit) { return map.told(unit); }};
}

SurfaceKind HeightMap::kind()
{
  return {
      {"height map"},
      point,
      "where the first height of its file stands",
      {{"Normal", Teuchos::Array<double>(), "the direction in which heights count, towards the body, of any length"},
       {"File", std::string(),
        "its heights: a .npy, .csv, .txt, .asc (ESRI) or .nc (NetCDF) file, with rows along Y and columns along X; "
        "in the plane a profile, one row or column"},
       {"Spacing X", 0., "the distance of neighbouring heights along X, > 0 [m]; 0: the file says it"},
       {"Spacing Y", 0., "the same along Y [m]; 0: the file says it, or the same as along X"},
       {"Scale", 1., "what turns the file's heights and spacings into the deck's unit of length, > 0, such as 1e-6"},
       {"Angle", 0., "by how much X and Y are turned about the normal [degrees], anticlockwise as seen from the body"},
       {"Interpolation", std::vector<std::string>{"bicubic", "bilinear"},
        "what is between the heights: `bicubic`, splines with continuous slopes, or `bilinear`"},
       {"Periodic", false, "whether the map goes on for ever, again and again; else it ends with its last heights"}},
      ""};
}

HeightMap HeightMap::read(const Teuchos::ParameterList &list, const int dim, const std::string &path,
                          const FileReader &read_file)
{
  HeightMap map;
  map.normal = unit_vector(list, "Normal", dim, path);
  const double given_x = checked_number(list, "Spacing X", path, true, "> 0 and finite [m], or 0 for that of the file");
  const double given_y = checked_number(list, "Spacing Y", path, true, "> 0 and finite [m], or 0 for that of the file");
  const double scale = checked_number(list, "Scale", path, false, "> 0 and finite");
  const double angle = list.get<double>("Angle");
  RPC_REQUIRE(
      std::isfinite(angle) && (dim == 3 || angle == 0),
      "deck: \"" << path
                 << "->Angle\" must be finite [degrees], and 0 in the plane, where \"Normal\" turns a profile; got "
                 << angle);
  const auto &file = list.get<std::string>("File");
  RPC_REQUIRE(!file.empty(), "deck: \"" << path << "->File\" must name a file of heights, such as a .npy, got none");
  const std::string parameter = path + "->File";
  require_height_format(file, parameter);
  HeightTable table = read_heights(file, read_file(file, parameter), dim, parameter);
  for (double &height : table.height) height *= scale;
  const std::array<double, 2> given{given_x, given_y};
  for (int c = 0; c < 2; ++c) table.spacing[c] = given[c] > 0 ? given[c] : scale * table.spacing[c];
  if (!(table.spacing[1] > 0)) table.spacing[1] = table.spacing[0];
  RPC_REQUIRE(table.spacing[0] > 0, "deck: \"" << path << "->Spacing X\" must be > 0 [m], for \"" << file
                                               << "\" does not say how far its heights are apart. Add it");
  const bool cubic = list.get<std::string>("Interpolation") == "bicubic", periodic = list.get<bool>("Periodic");
  map.grid = std::make_shared<HeightGrid>(table, cubic ? Interpolation::bicubic : Interpolation::bilinear, periodic);
  if (dim == 2) {
    map.along_x = unturned_x(map.normal, dim);
  } else {
    const double turn = angle * 3.14159265358979323846 / 180;
    const Point x = unturned_x(map.normal, dim), y = cross(map.normal, x);
    for (int c = 0; c < 3; ++c) {
      map.along_x[c] = std::cos(turn) * x[c] + std::sin(turn) * y[c];
      map.along_y[c] = std::cos(turn) * y[c] - std::sin(turn) * x[c];
    }
  }
  std::ostringstream what;
  if (dim == 2)
    what << "profile \"" << file << "\" of " << table.columns << " heights, " << (cubic ? "cubic" : "linear");
  else
    what << "height map \"" << file << "\" of " << table.columns << " x " << table.rows << " heights, "
         << (cubic ? "bicubic" : "bilinear");
  if (periodic) what << ", periodic";
  map.what = what.str();
  return map;
}

} // namespace rpc::contact
