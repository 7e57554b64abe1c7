// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/surface/height_file.hpp"

#include "height_formats.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace rpc::contact
{
namespace
{

std::string ending_of(const std::string &name)
{
  std::string ending = std::filesystem::path(name).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// Turns a row or a column into a profile; refuses what is none.
void make_profile(HeightTable &table, const HeightFile &file)
{
  RPC_REQUIRE(table.rows == 1 || table.columns == 1,
              file.where << "must be a profile, one row or one column, for a body in the plane, got " << table.rows
                         << " rows of " << table.columns << ". Take a row of it, or a body in space");
  if (table.rows == 1) return;
  std::swap(table.columns, table.rows);
  if (table.spacing[1] > 0) table.spacing[0] = table.spacing[1];
  table.spacing[1] = 0;
}

} // namespace

void require_height_format(const std::string &name, const std::string &parameter)
{
  const std::string ending = ending_of(name);
  const std::string where =
      "deck: \"" + parameter + "\" must end in .npy, .csv, .txt, .asc or .nc, got \"" + name + "\". ";
  for (const char *const known : {".npy", ".csv", ".txt", ".asc", ".nc"})
    if (ending == known) return;
  const bool hdf5 = ending == ".h5" || ending == ".hdf5";
  if (hdf5)
    throw Error(ExitCode::bad_input, where +
                                         "Convert it: python3 -c \"import h5py, numpy; numpy.save('heights.npy', "
                                         "h5py.File('" +
                                         name + "')['NAME'][:])\"");
  if (ending == ".x3p")
    throw Error(ExitCode::bad_input, where +
                                         "Convert it: python3 -c \"import SurfaceTopography, numpy; numpy.save("
                                         "'heights.npy', SurfaceTopography.read_topography('" +
                                         name + "').heights().T)\", or export it by Gwyddion");
  throw Error(ExitCode::bad_input,
              where + "Write the heights by numpy.save(\"heights.npy\", heights), or export them by Gwyddion");
}

HeightTable read_heights(const std::string &name, const std::string &bytes, const int dim, const std::string &parameter)
{
  const HeightFile file{"deck: \"" + parameter + "\": \"" + name + "\" ", bytes, dim};
  const std::string ending = ending_of(name);
  HeightTable table = ending == ".npy"   ? read_npy(file)
                      : ending == ".asc" ? read_esri_grid(file)
                      : ending == ".nc"  ? read_netcdf(file)
                                         : read_csv(file);
  if (dim == 2) make_profile(table, file);
  const bool enough = table.columns >= 2 && (dim == 2 || table.rows >= 2);
  RPC_REQUIRE(enough, file.where << "must have " << (dim == 2 ? "two heights" : "two rows and two columns")
                                 << " at least, got " << table.rows << " rows of " << table.columns
                                 << (dim == 3 && table.columns > 1
                                         ? ". A profile goes with a body in the plane; repeat its row for "
                                           "one that is the same along Y"
                                         : ". Export more of the surface"));
  for (int j = 0; j < table.rows; ++j)
    for (int i = 0; i < table.columns; ++i)
      RPC_REQUIRE(std::isfinite(table.at(i, j)),
                  file.where << "must hold finite heights, got " << table.at(i, j) << " in row " << j + 1 << ", column "
                             << i + 1 << ". Fill in what was not measured, as Gwyddion's \"Interpolate Data Under "
                             << "Mask\" does, or cut it off");
  return table;
}

std::array<double, 2> even_spacing(const HeightFile &file, const std::string &axis, const std::vector<double> &places)
{
  if (places.size() < 2) return {0, 0};
  const double mean = (places.back() - places.front()) / static_cast<double>(places.size() - 1);
  constexpr double allowed = 1e-3; // of a step: files have few digits
  for (std::size_t k = 1; k < places.size(); ++k) {
    const double step = places[k] - places[k - 1];
    RPC_REQUIRE(std::isfinite(step) && mean != 0 && std::abs(step - mean) <= allowed * std::abs(mean),
                file.where << "must have evenly spaced places along " << axis << ", got a step of " << step << " from "
                           << places[k - 1] << " to " << places[k] << " where the mean is " << mean
                           << ". Put the heights onto a regular grid first, as scipy.interpolate.griddata does");
  }
  return {std::abs(mean), mean < 0 ? -1. : 1.};
}

} // namespace rpc::contact
