// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"

namespace rpc::mesh
{

/// Loads gmsh's defaults, silent, with the user's own gmsh settings out of play.
void start_gmsh();

/// Makes one mesh, after start_gmsh(): gmsh is not fit for another, nor for an end in good order.
GmshContents made_mesh(const GmshRequest &request);

} // namespace rpc::mesh
