// SPDX-License-Identifier: BSD-3-Clause
#include "local_mesh.hpp"

#include "../device_tables.hpp"
#include "middles.hpp"
#include "routed.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/canonical_order.hpp"

#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <numeric>

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

LocalMesh without_unused_nodes(LocalMesh mesh)
{
  const auto &comm = mesh.owned_nodes->getComm();
  const int old_owned = mesh.num_owned_nodes(), dim = mesh.dim();
  std::vector<int> used(mesh.num_nodes(), 0);
  for (const int node : mesh.cells) used[node] = 1;
  const int num_owned = std::accumulate(used.begin(), used.begin() + old_owned, 0);
  if (sum_all(*comm, GO(old_owned - num_owned)) == 0) return mesh;

  GO total = 0;
  const GO num_ids = static_cast<GO>(mesh.owned_nodes->getGlobalNumElements());
  const std::vector<GO> id = sums_before(*comm, num_ids, mesh.id, {used.begin(), used.begin() + old_owned}, total);
  const std::vector<GO> others(mesh.gid.begin() + old_owned, mesh.gid.end()); // all of them are used
  const GO first = sum_before(*comm, GO(num_owned));
  std::vector<int> lid(mesh.num_nodes());
  for (int n = 0, next = 0; n < mesh.num_nodes(); ++n) lid[n] = used[n] ? next++ : -1;
  if (comm->getSize() > 1) {
    const Routed routed(*comm, owners_of(mesh, others));
    const std::vector<double> asked = routed.forward({others.begin(), others.end()}, 1);
    std::vector<double> answers;
    for (const double gid : asked) {
      const int n = mesh.owned_nodes->getLocalElement(static_cast<GO>(gid));
      answers.insert(answers.end(), {static_cast<double>(first + lid[n]), static_cast<double>(id[n])});
    }
    const std::vector<double> got = routed.back(answers, 2);
    for (std::size_t k = 0; k < others.size(); ++k) {
      mesh.gid[old_owned + k] = static_cast<GO>(got[2 * k]);
      mesh.id[old_owned + k] = static_cast<GO>(got[2 * k + 1]);
    }
  }
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    if (!used[n]) continue;
    const int to = lid[n];
    mesh.gid[to] = n < old_owned ? first + to : mesh.gid[n];
    mesh.id[to] = n < old_owned ? id[n] : mesh.id[n];
    mesh.moved[to] = mesh.moved[n];
    std::copy_n(mesh.coords.begin() + std::ptrdiff_t(dim) * n, dim, mesh.coords.begin() + std::ptrdiff_t(dim) * to);
  }
  const int num_nodes = std::accumulate(used.begin(), used.end(), 0);
  mesh.gid.resize(num_nodes);
  mesh.id.resize(num_nodes);
  mesh.moved.resize(num_nodes);
  mesh.coords.resize(std::size_t(dim) * num_nodes);
  for (int &node : mesh.cells) node = lid[node];
  for (PointData &set : mesh.points) {
    for (int &node : set.node) node = lid[node];
    set.node.erase(std::remove(set.node.begin(), set.node.end(), -1), set.node.end());
  }
  mesh.owned_nodes = rcp(new Map(Teuchos::OrdinalTraits<GO>::invalid(), static_cast<std::size_t>(num_owned), 0, comm));
  return mesh;
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
  mesh.notes = coarse->notes;
  mesh.parents = std::make_shared<const Parents>(Parents{coarse, local.parent, local.kind, local.child_vertices});
  Kokkos::fence();
  return mesh;
}

} // namespace rpc::mesh
