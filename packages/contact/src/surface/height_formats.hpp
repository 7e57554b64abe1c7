// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/height_grid.hpp"

#include <array>
#include <string>
#include <vector>

/// Each format of heights, read from a file's bytes: what read_heights() is made of.
namespace rpc::contact
{

struct HeightFile {
  std::string where; ///< how messages begin
  const std::string &bytes;
  int dim; ///< 2: a profile
};

HeightTable read_npy(const HeightFile &file);
HeightTable read_csv(const HeightFile &file);
HeightTable read_esri_grid(const HeightFile &file);
HeightTable read_netcdf(const HeightFile &file);

/// The mean step of places along an axis, and its sign; 0 of fewer than two. @throws rpc::Error (bad_input) unless steps are even
std::array<double, 2> even_spacing(const HeightFile &file, const std::string &axis, const std::vector<double> &places);

} // namespace rpc::contact
