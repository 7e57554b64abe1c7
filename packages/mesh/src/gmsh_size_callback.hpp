// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <gmsh.h>
#include <utility>

/// What differs between the versions of gmsh that rpc is compiled with.
namespace rpc::mesh
{

/// A cell size that bounds nothing, in the geometry's unit of length; gmsh's own default of Mesh.MeshSizeMax.
inline constexpr double unbounded_size = 1e22;

/// Lets `size` give the cell size at each point that gmsh meshes from now on, until removeSizeCallback().
///
/// gmsh 4.8 takes the smaller one of the answer and of the size that it found itself, and does not tell the latter. Later versions
/// tell their own size, and the answer takes that one's place. So who asks for no size of its own has to answer `own_size`: it
/// is gmsh's own where gmsh tells it, and unbounded_size where gmsh takes the smaller one anyway.
/// @param size  size(dimension, tag, x, y, z, own_size): dimension and tag of the entity that is meshed; positive
template <class Size>
void set_size_callback(Size size)
{
  gmsh::model::mesh::setSizeCallback([size = std::move(size)](const int dim, const int tag, const double x,
                                                              const double y, const double z, const auto... told) {
    return size(dim, tag, x, y, z, std::min({unbounded_size, static_cast<double>(told)...}));
  });
}

} // namespace rpc::mesh
