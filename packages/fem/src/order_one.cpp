// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/order_one.hpp"

#include "interpolation_matrix.hpp"
#include "rpc/core/device_values.hpp"
#include "rpc/core/error.hpp"
#include "rpc/mesh/box.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_OrdinalTraits.hpp>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace rpc::fem
{
namespace
{

/// (nodes, vertices) Weights with which a cell's nodes take the values of its vertices.
std::vector<std::vector<double>> weights_of_vertices(const mesh::Element &element)
{
  const auto &lattice = element.lattice();
  std::vector<std::vector<double>> weights;
  for (const auto &place : lattice) {
    std::vector<double> weight;
    double sum = 0; // of the coordinates in a simplex
    for (const int along : place) sum += 0.5 * along;
    for (int v = 0; v < element.num_vertices(); ++v) {
      double value = 1;
      bool is_origin = true;
      for (int d = 0; d < element.dim; ++d) {
        const double along = 0.5 * place[d];
        if (element.shape == mesh::Shape::tensor)
          value *= lattice[v][d] > 0 ? along : 1 - along;
        else if (lattice[v][d] > 0) {
          value = along;
          is_origin = false;
        }
      }
      weight.push_back(element.shape == mesh::Shape::simplex && is_origin ? 1 - sum : value);
    }
    weights.push_back(weight);
  }
  return weights;
}

/// Numbers of the vertices: their places among a rank's own nodes, then among its others.
struct Vertices {
  std::vector<LO> node;  // (overlap vertices) node lids, ascending: owned first
  std::vector<LO> place; // (overlap nodes) vertex lid; -1: none
  LO num_owned = 0;
};

/// @param cells  of the mesh, on the host
template <class Cells>
Vertices vertices_of(const mesh::Mesh &mesh, const Cells &cells)
{
  Vertices vertices;
  vertices.place.assign(mesh.num_local_nodes(), -1);
  for (std::size_t c = 0; c < cells.extent(0); ++c)
    for (int v = 0; v < mesh.element.num_vertices(); ++v) vertices.place[cells(c, v)] = 0;
  for (LO n = 0; n < mesh.num_local_nodes(); ++n) {
    if (vertices.place[n] < 0) continue;
    vertices.place[n] = static_cast<LO>(vertices.node.size());
    vertices.node.push_back(n);
    vertices.num_owned += n < mesh.num_owned_nodes();
  }
  return vertices;
}

/// Rows of the fine mesh's coordinates that images of vertices have, ascending, and all rows' numbers in the coarse one; -1: none.
struct VertexPlaces {
  std::vector<LO> image, row;
};

/// @param places  of the mesh, on the host
template <class Places>
VertexPlaces places_of(const mesh::Mesh &mesh, const Vertices &vertices, const Places &places)
{
  VertexPlaces found;
  found.row = vertices.place;
  found.row.resize(mesh.coords.extent(0), -1);
  const auto first_image = static_cast<std::size_t>(mesh.num_local_nodes());
  for (std::size_t c = 0; c < places.extent(0); ++c)
    for (int v = 0; v < mesh.element.num_vertices(); ++v)
      found.row[places(c, v)] = std::max(found.row[places(c, v)], 0);
  for (std::size_t n = first_image; n < found.row.size(); ++n) {
    if (found.row[n] < 0) continue;
    found.row[n] = static_cast<LO>(vertices.node.size() + found.image.size());
    found.image.push_back(static_cast<LO>(n));
  }
  return found;
}

/// The gids of those that other ranks own; collective.
std::vector<GO> ghosts_among(const Discretization &d, const Vertices &vertices, const Map &owned)
{
  const auto gid = rcp(new MultiVector(d.mesh->owned_nodes, 1)); // doubles hold them exactly
  {
    const auto to = gid->getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (LO v = 0; v < vertices.num_owned; ++v)
      to(vertices.node[v], 0) = static_cast<double>(owned.getGlobalElement(v));
  }
  const auto all = nodes_on_overlap(d, gid);
  const auto from = all->getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<GO> gids;
  for (std::size_t v = vertices.num_owned; v < vertices.node.size(); ++v)
    gids.push_back(std::llround(from(vertices.node[v], 0)));
  return gids;
}

} // namespace

OrderOne order_one(const Discretization &d)
{
  const mesh::Mesh &from = *d.mesh;
  RPC_REQUIRE(from.element.order == 2, "fem: a mesh of order 2 is needed, got order " << from.element.order);
  const int num_vertices = from.element.num_vertices(), num_nodes = from.element.num_nodes();
  const auto cells = to_host(from.cells);
  const auto coords = to_host(from.coords);
  const Vertices vertices = vertices_of(from, cells);
  const LO num_local_vertices = static_cast<LO>(vertices.node.size());

  const auto mesh = std::make_shared<mesh::Mesh>();
  mesh->element = from.element;
  mesh->element.order = 1;
  if (from.box) {
    auto box = *from.box;
    box.element = mesh->element;
    mesh->box = std::make_shared<const mesh::BoxOptions>(std::move(box));
  }
  const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  mesh->owned_nodes =
      rcp(new Map(unknown, static_cast<std::size_t>(vertices.num_owned), 0, from.owned_nodes->getComm()));
  mesh->ghosts = ghosts_among(d, vertices, *mesh->owned_nodes);
  const auto places = to_host(from.places());
  const VertexPlaces vertex_places = places_of(from, vertices, places);
  const LO num_places = num_local_vertices + static_cast<LO>(vertex_places.image.size());
  mesh->coords = DeviceView<double **>("rpc::fem::vertex_coords", num_places, from.dim());
  mesh->cells = DeviceView<LO **>("rpc::fem::vertex_cells", cells.extent(0), num_vertices);
  const auto to_coords = Kokkos::create_mirror_view(mesh->coords);
  const auto to_cells = Kokkos::create_mirror_view(mesh->cells);
  for (LO v = 0; v < num_places; ++v) {
    const LO row = v < num_local_vertices ? vertices.node[v] : vertex_places.image[v - num_local_vertices];
    for (int k = 0; k < from.dim(); ++k) to_coords(v, k) = coords(row, k);
  }
  for (std::size_t c = 0; c < cells.extent(0); ++c)
    for (int v = 0; v < num_vertices; ++v) to_cells(c, v) = vertices.place[cells(c, v)];
  Kokkos::deep_copy(mesh->coords, to_coords);
  Kokkos::deep_copy(mesh->cells, to_cells);
  if (from.place.extent(0) > 0) {
    mesh->place = DeviceView<LO **>("rpc::fem::vertex_places", cells.extent(0), num_vertices);
    const auto to_places = Kokkos::create_mirror_view(mesh->place);
    for (std::size_t c = 0; c < cells.extent(0); ++c)
      for (int v = 0; v < num_vertices; ++v) to_places(c, v) = vertex_places.row[places(c, v)];
    Kokkos::deep_copy(mesh->place, to_places);
  }
  mesh->block = from.block;
  mesh->blocks = from.blocks;
  mesh->cell_id = from.cell_id;
  mesh->num_owned_cells = from.num_owned_cells;
  const HostView<GO *> vertex_id("rpc::fem::vertex_id", vertices.num_owned);
  for (LO v = 0; v < vertices.num_owned; ++v) vertex_id(v) = from.node_id(vertices.node[v]);
  mesh->node_id = vertex_id;

  for (const mesh::Side &side : from.sides)
    mesh->sides.push_back(mesh::make_side(side.name, *mesh, to_host(side.cell), to_host(side.ordinal)));
  for (const mesh::PointSet &set : from.points) {
    mesh->points.push_back({set.name, {}});
    for (const LO node : set.node)
      if (vertices.place[node] >= 0) mesh->points.back().node.push_back(vertices.place[node]);
  }

  // Each node's weights are those of any cell that has it.
  const auto weights = weights_of_vertices(from.element);
  const LO num_owned = from.num_owned_nodes();
  std::vector<std::pair<LO, int>> seen(num_owned, {-1, 0}); // a cell, and the node's place there
  for (std::size_t c = 0; c < cells.extent(0); ++c)
    for (int a = 0; a < num_nodes; ++a)
      if (cells(c, a) < num_owned && seen[cells(c, a)].first < 0) seen[cells(c, a)] = {static_cast<LO>(c), a};
  InterpolationRows rows;
  for (LO n = 0; n < num_owned; ++n) {
    const auto [cell, a] = seen[n];
    for (int v = 0; v < num_vertices && cell >= 0; ++v) rows.add(vertices.place[cells(cell, v)], weights[a][v]);
    rows.end_row();
  }
  OrderOne result;
  result.mesh = mesh;
  result.node = device_values(vertices.node, "rpc::fem::node_of_vertex");
  result.interpolation = rows.matrix(from.owned_nodes, mesh->overlap_nodes(), mesh->owned_nodes);
  return result;
}

} // namespace rpc::fem
