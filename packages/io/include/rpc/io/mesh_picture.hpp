// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh_data.hpp"

#include <cstddef>
#include <string>

namespace rpc::io
{

/// Name of the colour that mesh_picture() gives the k-th side. There are ten, which come again.
std::string colour_of_side(std::size_t k);

/// A picture of a whole mesh, a PNG file's bytes: cells with their edges, sides in colours. A body in the plane from above; one in
/// space from two opposite corners, so that each facet that is not in a hollow is seen. Blocks and facets without a side are grey. One rank.
std::string mesh_picture(const mesh::MeshData &mesh);

} // namespace rpc::io
