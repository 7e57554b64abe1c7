// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gmsh_contents.hpp"

namespace rpc::mesh
{

/// The curves of the plane body, or the surfaces of the one in space, that gmsh has meshed: what they lie on, and their elements.
///
/// Points of each, at even parameters, tell whether it lies on a line, circle, plane, sphere or cylinder, to 1e-9 of its size.
void take_boundary(GmshContents &contents);

/// The points that are asked for, instead of a mesh.
void take_nearest_points(const GmshRequest &request, GmshContents &contents);

} // namespace rpc::mesh
