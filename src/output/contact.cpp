// SPDX-License-Identifier: BSD-3-Clause
#include "output/contact.hpp"

#include "rpc/fem/surface.hpp"
#include "rpc/io/contact_csv.hpp"
#include "rpc/mesh/canonical_order.hpp"

#include <vector>

namespace rpc
{
namespace
{

/// [begin, end) of a view, on the host.
template <class Data>
HostView<Data *> part_of(const DeviceView<Data *> &values, const LO begin, const LO end)
{
  HostView<Data *> part(values.label(), end - begin);
  Kokkos::deep_copy(part, Kokkos::subview(values, Kokkos::make_pair(begin, end)));
  return part;
}

/// Rows [begin, end) of a view, on the host.
HostView<double **> rows_of(const DeviceView<double **> &values, const LO begin, const LO end)
{
  const auto all = to_host(values);
  HostView<double **> part(values.label(), end - begin, values.extent(1));
  for (LO i = begin; i < end; ++i)
    for (std::size_t k = 0; k < values.extent(1); ++k) part(i - begin, k) = all(i, k);
  return part;
}

} // namespace

void write_contact(const std::string &path, const Scene &scene, const analysis::Solution &s)
{
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const auto &contact = s.step.contact;
  const HostPoints position = fem::node_positions(mesh, contact.node);
  const auto along = contact::tangential_displacements(contact, *s.u);
  const auto force = contact::point_forces(contact, s.contact);
  const bool in_order = mesh.dim() == 2; // along the side, for which its facets are needed
  const auto node_ids = in_order ? mesh::overlap_node_ids(mesh) : HostView<GO *>();
  std::vector<io::ContactTable> tables;
  for (int k = 0; k < contact.num_sides(); ++k) {
    const LO begin = contact.first(k), end = contact.first(k + 1);
    io::ContactTable table;
    table.side = scene.model.contact[k].name_in_results();
    table.id = HostView<GO *>("rpc::output::id", end - begin);
    table.position = HostView<double **>("rpc::output::position", end - begin, mesh.dim());
    const auto node = part_of(contact.node, begin, end);
    for (LO i = 0; i < end - begin; ++i) {
      table.id(i) = mesh.node_id(node(i));
      for (int c = 0; c < mesh.dim(); ++c) table.position(i, c) = position(begin + i, c);
    }
    table.weight = part_of(contact.weight, begin, end);
    table.u_nu = part_of(s.contact.normal_displacement, begin, end);
    table.gap = part_of(contact.gap, begin, end);
    table.pressure = part_of(s.contact.pressure, begin, end);
    table.dent = part_of(s.contact.dent, begin, end);
    table.state = part_of(s.contact.state, begin, end);
    table.along = rows_of(along, begin, end);
    table.force = rows_of(force, begin, end);
    table.friction = contact::has_friction(scene.model.contact);
    if (end > begin && table.friction) {
      table.traction = rows_of(s.contact.traction, begin, end);
      table.slip = rows_of(s.contact.slip, begin, end);
      table.used = part_of(s.contact.used, begin, end);
      table.slip_state = part_of(s.contact.slip_state, begin, end);
    }
    if (in_order)
      table.facets = mesh::owned_facets(
          mesh, mesh.side(scene.model.contact[k].side, scene.model.contact[k].path + "->Side"), node_ids);
    tables.push_back(table);
  }
  io::write_contact_csv(path, mesh.owned_nodes->getComm(), tables, scene.model.units, s.discretization.per_length());
}

} // namespace rpc
