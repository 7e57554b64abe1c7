// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "block_mesh.hpp"
#include "parts_measures.hpp"
#include "rpc/mesh/distribute.hpp"
#include "rpc/mesh/topology.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <vector>

/// Meshes to refine, and what refined ones have in common.
namespace rpc::test
{

using Shared = std::shared_ptr<const mesh::Mesh>;

inline RCP<const Comm> world()
{
  return Tpetra::getDefaultComm();
}
/// This rank by itself: what it makes is the serial result, there to compare with.
inline RCP<const Comm> alone()
{
  static const RCP<const Comm> comm = world()->split(world()->getRank(), 0);
  return comm;
}

/// A block of 3 x 2 (x 2) cells, sheared, in two blocks, with its sides at both ends and all others, and a point.
inline mesh::MeshData sheared_block(const mesh::Element &element)
{
  const std::array<int, 3> cells{3, 2, 2};
  mesh::MeshData data = test::block(element, cells);
  const int dim = element.dim, width = element.num_nodes();
  data.blocks = {"near", "far"};
  for (int c = 0; c < data.num_cells(); ++c) data.block[c] = c % 2;
  const mesh::Entities facets = mesh::facets_of(element, data.cells);
  data.sides = {{"low", {}, {}}, {"high", {}, {}}, {"rest", {}, {}}};
  for (int f = 0; f < facets.size(); ++f) {
    if (facets.num_cells_at(f) != 1) continue;
    const auto at_x = [&](const double x) {
      return std::all_of(facets.vertices.begin() + std::ptrdiff_t(facets.num_vertices) * f,
                         facets.vertices.begin() + std::ptrdiff_t(facets.num_vertices) * (f + 1),
                         [&](const int n) { return data.coords[std::size_t(dim) * n] == x; });
    };
    auto &side = data.sides[at_x(0) ? 0 : at_x(3) ? 1 : 2];
    side.cell.push_back(facets.cell(f, 0));
    side.ordinal.push_back(facets.ordinal(f, 0));
  }
  data.points = {{"first", {data.cells[0]}}, {"last", {data.cells[std::size_t(width) * (data.num_cells() - 1)]}}};
  std::sort(data.points[1].node.begin(), data.points[1].node.end());
  for (int n = 0; n < data.num_nodes(); ++n) {
    double *const x = &data.coords[std::size_t(dim) * n];
    x[0] += 0.3 * x[1];
    if (dim == 3) x[1] -= 0.2 * x[2];
  }
  return data;
}

inline Shared dealt(const mesh::MeshData &whole, const RCP<const Comm> &comm)
{
  return std::make_shared<mesh::Mesh>(mesh::distribute(comm->getRank() == 0 ? whole : mesh::MeshData{}, comm));
}

/// Of each id the lid of a serial mesh.
inline std::vector<LO> node_lids(const mesh::Mesh &serial)
{
  std::vector<LO> lids(serial.num_local_nodes(), -1);
  for (LO n = 0; n < serial.num_local_nodes(); ++n) lids.at(serial.node_id(n)) = n;
  return lids;
}

/// A rank's part holds what the whole mesh, refined by one rank, has there, bit by bit.
inline void expect_part_of(const mesh::Mesh &serial, const mesh::Mesh &mesh)
{
  const auto coords = to_host(mesh.coords), all_coords = to_host(serial.coords);
  const auto cells = to_host(mesh.cells), all_cells = to_host(serial.cells);
  const auto ids = mesh::overlap_node_ids(mesh);
  const std::vector<LO> node_of = node_lids(serial);
  std::vector<LO> cell_of(serial.num_cells(), -1);
  for (LO c = 0; c < serial.num_cells(); ++c) cell_of.at(serial.cell_id(c)) = c;
  ASSERT_EQ(sum_all(mesh.comm(), GO(mesh.num_owned_nodes())), serial.num_owned_nodes());
  ASSERT_EQ(sum_all(mesh.comm(), GO(mesh.num_owned_cells)), serial.num_cells());
  for (LO n = 0; n < mesh.num_local_nodes(); ++n)
    for (int d = 0; d < mesh.dim(); ++d) EXPECT_EQ(coords(n, d), all_coords(node_of.at(ids(n)), d));
  for (LO c = 0; c < mesh.num_owned_cells; ++c) {
    const LO other = cell_of.at(mesh.cell_id(c));
    for (std::size_t a = 0; a < cells.extent(1); ++a) EXPECT_EQ(ids(cells(c, a)), serial.node_id(all_cells(other, a)));
    EXPECT_EQ(to_host(mesh.block)(c), to_host(serial.block)(other));
  }
  ASSERT_EQ(mesh.sides.size(), serial.sides.size());
  for (std::size_t s = 0; s < mesh.sides.size(); ++s) { // each facet of an owned cell is listed
    const auto cell = to_host(mesh.sides[s].cell);
    GO owned = 0;
    for (std::size_t f = 0; f < cell.extent(0); ++f) owned += cell(f) < mesh.num_owned_cells;
    EXPECT_EQ(sum_all(mesh.comm(), owned), GO(serial.sides[s].cell.extent(0))) << mesh.sides[s].name;
  }
}

/// All cells at an owned node are local, and there are no others.
inline void expect_cells_around_owned_nodes(const mesh::Mesh &serial, const mesh::Mesh &mesh)
{
  const auto cells = to_host(mesh.cells), all_cells = to_host(serial.cells);
  std::vector<int> around(serial.num_local_nodes(), 0), here(mesh.num_local_nodes(), 0);
  const std::vector<LO> node_of = node_lids(serial);
  for (std::size_t c = 0; c < all_cells.extent(0); ++c)
    for (std::size_t a = 0; a < all_cells.extent(1); ++a) ++around[all_cells(c, a)];
  for (LO c = 0; c < mesh.num_cells(); ++c) {
    bool touches = c < mesh.num_owned_cells;
    for (std::size_t a = 0; a < cells.extent(1); ++a) {
      ++here[cells(c, a)];
      touches = touches || cells(c, a) < mesh.num_owned_nodes();
    }
    EXPECT_TRUE(touches);
  }
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n) EXPECT_EQ(here[n], around[node_of.at(mesh.node_id(n))]);
}

/// Facets are shared by two cells, or lie on the boundary, where sides list them. @return how many of the latter; collective
inline GO expect_conforming(const mesh::Mesh &mesh)
{
  const mesh::Topology topology = mesh::topology(mesh);
  GO boundary = 0, listed = 0;
  for (int f = 0; f < topology.facets.size(); ++f) {
    EXPECT_LE(topology.facets.num_cells_at(f), 2);
    boundary += topology.owns_facet[f] && topology.on_boundary(f);
  }
  for (const mesh::Side &side : mesh.sides) {
    const auto cell = to_host(side.cell);
    for (std::size_t f = 0; f < cell.extent(0); ++f) listed += cell(f) < mesh.num_owned_cells;
  }
  boundary = sum_all(mesh.comm(), boundary);
  EXPECT_EQ(sum_all(mesh.comm(), listed), boundary);
  return boundary;
}

/// Six times the volume over the cube of the root mean square edge, over what that is of a regular tetrahedron.
inline double quality(const std::vector<std::vector<double>> &x)
{
  double squares = 0, J[3][3];
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < a; ++b)
      for (int d = 0; d < 3; ++d) squares += (x[a][d] - x[b][d]) * (x[a][d] - x[b][d]) / 6;
  for (int k = 0; k < 3; ++k)
    for (int d = 0; d < 3; ++d) J[k][d] = x[k + 1][d] - x[0][d];
  const double six_volumes = J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) -
                             J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
                             J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]);
  return std::sqrt(2.) * six_volumes / std::pow(squares, 1.5);
}

/// Of the worst tetrahedron.
inline double worst_quality(const mesh::Mesh &mesh)
{
  double least = 1;
  for (LO c = 0; c < mesh.num_cells(); ++c) least = std::min(least, quality(places(mesh, c, {0, 1, 2, 3})));
  return least;
}

/// A single tetrahedron each, on one rank: a regular one, a corner of a cube, a flat and a long one.
inline std::vector<Shared> tetrahedra()
{
  std::vector<Shared> all;
  for (const std::vector<double> &coords : {std::vector<double>{1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1},
                                            {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
                                            {0, 0, 0, 1, 0, 0, 0, 1, 0, .4, .3, .1},
                                            {0, 0, 0, 1, .1, 0, 0, 1.2, 0, .2, .3, 5}}) {
    mesh::MeshData body;
    body.element = {3, 1, mesh::Shape::simplex};
    body.coords = coords;
    body.cells = {0, 1, 2, 3};
    body.blocks = {"body"};
    body.block = {0};
    all.push_back(dealt(body, alone()));
    if (worst_quality(*all.back()) > 0) continue;
    body.cells = {0, 2, 1, 3}; // the other way round
    all.back() = dealt(body, alone());
  }
  return all;
}

/// A quarter of a disc of radius 1 on one rank, one triangle whose longest edge is an arc.
inline Shared quarter_disc(const int order)
{
  mesh::MeshData body;
  body.element = {2, order, mesh::Shape::simplex};
  body.coords = {0, 0, 1, 0, 0, 1};
  body.cells = {0, 1, 2};
  if (order == 2) {
    body.coords.insert(body.coords.end(), {.5, 0, std::sqrt(.5), std::sqrt(.5), 0, .5});
    body.cells.insert(body.cells.end(), {3, 4, 5});
  }
  body.blocks = {"body"};
  body.block = {0};
  mesh::BoundaryPart arc;
  arc.shape.kind = mesh::BoundaryShape::Kind::sphere;
  arc.shape.radius = 1;
  arc.cell = {0};
  arc.ordinal = {1};
  body.geometry = {arc};
  return dealt(body, alone());
}

/// How much the area differs from that of a quarter of a disc, relative.
inline double quarter_disc_error(const mesh::Mesh &mesh)
{
  return std::abs(body_measure(mesh) / (M_PI / 4) - 1);
}

} // namespace rpc::test
