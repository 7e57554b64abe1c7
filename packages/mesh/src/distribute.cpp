// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/distribute.hpp"

#include "device_tables.hpp"
#include "division.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
#include "sorted_lists.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <sstream>
#include <utility>

namespace rpc::mesh
{
namespace
{

/// What one rank gets.
struct Part {
  MeshData mesh;            // its local nodes and cells, in local numbers
  std::vector<int> node_id; // (owned nodes)
  std::vector<int> cell_id; // (owned cells)
  std::vector<int> halo_id; // (other cells)
  std::vector<int> gid;     // (local nodes) owned first, then ascending, which is by owner: what Tpetra packs best
};

/// Calls each(array) for all arrays of a part.
template <class AnyPart, class Each>
void for_each_array(AnyPart &part, const Each &each)
{
  each(part.mesh.coords);
  each(part.mesh.cells);
  each(part.mesh.block);
  for (auto &side : part.mesh.sides) {
    each(side.cell);
    each(side.ordinal);
  }
  for (auto &set : part.mesh.points) each(set.node);
  for (auto &of_shape : part.mesh.geometry) {
    each(of_shape.cell);
    each(of_shape.ordinal);
  }
  each(part.node_id);
  each(part.cell_id);
  each(part.halo_id);
  each(part.gid);
}

Part part_of(const MeshData &whole, const Division &division, const int rank)
{
  const Lists &nodes = division.nodes;
  const int width = whole.element.num_nodes(), dim = whole.element.dim;
  const auto nodes_of = [&](const int cell) { return whole.cells.data() + std::size_t(width) * cell; };
  Part part;
  part.mesh.element = whole.element;
  part.mesh.blocks = whole.blocks;
  part.mesh.geometry_file = whole.geometry_file;
  part.node_id.assign(nodes.first(rank), nodes.last(rank));

  const int num_owned = nodes.size_of(rank), first_gid = static_cast<int>(nodes.begin[rank]);
  std::vector<int> ghosts;
  for (const Lists *cells : {&division.cells, &division.halo})
    for (const int *cell = cells->first(rank); cell != cells->last(rank); ++cell)
      for (int a = 0; a < width; ++a) {
        const int node = nodes_of(*cell)[a];
        if (division.node_owner[node] != rank) ghosts.push_back(division.gid[node]);
      }
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  const auto lid_of = [&](const int node) {
    const int gid = division.gid[node];
    if (division.node_owner[node] == rank) return gid - first_gid;
    return num_owned + static_cast<int>(std::lower_bound(ghosts.begin(), ghosts.end(), gid) - ghosts.begin());
  };
  part.gid.resize(num_owned);
  std::iota(part.gid.begin(), part.gid.end(), first_gid);
  part.gid.insert(part.gid.end(), ghosts.begin(), ghosts.end());
  for (const int gid : part.gid)
    for (int d = 0; d < dim; ++d) part.mesh.coords.push_back(whole.coords[std::size_t(dim) * nodes.value[gid] + d]);

  const int num_sorted = std::min(4, whole.element.num_vertices());
  std::vector<int> cell_lid(whole.num_cells(), -1);
  int num_cells = 0;
  for (const Lists *cells : {&division.cells, &division.halo}) {
    const int *const first = cells->first(rank);
    std::vector<int> lowest; // node lid of each
    lowest.reserve(cells->size_of(rank));
    for (const int *cell = first; cell != cells->last(rank); ++cell) {
      int lid = lid_of(*nodes_of(*cell));
      for (int a = 1; a < width; ++a) lid = std::min(lid, lid_of(nodes_of(*cell)[a]));
      lowest.push_back(lid);
    }
    const Lists in_order = sorted_into_lists(lowest, static_cast<int>(part.gid.size()));
    std::vector<std::pair<std::array<int, 4>, int>> same; // others' lids, cell: with the same lowest node
    for (int lid = 0; lid < in_order.size(); ++lid) {
      same.clear();
      for (const int *k = in_order.first(lid); k != in_order.last(lid); ++k) {
        std::array<int, 4> lids{};
        if (division.sorts_cells) {
          lids.fill(std::numeric_limits<int>::max());
          for (int v = 0; v < num_sorted; ++v) lids[v] = lid_of(nodes_of(first[*k])[v]);
          std::sort(lids.begin(), lids.end());
        }
        same.emplace_back(lids, first[*k]);
      }
      if (division.sorts_cells) std::sort(same.begin(), same.end());
      for (const auto &[lids, cell] : same) {
        cell_lid[cell] = num_cells++;
        (cells == &division.cells ? part.cell_id : part.halo_id).push_back(cell);
        part.mesh.block.push_back(whole.block[cell]);
        for (int a = 0; a < width; ++a) part.mesh.cells.push_back(lid_of(nodes_of(cell)[a]));
      }
    }
  }

  const auto take_facets = [&](const auto &from, auto &mine) {
    for (std::size_t f = 0; f < from.cell.size(); ++f) {
      const int cell = from.cell[f], lid = cell_lid[cell];
      if (lid < 0) continue;
      const auto &facet = whole.element.facets()[from.ordinal[f]];
      const bool here = lid < static_cast<int>(part.cell_id.size()) ||
                        std::any_of(facet.begin(), facet.end(),
                                    [&](const int a) { return division.node_owner[nodes_of(cell)[a]] == rank; });
      if (!here) continue;
      mine.cell.push_back(lid);
      mine.ordinal.push_back(from.ordinal[f]);
    }
  };
  for (const SideData &side : whole.sides) take_facets(side, part.mesh.sides.emplace_back(SideData{side.name, {}, {}}));
  for (const BoundaryPart &of_shape : whole.geometry)
    take_facets(of_shape, part.mesh.geometry.emplace_back(BoundaryPart{of_shape.shape, {}, {}}));
  for (const PointData &set : whole.points) {
    PointData mine{set.name, {}};
    for (const int node : set.node)
      if (division.node_owner[node] == rank) mine.node.push_back(lid_of(node));
    std::sort(mine.node.begin(), mine.node.end());
    part.mesh.points.push_back(mine);
  }
  if (!division.node_id.empty())
    for (int &node : part.node_id) node = division.node_id[node];
  if (!division.cell_id.empty())
    for (int &cell : part.cell_id) cell = division.cell_id[cell];
  return part;
}

/// Rank 0's values on all ranks.
void broadcast(const Comm &comm, std::vector<std::string> &names)
{
  std::string text;
  for (const std::string &name : names) text += name + '\0';
  names.clear();
  std::istringstream in(text_of_rank(comm, 0, text));
  for (std::string name; std::getline(in, name, '\0');) names.push_back(name);
}

void broadcast(const Comm &comm, Element &element)
{
  int values[] = {element.dim, element.order, static_cast<int>(element.shape)};
  Teuchos::broadcast(comm, 0, 3, values);
  element = {values[0], values[1], static_cast<Shape>(values[2])};
}

/// Without facets on other ranks.
void broadcast(const Comm &comm, std::vector<BoundaryPart> &geometry)
{
  GO count = static_cast<GO>(geometry.size());
  Teuchos::broadcast(comm, 0, &count);
  geometry.resize(count);
  for (BoundaryPart &part : geometry) {
    BoundaryShape &shape = part.shape;
    int kind[] = {static_cast<int>(shape.kind), shape.tag};
    Teuchos::broadcast(comm, 0, 2, kind);
    shape.kind = static_cast<BoundaryShape::Kind>(kind[0]);
    shape.tag = kind[1];
    Teuchos::broadcast(comm, 0, 3, shape.point.data());
    Teuchos::broadcast(comm, 0, 3, shape.direction.data());
    Teuchos::broadcast(comm, 0, &shape.radius);
  }
}

void send_part(const Comm &comm, const Part &part, const int rank)
{
  for_each_array(part, [&](const auto &array) {
    const GO size = static_cast<GO>(array.size());
    Teuchos::send(comm, 1, &size, rank);
    in_pieces(array.size(),
              [&](const std::size_t first, const int n) { Teuchos::send(comm, n, array.data() + first, rank); });
  });
}

void receive_part(const Comm &comm, Part &part)
{
  for_each_array(part, [&](auto &array) {
    GO size = 0;
    Teuchos::receive(comm, 0, 1, &size);
    array.resize(size);
    in_pieces(array.size(),
              [&](const std::size_t first, const int n) { Teuchos::receive(comm, 0, n, array.data() + first); });
  });
}

Part deal(const MeshData &whole, const Comm &comm, const Division &division)
{
  Part part;
  std::vector<std::string> sides, points;
  if (comm.getRank() == 0) {
    part.mesh.element = whole.element;
    part.mesh.blocks = whole.blocks;
    for (const SideData &side : whole.sides) sides.push_back(side.name);
    for (const PointData &set : whole.points) points.push_back(set.name);
    for (const BoundaryPart &of_shape : whole.geometry) part.mesh.geometry.push_back({of_shape.shape, {}, {}});
  }
  broadcast(comm, part.mesh.element);
  broadcast(comm, part.mesh.blocks);
  broadcast(comm, sides);
  broadcast(comm, points);
  broadcast(comm, part.mesh.geometry);
  part.mesh.geometry_file = text_of_rank(comm, 0, whole.geometry_file);
  if (comm.getRank() == 0) {
    for (int rank = 1; rank < comm.getSize(); ++rank) send_part(comm, part_of(whole, division, rank), rank);
    return part_of(whole, division, 0);
  }
  for (const std::string &name : sides) part.mesh.sides.push_back({name, {}, {}});
  for (const std::string &name : points) part.mesh.points.push_back({name, {}});
  receive_part(comm, part);
  return part;
}

} // namespace

Mesh distribute(const MeshData &whole, const RCP<const Comm> &comm, const std::vector<double> &weights)
{
  Division division;
  on_root(*comm, ExitCode::internal_error, [&] { division = divide(whole, comm->getSize(), weights); });
  return distribute(whole, comm, division);
}

Mesh distribute(const MeshData &whole, const RCP<const Comm> &comm, const Division &division,
                std::vector<int> *const halo)
{
  const Part part = deal(whole, *comm, division);
  if (halo) *halo = part.halo_id;
  Mesh mesh;
  mesh.element = part.mesh.element;
  const GO invalid = Teuchos::OrdinalTraits<GO>::invalid();
  mesh.owned_nodes = rcp(new Map(invalid, part.node_id.size(), 0, comm));
  mesh.ghosts.assign(part.gid.begin() + static_cast<std::ptrdiff_t>(part.node_id.size()), part.gid.end());
  mesh.coords = device_table("rpc::mesh::coords", part.mesh.coords, mesh.dim());
  mesh.cells = device_table("rpc::mesh::cells", part.mesh.cells, mesh.element.num_nodes());
  mesh.block = to_device(host_array<int>("rpc::mesh::block", part.mesh.block));
  mesh.node_id = host_array<GO>("rpc::mesh::node_id", part.node_id);
  mesh.cell_id = host_array<GO>("rpc::mesh::cell_id", part.cell_id);
  mesh.num_owned_cells = static_cast<LO>(part.cell_id.size());
  mesh.blocks = part.mesh.blocks;
  for (const SideData &side : part.mesh.sides)
    mesh.sides.push_back(make_side(side.name, mesh, host_array<LO>("rpc::mesh::side_cell", side.cell),
                                   host_array<int>("rpc::mesh::side_ordinal", side.ordinal)));
  for (const PointData &set : part.mesh.points) mesh.points.push_back({set.name, {set.node.begin(), set.node.end()}});
  mesh.geometry = part.mesh.geometry;
  mesh.geometry_file = part.mesh.geometry_file;
  if (comm->getRank() == 0) mesh.notes = whole.notes;
  Kokkos::fence();
  return mesh;
}

} // namespace rpc::mesh
