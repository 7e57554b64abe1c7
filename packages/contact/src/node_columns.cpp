// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/node_columns.hpp"

namespace rpc::contact
{

RCP<MultiVector> node_columns(const ContactNodes &contact, const DeviceView<double *> &values,
                              const RCP<const Map> &owned_nodes)
{
  const ContactNodes c = contact;
  const auto columns = rcp(new MultiVector(owned_nodes, c.num_sides()));
  for (int side = 0; side < c.num_sides(); ++side) {
    const LO begin = c.first(side);
    const auto to = columns->getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "rpc::contact::node_columns", device_range(c.first(side + 1) - begin),
        KOKKOS_LAMBDA(const LO i) { to(c.node(begin + i), side) = values(begin + i); });
    Kokkos::fence();
  }
  return columns;
}

DeviceView<double *> at_points(const ContactNodes &contact, const MultiVector &columns)
{
  const ContactNodes c = contact;
  const DeviceView<double *> values("rpc::contact::at_points", c.size());
  for (int side = 0; side < c.num_sides(); ++side) {
    const LO begin = c.first(side);
    const auto from = columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
    Kokkos::parallel_for(
        "rpc::contact::at_points", device_range(c.first(side + 1) - begin),
        KOKKOS_LAMBDA(const LO i) { values(begin + i) = from(c.node(begin + i), side); });
    Kokkos::fence();
  }
  return values;
}

RCP<MultiVector> node_columns(const ContactNodes &contact, const DeviceView<double **> &vectors,
                              const RCP<const Map> &owned_nodes)
{
  const ContactNodes c = contact;
  const auto columns = rcp(new MultiVector(owned_nodes, c.num_sides() * c.dim));
  const auto to = columns->getLocalViewDevice(Tpetra::Access::ReadWrite);
  for (int side = 0; side < c.num_sides(); ++side) {
    const LO begin = c.first(side);
    Kokkos::parallel_for(
        "rpc::contact::node_vectors", device_range(c.first(side + 1) - begin), KOKKOS_LAMBDA(const LO i) {
          for (int k = 0; k < c.dim; ++k) to(c.node(begin + i), c.dim * side + k) = vectors(begin + i, k);
        });
    Kokkos::fence();
  }
  return columns;
}

DeviceView<double **> vectors_at_points(const ContactNodes &contact, const MultiVector &columns)
{
  const ContactNodes c = contact;
  const DeviceView<double **> vectors("rpc::contact::vectors_at_points", c.size(), c.dim);
  const auto from = columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
  for (int side = 0; side < c.num_sides(); ++side) {
    const LO begin = c.first(side);
    Kokkos::parallel_for(
        "rpc::contact::vectors_at_points", device_range(c.first(side + 1) - begin), KOKKOS_LAMBDA(const LO i) {
          for (int k = 0; k < c.dim; ++k) vectors(begin + i, k) = from(c.node(begin + i), c.dim * side + k);
        });
    Kokkos::fence();
  }
  return vectors;
}

} // namespace rpc::contact
