// SPDX-License-Identifier: BSD-3-Clause
#include "internal_work.hpp"

#include <cmath>

namespace rpc::fem
{
namespace
{

/// @param[in,out] force  0
template <int Dim, int Nodes, bool Axisymmetric>
void add_internal_work(const Discretization &d, const ElasticCells<Dim, Nodes, Axisymmetric> &body,
                       const Vector &u_overlap, Vector &force, double &squares, double &energy)
{
  const mesh::Mesh &mesh = *d.mesh;
  const DeviceView<double *[Nodes][Dim]> share("rpc::fem::force_share", one_thread ? 0 : mesh.num_cells());
  const InternalWorkOfCell<Dim, Nodes, Axisymmetric> kernel{
      body, device_read(u_overlap), mesh.num_owned_nodes(), mesh.num_owned_cells, device_write(force), share};
  Kokkos::parallel_reduce("rpc::fem::internal_work", device_range(mesh.num_cells()), kernel, squares, energy);
  if constexpr (!one_thread)
    Kokkos::parallel_for("rpc::fem::sum_shares", device_range(mesh.num_owned_nodes()),
                         SumShares<Dim, Nodes>{mesh.cells, share, d.node_to_cells, device_write(force)});
}

} // namespace

InternalWork internal_work(const Discretization &d, const Materials &materials, const Vector &u)
{
  const mesh::Mesh &mesh = *d.mesh;
  const auto forces = rcp(new Vector(d.owned_dofs));
  double squares = 0, energy = 0;
  with_elastic_cells(
      d, materials, [&](const auto &body) { add_internal_work(d, body, *on_overlap(d, u), *forces, squares, energy); });
  Kokkos::fence();
  return {forces, std::sqrt(sum_all(mesh.comm(), squares)), sum_all(mesh.comm(), energy)};
}

} // namespace rpc::fem
