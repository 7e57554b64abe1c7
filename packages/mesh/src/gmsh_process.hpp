// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"

namespace rpc::mesh
{

/// Has the program rpc_gmsh make a mesh, and waits for it; starts it if need be. Whatever happens to gmsh, this process goes on.
/// @param where  begin of messages
/// @throws rpc::Error (bad_mesh) if gmsh breaks down, (bad_input) if it cannot be started
GmshContents run_gmsh(const std::string &where, const GmshRequest &request);

} // namespace rpc::mesh
