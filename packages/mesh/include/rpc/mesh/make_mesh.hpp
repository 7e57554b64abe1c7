// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/box.hpp"
#include "rpc/mesh/gmsh.hpp"

#include <memory>
#include <optional>
#include <string>
#include <variant>

namespace rpc::mesh
{

using MeshOptions = std::variant<BoxOptions, GmshOptions>;

/// Parameters of the deck's `Mesh` sublist.
Teuchos::ParameterList valid_parameters();

/// Collective on comm: "File" is looked for on rank 0's disk.
/// @param folder  of the deck: where "File" is looked for first
/// @throws rpc::Error (bad_input) on every rank on anything out of range, or given for another type of mesh
MeshOptions mesh_options(const Teuchos::ParameterList &list, const std::string &folder, const Comm &comm);

/// Space dimension, known before there is a mesh: rank 0 looks into a file, and gmsh reads a .geo. Collective on comm.
/// @throws rpc::Error on every rank, as gmsh_dimension() does
int dimension(const MeshOptions &options, const Comm &comm);

/// A mesh of the same body and elements with cells about `factor` times as long: a box has that many cells fewer in each
/// direction, at least one; a .geo, or a field of sizes, has that many times the size factor. A .msh cannot be coarsened: none. Nor
/// is a mesh with refinements, whose coarser meshes are its parents.
///
/// A box may have too few cells for the ranks, which make_mesh() tells; a .geo's mesh is then on some of them.
/// @throws rpc::Error (bad_input) unless factor >= 1 and finite
std::optional<MeshOptions> coarser(const MeshOptions &options, double factor);

/// The options with which gmsh meshes the same body, with elements of the same order, sides and blocks, by cell sizes of a field: an edge is
/// about as long as the field says there. A size factor is 1 then, and sizes and refinements that the options had are replaced. A box in
/// space gets tetrahedra; all else keeps its kind of cells. None where gmsh cannot make another mesh: for a .msh.
/// @param sizes        read on rank 0 only, may be null on others
/// @param refinements  gmsh makes cells 2^refinements times as long as the field says, and refined() halves them as often; where these are too
///                     large for a curved boundary, make_mesh() has gmsh make the small ones
std::optional<MeshOptions> with_sizes(const MeshOptions &options, std::shared_ptr<const SizeField> sizes,
                                      int refinements = 0);

/// The options by which the mesh that others ask for is refined to a field of sizes, see refined_to(). A box gets triangles or tetrahedra.
/// @param sizes  read on rank 0 only, may be null on others
MeshOptions refined_to_sizes(const MeshOptions &options, std::shared_ptr<const SizeField> sizes);

/// What a mesh by refined_to_sizes() begins with, on rank 0; null on others. GmshOptions::base takes it, so that it is made once. Collective.
/// @throws rpc::Error on every rank, as make_mesh() does
std::shared_ptr<const MeshData> base_mesh(const MeshOptions &options, const Comm &comm);

/// This rank's part of the mesh; collective.
/// @throws rpc::Error on every rank, as make_box() and read_gmsh() do
Mesh make_mesh(const MeshOptions &options, const RCP<const Comm> &comm);

} // namespace rpc::mesh
