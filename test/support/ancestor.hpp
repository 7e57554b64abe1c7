// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"

#include <memory>

namespace rpc::test
{

/// The mesh that is reached by going `levels` times to the parents; null where there are not as many.
inline std::shared_ptr<const mesh::Mesh> ancestor(std::shared_ptr<const mesh::Mesh> mesh, const int levels)
{
  for (int k = 0; k < levels && mesh; ++k) mesh = mesh->parents ? mesh->parents->mesh : nullptr;
  return mesh;
}

} // namespace rpc::test
