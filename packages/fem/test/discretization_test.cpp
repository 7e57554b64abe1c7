// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/discretization.hpp"

#include "bodies.hpp"

#include <algorithm>
#include <set>

namespace discretization_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// Places of a part's nodes in a cell of the lattice, in any order. The second triangle is the first turned by 180 degrees; each
/// tetrahedron has the places whose coordinates are ordered in one way.
std::vector<std::vector<int>> places_in_cell(const mesh::Element &element, const int part)
{
  auto places = element.lattice();
  if (element.shape == mesh::Shape::tensor || (element.dim == 2 && part == 0)) return places;
  if (element.dim == 2) {
    for (auto &place : places)
      for (int &step : place) step = element.order - step;
    return places;
  }
  std::vector<int> order{0, 1, 2};
  for (int k = 0; k < part; ++k) std::next_permutation(order.begin(), order.end());
  places.clear();
  const int n = element.order + 1;
  for (int k = 0; k < n * n * n; ++k) {
    const std::vector<int> place{k % n, k / n % n, k / n / n};
    if (place[order[0]] >= place[order[1]] && place[order[1]] >= place[order[2]]) places.push_back(place);
  }
  return places;
}

/// Ids of the nodes that share a cell with each node of a box, by its lattice alone.
std::vector<std::set<GO>> adjacency(const mesh::BoxOptions &box)
{
  const int dim = box.element.dim, order = box.element.order;
  std::array<GO, 3> nodes{1, 1, 1}, cells{1, 1, 1};
  for (int d = 0; d < dim; ++d) {
    cells[d] = box.cells[d];
    nodes[d] = order * cells[d] + 1;
  }
  std::vector<std::set<GO>> adjacent(nodes[0] * nodes[1] * nodes[2]);
  const int parts = parts_of_cell(box.element);
  for (GO part = 0; part < parts * cells[0] * cells[1] * cells[2]; ++part) {
    const GO cell = part / parts;
    const std::array<GO, 3> corner{cell % cells[0], cell / cells[0] % cells[1], cell / cells[0] / cells[1]};
    std::set<GO> of_cell;
    for (const auto &step : places_in_cell(box.element, static_cast<int>(part % parts))) {
      std::array<GO, 3> at{};
      for (int d = 0; d < dim; ++d) at[d] = order * corner[d] + step[d];
      of_cell.insert(at[0] + nodes[0] * (at[1] + nodes[1] * at[2]));
    }
    for (const GO node : of_cell) adjacent[node].insert(of_cell.begin(), of_cell.end());
  }
  return adjacent;
}

TEST(Discretization, GraphJoinsAllUnknownsOfNodesThatShareACellAndNoOthers)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, world());
    const auto adjacent = adjacency(box);
    const auto ids = overlap_node_ids(*d.mesh);
    const auto pattern = fem::dof_graph(d);
    const auto graph = pattern->getLocalGraphHost();
    ASSERT_TRUE(pattern->isFillComplete());
    ASSERT_EQ(static_cast<LO>(graph.numRows()), d.dim() * d.mesh->num_owned_nodes());
    for (LO row = 0; row < static_cast<LO>(graph.numRows()); ++row) {
      std::set<GO> expected, found; // unknown c of node id
      for (const GO node : adjacent[d.mesh->node_id(row / d.dim())])
        for (int c = 0; c < d.dim(); ++c) expected.insert(d.dim() * node + c);
      for (auto k = graph.row_map(row); k < graph.row_map(row + 1); ++k) {
        const LO col = graph.entries(k);
        found.insert(d.dim() * ids[col / d.dim()] + col % d.dim());
        if (k > graph.row_map(row)) {
          EXPECT_LT(graph.entries(k - 1), col); // ascending
        }
      }
      EXPECT_EQ(found, expected) << "row " << row;
      EXPECT_EQ(graph.row_map(row + 1) - graph.row_map(row), expected.size());
    }
  }
}

TEST(Discretization, NodeGraphIsTheGraphOncePerNode)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, world());
    const auto adjacent = adjacency(box);
    const auto ids = overlap_node_ids(*d.mesh);
    const auto row = to_host(d.nodes().row);
    const auto col = to_host(d.nodes().col);
    ASSERT_EQ(static_cast<LO>(row.extent(0)), d.mesh->num_owned_nodes() + 1);
    EXPECT_EQ(row(d.mesh->num_owned_nodes()), col.extent(0));
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
      std::set<GO> found;
      for (auto k = row(n); k < row(n + 1); ++k) found.insert(ids[col(k)]);
      EXPECT_EQ(found, adjacent[d.mesh->node_id(n)]);
      EXPECT_TRUE(std::is_sorted(&col(row(n)), &col(row(n)) + (row(n + 1) - row(n))));
    }
  }
}

TEST(Discretization, UnknownsAreNumberedByNodeInEveryMap)
{
  for (const auto &element : elements()) {
    const auto d = body(small_box(element), world());
    const auto expect_numbered = [&](const Map &nodes, const Map &dofs) {
      ASSERT_EQ(num_local(dofs), d.dim() * num_local(nodes));
      for (LO dof = 0; dof < num_local(dofs); ++dof)
        EXPECT_EQ(dofs.getGlobalElement(dof), d.dim() * nodes.getGlobalElement(dof / d.dim()) + dof % d.dim());
    };
    expect_numbered(*d.mesh->owned_nodes, *d.owned_dofs);
    expect_numbered(*d.mesh->overlap_nodes(), *fem::overlap_dofs(d));
    const auto graph = fem::dof_graph(d);
    EXPECT_TRUE(graph->getColMap()->isSameAs(*fem::overlap_dofs(d)));
    EXPECT_TRUE(graph->getRowMap()->isSameAs(*d.owned_dofs));
  }
}

TEST(Discretization, ImportBringsOwnedValuesToTheGhosts)
{
  for (const auto &element : elements()) {
    const auto d = body(small_box(element), world());
    const auto owned = interpolate(d, wild);
    const auto overlap = fem::on_overlap(d, *owned);
    const auto values = overlap->getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LO n = 0; n < d.mesh->num_local_nodes(); ++n)
      for (int c = 0; c < d.dim(); ++c) EXPECT_NEAR(values(d.dim() * n + c, 0), wild(point_of(d, n))[c], 1e-13);
  }
}

TEST(NodeCoordinates, AreThoseOfTheMesh)
{
  const auto d = bulged_body({2, 2}, world());
  const auto coords = fem::node_coordinates(d);
  const auto values = coords->getLocalViewHost(Tpetra::Access::ReadOnly);
  ASSERT_EQ(values.extent(1), 2u);
  for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n)
    for (int c = 0; c < 2; ++c) EXPECT_EQ(values(n, c), point_of(d, n)[c]);
}

TEST(RigidBodyModes, AreZeroAtNoNode)
{
  for (const int dim : {2, 3}) { // the middle node lies at the centroid, in space others lie on lines through it
    mesh::BoxOptions box;
    box.lower.assign(dim, 0.);
    box.upper.assign(dim, 1.);
    box.cells.assign(dim, 4);
    box.element = {dim, 1};
    const auto d = fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(box, world())), {});
    const auto modes = fem::rigid_body_modes(d);
    const auto values = modes->getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n)
      for (std::size_t mode = 0; mode < modes->getNumVectors(); ++mode) {
        double most = 0;
        for (int c = 0; c < dim; ++c) most = std::max(most, std::abs(values(dof(dim, n, c), mode)));
        EXPECT_GT(most, 1e-4) << "mode " << mode;
      }
  }
}

TEST(RigidBodyModes, AreTranslationsAndRotationsAboutTheCentroid)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto d = bulged_body(element, world());
    const int dim = d.dim();
    const auto modes = fem::rigid_body_modes(d);
    ASSERT_EQ(modes->getNumVectors(), dim == 2 ? 3u : 6u);
    Point centre{};
    const auto points = by_node_id(*d.mesh, dim, [&](const LO n, const int c) { return point_of(d, n)[c]; });
    for (std::size_t k = 0; k < points.size(); ++k) centre[k % dim] += points[k] * dim / points.size();
    const auto values = modes->getLocalViewHost(Tpetra::Access::ReadOnly);
    const int planes[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n) {
      const Point x = point_of(d, n);
      for (int mode = 0; mode < static_cast<int>(modes->getNumVectors()); ++mode) {
        Point expected{};
        if (mode < dim) {
          expected[mode] = 1;
        } else {
          const auto &[i, j] = planes[mode - dim];
          expected[i] = -(x[j] - centre[j]);
          expected[j] = x[i] - centre[i];
        }
        for (int c = 0; c < dim; ++c) EXPECT_NEAR(values(dim * n + c, mode), expected[c], 1e-14 * 8);
      }
    }
  }
}

} // namespace
} // namespace discretization_test
