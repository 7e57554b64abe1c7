// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/discretization.hpp"

namespace rpc::fem
{

/// Vertices of a facet; they are its first nodes.
inline int num_facet_vertices(const mesh::Element &element)
{
  return element.dim == 2 ? 2 : element.shape == mesh::Shape::tensor ? 4 : 3;
}

/// Whether there are owned nodes, on any rank, where the cells around are not all joined over facets that hold the node; collective.
bool has_pinched_nodes(const Discretization &d);

} // namespace rpc::fem
