// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"

namespace rpc::mesh
{

/// Reads a mesh in gmsh's format, 2.2 or 4.1, ASCII or binary: what is in the file, checked for its form only.
///
/// gmsh itself is not asked: it crashes on damaged files, and of a 2.2 it takes all elements with one elementary number to
/// be in all of their physical groups, though converters put 0 or 1 there throughout.
/// @param where  beginning of messages
/// @param text   of the file
/// @throws rpc::Error (bad_mesh)
GmshContents read_msh(const std::string &where, const std::string &text);

/// Dimension of the body in the file: 3 if there are volumes, in groups or not, with names or without.
/// @throws rpc::Error (bad_mesh) if the file's form is wrong so far, or if there are only surfaces in space
int dimension_of_msh(const std::string &where, const std::string &text);

} // namespace rpc::mesh
