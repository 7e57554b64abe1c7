#pragma once

#include "rpc/mesh/mesh_data.hpp"

#include <string>

namespace rpc::mesh
{

/// A mesh that gmsh makes or made.
struct GmshOptions {
  std::string file;       ///< .geo, meshed by gmsh, or .msh (2.2 or 4.1, ASCII or binary)
  double size_factor = 1; ///< of all cell sizes that a .geo asks for, > 0
  int order = 0;          ///< 1 or 2; 0: 2 for a .geo, for a .msh what it has
};

/// Reads a plane mesh of triangles or quadrilaterals, of order 1 or 2, curved where the file's geometry is. One rank only.
///
/// Physical surfaces become blocks and physical curves sides, by their names, in the order of their tags; cells outside
/// every physical surface are not part of the body. Nodes keep gmsh's order.
/// @throws rpc::Error (bad_mesh) with file, group, cell or node concerned: gmsh's own complaint or end; no physical surface, or a
///         group without a name; cells off the plane z = 0, of different or unsupported kinds, in two blocks, degenerate or
///         inverted; a side with facets that belong to no cell or to two; nodes that no cell uses, or two at one place.
///         (bad_input) if the file cannot be opened, a .msh comes with a size factor or another order, or a .geo with an
///         rpc that was built without gmsh: that only meshes, .msh files are read without it
MeshData read_gmsh(const GmshOptions &options);

} // namespace rpc::mesh
