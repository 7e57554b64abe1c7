// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"

namespace rpc::mesh
{

/// The box, its block, its sides and corners, as make_box() names and orders them.
void add_box(const GmshRequest &request);

} // namespace rpc::mesh
