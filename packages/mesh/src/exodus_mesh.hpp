// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"

#include <string>

namespace rpc::mesh
{

/// The mesh of an Exodus file: blocks, side sets, and node sets as groups of points. Times and fields do not count.
/// @param where  beginning of messages
/// @throws rpc::Error (bad_mesh) if it is no such file, or damaged
GmshContents read_exodus_mesh(const std::string &where, const std::string &path);

} // namespace rpc::mesh
