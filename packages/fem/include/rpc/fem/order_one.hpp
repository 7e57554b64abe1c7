// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/discretization.hpp"

#include <memory>

namespace rpc::fem
{

/// The mesh of the vertices of another one's cells, with straight edges, and the interpolation to it.
struct OrderOne {
  std::shared_ptr<const mesh::Mesh> mesh; ///< cells as those of the other mesh, in their order
  /// (owned nodes of the other mesh x vertices) A node within an edge, face or cell takes the mean of its vertices, so that
  /// constant and linear functions of the reference coordinates are exact in curved cells too.
  RCP<CrsMatrix> interpolation;
  DeviceView<LO *> node; ///< (overlap vertices) which node of the other mesh each is
};

/// @param d  of order 2; collective
OrderOne order_one(const Discretization &d);

} // namespace rpc::fem
