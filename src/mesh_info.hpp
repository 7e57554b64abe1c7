// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace rpc
{

/// What --mesh-info prints of a geometry or mesh: blocks, sides, surfaces, sizes and quality of cells, and what was mended. One rank only.
/// @throws rpc::Error (bad_input, bad_mesh) as the file's reader does
std::string mesh_info(const std::string &file);

} // namespace rpc
