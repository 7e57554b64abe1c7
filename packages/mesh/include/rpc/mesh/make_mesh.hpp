#pragma once

#include "rpc/mesh/box.hpp"
#include "rpc/mesh/gmsh.hpp"

#include <optional>
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

/// A mesh of the same body and elements with cells about `factor` times as long: a box has that many cells fewer in each
/// direction, at least one, a .geo is meshed with that many times its size factor. A .msh cannot be coarsened: none.
///
/// It may have too few cells for the ranks, which make_mesh() tells.
/// @throws rpc::Error (bad_input) unless factor >= 1 and finite
std::optional<MeshOptions> coarser(const MeshOptions &options, double factor);

/// This rank's part of the mesh; collective.
/// @throws rpc::Error on every rank, as make_box() and read_gmsh() do
Mesh make_mesh(const MeshOptions &options, const RCP<const Comm> &comm);

} // namespace rpc::mesh
