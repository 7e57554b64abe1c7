// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/updated_operator.hpp"

namespace rpc::test
{

/// K with an update at the nodes of some points.
inline RCP<UpdatedOperator> updated(RCP<const CrsMatrix> K, const NodePoints &points)
{
  return rcp(new UpdatedOperator(rcp(new StiffnessOperator(std::move(K), points.dim)), distinct_nodes({points.node})));
}

/// (points, dim, dim) a m m^T.
/// @param a  (points)
inline DeviceView<double ***> along_directions(const NodePoints &points, const HostView<double *> &a)
{
  const DeviceView<double ***> block("rpc::test::along_directions", points.size(), points.dim, points.dim);
  const auto to = Kokkos::create_mirror_view(block);
  const auto m = to_host(points.direction);
  for (LO i = 0; i < points.size(); ++i)
    for (int k = 0; k < points.dim; ++k)
      for (int l = 0; l < points.dim; ++l) to(i, k, l) = a(i) * m(i, k) * m(i, l);
  Kokkos::deep_copy(block, to);
  return block;
}

} // namespace rpc::test
