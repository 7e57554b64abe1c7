// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/elasticity.hpp"

#include <algorithm>

namespace congruent_cells_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

constexpr fem::Material steel{2000, 0.3}, rubber{50, 0.45}; // the second one projects its dilatation

/// Narrower cells from the third plane of nodes on, in x.
Deformation graded(const mesh::BoxOptions &box)
{
  const double bend = box.lower[0] + 2 * (box.upper[0] - box.lower[0]) / box.cells[0];
  return [bend](const Point &x) { return Point{x[0] > bend ? bend + 0.3 * (x[0] - bend) : x[0], x[1], x[2]}; };
}

/// The same cells, each by itself.
fem::Discretization without_shapes(fem::Discretization d)
{
  d.congruent = {};
  return d;
}

/// Boxes of one kind of cells, and of two.
std::vector<fem::Discretization> repetitive_bodies(const mesh::Element &element, const RCP<const Comm> &comm)
{
  const auto box = small_box(element);
  return {body(box, comm), body(box, comm, graded(box))};
}

fem::Materials in_blocks(const fem::Discretization &d)
{
  fem::Materials materials(steel);
  if (d.mesh->blocks.size() > 1) materials.block[d.mesh->blocks[1]] = rubber;
  return materials;
}

/// Cells in two blocks, in no order, but the same ones on any number of ranks.
fem::Discretization in_two_blocks(const fem::Discretization &whole)
{
  auto mesh = std::make_shared<mesh::Mesh>(*whole.mesh);
  mesh->blocks = {"one", "other"};
  mesh->block = DeviceView<int *>("block", mesh->num_cells());
  const auto block = Kokkos::create_mirror_view(mesh->block);
  const auto cells = to_host(mesh->cells);
  const double x0 = small_box(mesh->element).lower[0];
  for (LO c = 0; c < mesh->num_cells(); ++c) {
    double x = 0; // of the vertices, for ranks have cells in common
    for (int a = 0; a < mesh->element.num_vertices(); ++a) x += point_of(whole, cells(c, a))[0] - x0;
    block(c) = static_cast<int>(100 * x) % 2;
  }
  Kokkos::deep_copy(mesh->block, block);
  return fem::discretize(mesh);
}

TEST(CongruentCells, OfABoxAreOneToAPartOfItsLattice)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, alone());
    ASSERT_EQ(d.congruent.size(), parts_of_cell(element));
    const auto of_cell = to_host(d.congruent.of_cell);
    for (LO cell = 0; cell < d.mesh->num_cells(); ++cell) EXPECT_EQ(of_cell(cell), cell % parts_of_cell(element));
    EXPECT_EQ(body(box, alone(), graded(box)).congruent.size(), 2 * parts_of_cell(element));
  }
}

TEST(CongruentCells, OfManyCellsOfABoxAreFoundDespiteTheRoundingOfCoordinates)
{
  EXPECT_EQ(body({{0, 0}, {5, 1}, {321, 67}, {2, 1}}, world()).congruent.size(), 1);
  EXPECT_EQ(body({{-1. / 3, 7. / 9}, {5. / 7, 1}, {333, 33}, {2, 2}}, world()).congruent.size(), 1);
}

TEST(CongruentCells, AreNoneWhereCellsDifferOrCoordinatesHideIt)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    auto box = small_box(element);
    EXPECT_EQ(bulged_body(element, alone()).congruent.size(), 0);
    for (double &x : box.lower) x += 1e7;
    for (double &x : box.upper) x += 1e7;
    EXPECT_EQ(body(box, alone()).congruent.size(), 0);
  }
}

TEST(CongruentCells, SeeADisplacedNodeAboveRounding)
{
  const mesh::BoxOptions box{{0, 0}, {4, 2}, {16, 8}, {2, 1}};
  const auto moved = [&](const double by) {
    return body(box, alone(),
                [by](const Point &x) {
                  return x[0] == 2 && x[1] == 1 ? Point{x[0] + by, x[1], x[2]} : x;
                })
        .congruent.size();
  };
  EXPECT_EQ(moved(1e-15), 1);
  EXPECT_EQ(moved(1e-12), 0);
}

/// The cell by which a rank computes all cells of a kind is that of rank 0, to the last digit, wherever its own cells lie.
TEST(CongruentCells, HaveTheSameShapeOnAllRanks)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    auto box = small_box(element);
    for (double &x : box.upper) x += 0.1; // edges that no rank has without rounding
    const auto d = body(box, world());
    const auto coords = to_host(d.congruent.coords);
    std::vector<double> mine;
    for (std::size_t k = 0; k < coords.extent(0); ++k)
      for (std::size_t i = 0; i < coords.extent(1); ++i) mine.push_back(coords(k, i));
    const auto all = gathered_by_all(d.mesh->comm(), mine);
    const auto size = static_cast<std::ptrdiff_t>(d.dim() * element.num_nodes());
    for (auto kind = mine.begin(); kind < mine.end(); kind += size) {
      auto first = all.begin(); // rank 0's
      while (first < all.end() && !std::equal(kind, kind + size, first)) first += size;
      EXPECT_LT(first - all.begin(), parts_of_cell(element) * size);
    }
  }
}

/// Far from 0, where the rounding of coordinates is felt.
TEST(CongruentCells, GiveTheSameStiffnessOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    auto box = small_box(element);
    for (double &x : box.lower) x += 1e3;
    for (double &x : box.upper) x += 1e3;
    const auto local = [](const Point &x) { return wild({x[0] - 1e3, x[1] - 1e3, x[2] - 1e3}); };
    for (const auto &material : {steel, rubber}) {
      const auto product = [&](const RCP<const Comm> &comm) {
        const auto d = body(box, comm);
        EXPECT_GT(d.congruent.size(), 0);
        Vector result(d.owned_dofs);
        fem::assemble_stiffness(d, material)->apply(*interpolate(d, local), result);
        return by_node_id(d, result);
      };
      EXPECT_LT(difference(product(world()), product(alone())), 1e-14);
    }
  }
}

TEST(CongruentCells, GiveTheStiffnessOfEachCellByItself)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    for (const auto &whole : repetitive_bodies(element, world())) {
      for (const auto &d : {whole, in_two_blocks(whole)}) {
        ASSERT_GT(d.congruent.size(), 0);
        const auto product = [&](const fem::Discretization &of) {
          Vector result(of.owned_dofs);
          fem::assemble_stiffness(of, in_blocks(of))->apply(*interpolate(of, wild), result);
          return by_node_id(of, result);
        };
        EXPECT_LT(difference(product(d), product(without_shapes(d))), 10 * rounding_of(element));
      }
    }
    for (const auto &d : repetitive_bodies(element, alone()))
      EXPECT_LT(asymmetry(dense(*fem::assemble_stiffness(d, rubber))), 1e-14);
  }
}

TEST(CongruentCells, DoNotAddUpTheirRounding)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    for (const auto &material : {steel, rubber}) {
      for (const auto &d : repetitive_bodies(element, alone())) {
        for (const auto &row : dense(*fem::assemble_stiffness(d, material))) {
          std::vector<long double> sum(d.dim(), 0);
          for (std::size_t c = 0; c < row.size(); ++c) sum[c % d.dim()] += row[c];
          for (const long double along : sum) EXPECT_EQ(along, 0); // of a translation
        }
      }
    }
  }
}

TEST(CongruentCells, GiveTheInternalWorkOfEachCellByItself)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    for (const auto &whole : repetitive_bodies(element, world())) {
      for (const auto &d : {whole, in_two_blocks(whole)}) {
        const auto u = interpolate(d, wild);
        const auto work = fem::internal_work(d, in_blocks(d), *u),
                   expected = fem::internal_work(without_shapes(d), in_blocks(d), *u);
        EXPECT_LT(difference(by_node_id(d, *work.forces), by_node_id(d, *expected.forces)), 1e-14);
        EXPECT_NEAR(work.force_norm, expected.force_norm, 1e-14 * expected.force_norm);
        EXPECT_NEAR(work.energy_norm_squared, expected.energy_norm_squared, 1e-14 * expected.energy_norm_squared);
      }
    }
  }
}

} // namespace
} // namespace congruent_cells_test
