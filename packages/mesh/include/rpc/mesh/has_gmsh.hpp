// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rpc::mesh
{

/// Whether this program was built with gmsh, which makes meshes.
bool has_gmsh();

} // namespace rpc::mesh
