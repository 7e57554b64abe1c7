// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace rpc
{

/// What --mesh-info prints of a geometry or mesh: blocks, sides, surfaces, sizes and quality of cells, and what was mended. Draws it, too, in a
/// file <name>.mesh.png. One rank only.
/// @param folder  of the picture, made if it is missing
/// @throws rpc::Error (bad_input, bad_mesh) as the file's reader does; as io::write_text() does
std::string mesh_info(const std::string &file, const std::string &folder);

} // namespace rpc
