// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace rpc::mesh
{

/// How a file of a body is read, which the ending of its name tells, in upper or lower case.
enum class MeshFormat {
  geo,     ///< gmsh's own geometry, which gmsh meshes
  shapes,  ///< STEP, IGES, BREP, STL: geometry alone, which gmsh meshes
  msh,     ///< gmsh's mesh, which rpc reads
  exodus,  ///< a mesh that the Exodus library reads
  by_gmsh, ///< a mesh that gmsh reads
  meshio,  ///< a mesh that meshio converts
  unknown
};

MeshFormat format_of(const std::string &file);

/// Whether gmsh meshes it, with cells of any size.
inline bool is_geometry(const MeshFormat format)
{
  return format == MeshFormat::geo || format == MeshFormat::shapes;
}

/// Whether gmsh can mesh its body again and tell points of its surfaces: of an STL it makes one mesh.
bool keeps_geometry(const std::string &file);

/// ".step", in lower case.
std::string extension_of(const std::string &file);

/// The endings of names that are known, ".geo" first.
std::vector<std::string> known_endings();

} // namespace rpc::mesh
