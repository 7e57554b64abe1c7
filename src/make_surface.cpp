// SPDX-License-Identifier: BSD-3-Clause
#include "make_surface.hpp"

#include "rpc/contact/surface/height_grid.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/io/rough_surface.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace rpc
{
namespace
{

/// A list "surface" of the parameters, as deck lists are read.
Teuchos::ParameterList surface_list(const std::vector<std::string> &assignments)
{
  const Teuchos::ParameterList valid = io::valid_rough_surface_parameters();
  Teuchos::ParameterList list("Rough Surface");
  for (const std::string &assignment : assignments) assign(list, valid, assignment);
  validate(list, valid);
  return list;
}

} // namespace

std::string make_surface(const std::string &file, const std::vector<std::string> &assignments)
{
  namespace fs = std::filesystem;
  const io::RoughSurfaceOptions options = io::rough_surface_options(surface_list(assignments));
  const std::string ending = fs::path(file).extension().string();
  io::heights_as(ending, {0, 0}, 2, 1); // whether the format is known, before the work
  std::error_code error;
  RPC_REQUIRE(!fs::exists(fs::symlink_status(file, error)),
              "command line: --make-surface does not write over \"" << file << "\", which is there. Name another file");
  const double spacing = options.period / options.points;
  const std::vector<double> heights = io::rough_surface(options);
  std::ofstream out(file, std::ios::binary);
  out << io::heights_as(ending, heights, options.points, spacing);
  out.close();
  RPC_REQUIRE(out, "command line: --make-surface cannot write \""
                       << file << "\". Name a file in a folder that is there and has room");
  const contact::HeightTable table{
      options.points, options.is_profile ? 1 : options.points, heights, {spacing, spacing}};
  const contact::HeightGrid grid(table, contact::Interpolation::bicubic, true);
  const Interval range = grid.heights();
  std::ostringstream text;
  text << file << ": " << table.columns << (options.is_profile ? "" : " x " + std::to_string(table.rows))
       << " heights from " << range.low << " to " << range.high << ", rms height " << grid.rms_height()
       << ", rms slope of neighbours " << grid.rms_slope() << "\nobstacle: Type = height map, File = " << file
       << ", Spacing X = ";
  text.precision(17);
  text << spacing << ", Periodic = true\n";
  return text.str();
}

} // namespace rpc
