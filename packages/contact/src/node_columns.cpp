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

} // namespace rpc::contact
