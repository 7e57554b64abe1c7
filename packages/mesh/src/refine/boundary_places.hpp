// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "middles.hpp"

#include <string>
#include <vector>

namespace rpc::mesh
{

/// Where cells are too large to be halved there.
inline constexpr auto remedy_for_curved_boundaries =
    "Use a smaller \"Mesh->Size Factor\", with fewer \"Mesh->Refinements\"; or \"Adapt->Meshes\" = gmsh instead of "
    "nested.";

/// Moves the middles of facets, and of their edges, onto what these facets lie on, unless all of that is flat or they are in place. Collective.
/// @param[in,out] coords  (middles; dim) of each kind of middles [m]; those of other ranks are not touched
/// @param[out]    moved   (middles) of each kind, 1 where it was
/// @throws rpc::Error (bad_mesh) on every rank where a node would move by more than half the size of its edge or face
void move_to_boundary(const LocalMesh &mesh, const std::vector<Middles> &middles, const std::string &file,
                      std::vector<std::vector<double>> &coords, std::vector<std::vector<char>> &moved);

} // namespace rpc::mesh
