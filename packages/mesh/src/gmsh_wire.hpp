#pragma once

#include "gmsh_contents.hpp"

#include <string>

namespace rpc::mesh
{

/// The contents as bytes for a pipe between two programs of one machine, and back.
std::string packed(const GmshContents &contents);

/// @throws std::runtime_error if the bytes are not whole
GmshContents unpacked(const std::string &bytes);

} // namespace rpc::mesh
