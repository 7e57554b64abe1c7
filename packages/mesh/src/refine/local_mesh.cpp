#include "local_mesh.hpp"

#include "../device_tables.hpp"
#include "rpc/mesh/canonical_order.hpp"

#include <algorithm>

namespace rpc::mesh
{
namespace
{

template <class Table>
auto rows_of(const Table &table)
{
  const auto host = to_host(table);
  std::vector<typename Table::non_const_value_type> values;
  values.reserve(host.size());
  for (std::size_t n = 0; n < host.extent(0); ++n)
    for (std::size_t k = 0; k < host.extent(1); ++k) values.push_back(host(n, k));
  return values;
}

template <class List>
auto values_of(const List &list)
{
  const auto host = to_host(list);
  return std::vector<typename List::non_const_value_type>(host.data(), host.data() + host.extent(0));
}

} // namespace

LocalMesh local_mesh(const Mesh &mesh)
{
  LocalMesh local;
  local.element = mesh.element;
  local.owned_nodes = mesh.owned_nodes;
  for (LO n = 0; n < mesh.num_local_nodes(); ++n) local.gid.push_back(mesh.node_gid(n));
  const auto ids = overlap_node_ids(mesh);
  local.id.assign(ids.data(), ids.data() + ids.extent(0));
  local.coords = rows_of(mesh.coords);
  local.moved.assign(local.gid.size(), 0);
  local.cells = rows_of(mesh.cells);
  local.block = values_of(mesh.block);
  const auto cell_id = mesh.cell_id.list();
  local.cell_id.assign(cell_id.data(), cell_id.data() + cell_id.extent(0));
  for (const Side &side : mesh.sides) local.sides.push_back({side.name, values_of(side.cell), values_of(side.ordinal)});
  local.geometry = mesh.geometry;
  for (const PointSet &set : mesh.points) local.points.push_back({set.name, {set.node.begin(), set.node.end()}});
  return local;
}

Mesh mesh_of(const LocalMesh &local, const std::shared_ptr<const Mesh> &coarse)
{
  Mesh mesh;
  mesh.element = local.element;
  mesh.owned_nodes = local.owned_nodes;
  mesh.ghosts.assign(local.gid.begin() + local.num_owned_nodes(), local.gid.end());
  mesh.coords = device_table("rpc::mesh::coords", local.coords, mesh.dim());
  mesh.cells = device_table("rpc::mesh::cells", local.cells, mesh.element.num_nodes());
  mesh.block = to_device(host_array<int>("rpc::mesh::block", local.block));
  HostView<GO *> node_id("rpc::mesh::node_id", local.num_owned_nodes());
  std::copy_n(local.id.begin(), local.num_owned_nodes(), node_id.data());
  mesh.node_id = node_id;
  mesh.cell_id = host_array<GO>("rpc::mesh::cell_id", local.cell_id);
  mesh.num_owned_cells = local.num_owned_cells();
  mesh.blocks = coarse->blocks;
  for (const SideData &side : local.sides)
    mesh.sides.push_back(make_side(side.name, mesh, host_array<LO>("rpc::mesh::side_cell", side.cell),
                                   host_array<int>("rpc::mesh::side_ordinal", side.ordinal)));
  for (const PointData &set : local.points) mesh.points.push_back({set.name, {set.node.begin(), set.node.end()}});
  mesh.geometry = local.geometry;
  mesh.geometry_file = coarse->geometry_file;
  mesh.parents = std::make_shared<const Parents>(Parents{coarse, local.parent, local.kind});
  Kokkos::fence();
  return mesh;
}

} // namespace rpc::mesh
