// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"

#include <string>

namespace rpc::mesh
{

/// A mesh of a format that the Python package meshio reads: it is called as a converter. Sets of cells become blocks, sets of facets and of
/// nodes sides or points.
/// @param where  beginning of messages
/// @throws rpc::Error (bad_input) if there is no python3 or no meshio, with the command that installs them; (bad_mesh) if meshio refuses
GmshContents read_by_meshio(const std::string &where, const std::string &path);

} // namespace rpc::mesh
