// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/dofs.hpp"
#include "rpc/core/kokkos.hpp"

#include <vector>

namespace rpc
{

/// Points that lie on nodes, each with a weight and a direction, in groups: within a group no node comes twice, while a node
/// of two groups is two points.
struct NodePoints {
  int dim = 2;
  HostView<LO *> first;            ///< (groups + 1) where each group's points begin
  DeviceView<LO *> node;           ///< (n) owned node lids, ascending in each group
  DeviceView<double *> weight;     ///< (n) [m^(dim-1)]
  DeviceView<double **> direction; ///< (n, dim); 0 for a point that takes no part

  int num_groups() const { return static_cast<int>(first.extent(0)) - 1; }
  LO size() const { return static_cast<LO>(node.extent(0)); }
  /// The unknown of one component at the node of point i, for kernels.
  KOKKOS_INLINE_FUNCTION LO dof(const LO i, const int component) const { return rpc::dof(dim, node(i), component); }
};

/// (n) The nodes of some lists, each once, ascending.
DeviceView<LO *> distinct_nodes(const std::vector<DeviceView<LO *>> &lists);

/// Runs work(i) for all points, group after group: no other thread works on the node of point i meanwhile.
template <class Work>
void for_each_point_by_group(const char *label, const NodePoints &points, const Work &work)
{
  for (int group = 0; group < points.num_groups(); ++group)
    Kokkos::parallel_for(label, Kokkos::RangePolicy<ExecutionSpace, LO>(points.first(group), points.first(group + 1)),
                         work);
}

/// direction_i . x at the node of point i, for kernels.
/// @param x  (owned dofs)
template <class X>
KOKKOS_INLINE_FUNCTION double along_direction(const NodePoints &points, const LO i, const X &x)
{
  double sum = 0;
  for (int k = 0; k < points.dim; ++k) sum += points.direction(i, k) * x(points.dof(i, k));
  return sum;
}

/// |direction_i|^2, for kernels.
KOKKOS_INLINE_FUNCTION double squared_length(const NodePoints &points, const LO i)
{
  double sum = 0;
  for (int k = 0; k < points.dim; ++k) sum += points.direction(i, k) * points.direction(i, k);
  return sum;
}

} // namespace rpc
