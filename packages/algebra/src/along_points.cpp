// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/along_points.hpp"

#include <cmath>

namespace rpc
{
namespace
{

/// directions += |m_i|/|m_i|, entry by entry, at the node of each point.
void add_directions(const NodePoints &p, Vector &directions)
{
  const auto to = device_write(directions);
  for_each_point_by_group(
      "rpc::algebra::directions", p, KOKKOS_LAMBDA(const LO i) {
        const double length = squared_length(p, i);
        if (length > 0)
          for (int k = 0; k < p.dim; ++k) to(p.dof(i, k)) += std::fabs(p.direction(i, k)) / std::sqrt(length);
      });
  Kokkos::fence();
}

} // namespace

DeviceView<double *> own_stiffness(const StiffnessOperator &K, const NodePoints &points)
{
  const NodePoints p = points;
  const auto block = K.diagonal_blocks(p.node);
  const DeviceView<double *> stiffness("rpc::algebra::own_stiffness", p.size());
  Kokkos::parallel_for(
      "rpc::algebra::own_stiffness", device_range(p.size()), KOKKOS_LAMBDA(const LO i) {
        double along = 0;
        for (int k = 0; k < p.dim; ++k)
          for (int l = 0; l < p.dim; ++l) along += p.direction(i, k) * block(i, k, l) * p.direction(i, l);
        const double length = squared_length(p, i);
        stiffness(i) = length > 0 ? along / (length * p.weight(i)) : 0;
      });
  Kokkos::fence();
  return stiffness;
}

DeviceView<double *> coupled_stiffness(const StiffnessOperator &K, const NodePoints &points)
{
  const NodePoints p = points;
  Vector directions(K.getDomainMap());
  add_directions(p, directions);
  const auto at = device_read(K.at_columns(directions));
  const auto rows = K.rows().blocks();
  const DeviceView<double *> stiffness("rpc::algebra::coupled_stiffness", p.size());
  Kokkos::parallel_for(
      "rpc::algebra::coupled_stiffness", device_range(p.size()), KOKKOS_LAMBDA(const LO i) {
        double sum = 0;
        const LO size = rows.size(p.node(i));
        for (int k = 0; k < p.dim; ++k) {
          const double m = p.direction(i, k);
          if (m == 0) continue;
          for (LO n = 0; n < size; ++n)
            for (int l = 0; l < p.dim; ++l)
              sum += std::fabs(m * rows.entry(p.node(i), n, k, l)) * at(dof(p.dim, rows.column(p.node(i), n), l));
        }
        const double length = squared_length(p, i);
        stiffness(i) = length > 0 ? sum / (length * std::sqrt(length)) : 0;
      });
  Kokkos::fence();
  return stiffness;
}

} // namespace rpc
