// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"

namespace rpc::mesh
{

/// Loads gmsh's defaults, silent, with the user's own gmsh settings out of play.
void start_gmsh();

/// The first error in gmsh's log; those after it tend to follow from it. That curved cells could not all be straightened is none: whether
/// one is inverted is looked at later.
std::string first_error();

/// Adds a group with the elements on some entities.
void take_group(const GmshGroup &group, const std::vector<int> &entities, GmshContents &contents);

/// Makes one mesh, after start_gmsh(): gmsh is not fit for another, nor for an end in good order.
GmshContents made_mesh(const GmshRequest &request);

} // namespace rpc::mesh
