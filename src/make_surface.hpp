// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace rpc
{

/// What --make-surface does: writes the heights of a synthetic rough surface into a file, and never over one that is there.
/// @param assignments  of --set, see io::valid_rough_surface_parameters()
/// @return what the console gets: the file, and the obstacle that has it
/// @throws rpc::Error (bad_input) on a parameter that is unknown or out of range, and where nothing can be written
std::string make_surface(const std::string &file, const std::vector<std::string> &assignments);

} // namespace rpc
