// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/surface/height_grid.hpp"

#include <string>

namespace rpc::contact
{

/// Refuses files whose names end in no known format, with the way to convert them.
/// @param parameter  the path in the deck, for messages   @throws rpc::Error (bad_input)
void require_height_format(const std::string &name, const std::string &parameter);

/// The heights of a file, by the ending of its name: .npy (NumPy), .csv and .txt (a matrix, or columns x, y, z with such a heading), .asc (ESRI's
/// grid), .nc (NetCDF's classic format). All numbers are finite; in space there are two rows and two columns at least, in the plane two
/// columns and one row.
/// @param bytes  what the file holds
/// @param dim    2: a profile
/// @throws rpc::Error (bad_input) naming the place in the file, the rule and the remedy
HeightTable read_heights(const std::string &name, const std::string &bytes, int dim, const std::string &parameter);

} // namespace rpc::contact
