#pragma once

#include "rpc/mesh/box.hpp"
#include "rpc/mesh/gmsh.hpp"

#include <string>
#include <variant>

namespace rpc::mesh
{

using MeshOptions = std::variant<BoxOptions, GmshOptions>;

/// Parameters of the deck's `Mesh` sublist.
Teuchos::ParameterList valid_parameters();

/// @param folder  of the deck: where "File" is looked for first
/// @throws rpc::Error (bad_input) on anything out of range, or given for another type of mesh
MeshOptions mesh_options(const Teuchos::ParameterList &list, const std::string &folder);

/// Space dimension, known before there is a mesh.
int dimension(const MeshOptions &options);

/// This rank's part of the mesh; collective.
/// @throws rpc::Error on every rank, as make_box() and read_gmsh() do
Mesh make_mesh(const MeshOptions &options, const RCP<const Comm> &comm);

} // namespace rpc::mesh
