// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "edge_marks.hpp"

#include <memory>
#include <vector>

namespace rpc::mesh
{

/// A level of refined_to(). Collective.
/// @param halving  (owned cells) of triangles or tetrahedra
Mesh halved(const std::shared_ptr<const Mesh> &coarse, const std::vector<Halving> &halving);

} // namespace rpc::mesh
