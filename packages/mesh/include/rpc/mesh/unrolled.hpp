// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"

#include <memory>
#include <vector>

namespace rpc::mesh
{

/// A periodic box as files want it: nodes of its upper sides are nodes of their own, so that no cell reaches across the box.
struct Unrolled {
  std::shared_ptr<const Mesh> mesh; ///< the same where the mesh is not periodic; its owned cells are the same
  std::vector<LO> node;             ///< (its owned nodes) the owned node of the periodic box; empty: itself

  /// Values at its owned nodes.
  HostView<double *> at_nodes(const HostView<double *> &owned) const;
};

/// Collective.
Unrolled unrolled(const std::shared_ptr<const Mesh> &mesh);

} // namespace rpc::mesh
