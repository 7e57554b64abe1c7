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

/// Dimension of the body in the file: 3 if it names a physical volume. Looks no further: read_msh() tells what is wrong with a
/// body that has no name.
/// @throws rpc::Error (bad_mesh) if the file's form is wrong so far
int dimension_of_msh(const std::string &where, const std::string &text);

} // namespace rpc::mesh
