// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/contracted.hpp"

#include "measures.hpp"
#include "refined_meshes.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <random>

namespace contracted_test
{
namespace
{

using rpc::LO;
using rpc::mesh::contracted;
using rpc::mesh::distribute_with_contracted;
using rpc::mesh::Element;
using rpc::mesh::Mesh;
using rpc::mesh::MeshData;
using rpc::mesh::Shape;
using rpc::test::alone;
using rpc::test::world;

using Point = std::array<double, 3>;

const Element p1{2, 1, Shape::simplex}, p2{2, 2, Shape::simplex}, p1_in_space{3, 1, Shape::simplex},
    p2_in_space{3, 2, Shape::simplex};

Point point_of(const MeshData &mesh, const int node)
{
  Point x{};
  for (int d = 0; d < mesh.element.dim; ++d) x[d] = mesh.coords[std::size_t(mesh.element.dim) * node + d];
  return x;
}

MeshData moved(MeshData mesh, const std::function<Point(const Point &)> &to)
{
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    const Point x = to(point_of(mesh, n));
    std::copy_n(x.begin(), mesh.element.dim, &mesh.coords[std::size_t(mesh.element.dim) * n]);
  }
  return mesh;
}

/// A block of so many cells in each direction, cut into simplices, with its sides at x = 0 and at the upper end of the last direction, the rest of
/// its boundary, and its two halves as blocks.
MeshData block_with_sides(const Element &element, const std::array<int, 3> &cells)
{
  MeshData mesh = rpc::test::block(element, cells);
  const int width = element.num_nodes(), last = element.dim - 1;
  mesh.blocks = {"left", "right"};
  for (int c = 0; c < mesh.num_cells(); ++c) {
    double centre = 0;
    for (int v = 0; v < element.num_vertices(); ++v)
      centre += point_of(mesh, mesh.cells[std::size_t(width) * c + v])[0] / element.num_vertices();
    mesh.block[c] = centre > cells[0] / 2 ? 1 : 0;
  }
  mesh.sides = {{"low", {}, {}}, {"top", {}, {}}, {"rest", {}, {}}};
  const auto facets = rpc::mesh::facets_of(element, mesh.cells);
  for (int f = 0; f < facets.size(); ++f) {
    if (facets.num_cells_at(f) != 1) continue;
    const auto lies_at = [&](const int d, const double at) {
      const auto first = facets.vertices.begin() + std::ptrdiff_t(facets.num_vertices) * f;
      return std::all_of(first, first + facets.num_vertices, [&](const int n) { return point_of(mesh, n)[d] == at; });
    };
    auto &side = mesh.sides[lies_at(0, 0) ? 0 : lies_at(last, cells[last]) ? 1 : 2];
    side.cell.push_back(facets.cell(f, 0));
    side.ordinal.push_back(facets.ordinal(f, 0));
  }
  return mesh;
}

double measure(const MeshData &mesh)
{
  return rpc::test::body_measure(rpc::mesh::distribute(mesh, alone()));
}
double measure(const MeshData &mesh, const std::string &side)
{
  return rpc::test::side_measure(rpc::mesh::distribute(mesh, alone()), side);
}
std::vector<int> cells_in_blocks(const MeshData &mesh)
{
  std::vector<int> count(mesh.blocks.size(), 0);
  for (const int block : mesh.block) ++count[block];
  return count;
}

/// Nodes of order 1, or vertices.
int num_vertices(const MeshData &mesh)
{
  std::vector<char> is_vertex(mesh.num_nodes(), 0);
  const int width = mesh.element.num_nodes();
  for (int c = 0; c < mesh.num_cells(); ++c)
    for (int v = 0; v < mesh.element.num_vertices(); ++v) is_vertex[mesh.cells[std::size_t(width) * c + v]] = 1;
  return static_cast<int>(std::count(is_vertex.begin(), is_vertex.end(), 1));
}

/// Twice that many cells in each direction have 4 or 8 times the nodes; contraction leaves some more of them.
void expect_coarser(const MeshData &fine, const double least_ratio)
{
  const auto coarse = contracted(fine);
  ASSERT_TRUE(coarse) << fine.element.name();
  EXPECT_EQ(coarse->element.order, 1);
  EXPECT_LT(coarse->num_nodes() * least_ratio, num_vertices(fine)) << fine.element.name();
  EXPECT_NEAR(measure(*coarse), measure(fine), 1e-12 * measure(fine)); // of a flat boundary; and no cell is inverted
  for (const char *const side : {"low", "top", "rest"})
    EXPECT_NEAR(measure(*coarse, side), measure(fine, side), 1e-12 * measure(fine, side)) << side;
  ASSERT_EQ(coarse->blocks, fine.blocks);
  for (const int count : cells_in_blocks(*coarse)) EXPECT_GT(count, 0);
  for (int n = 0; n < coarse->num_nodes(); ++n) { // each is one of the finer mesh
    bool found = false;
    for (int m = 0; m < fine.num_nodes() && !found; ++m) found = point_of(fine, m) == point_of(*coarse, n);
    EXPECT_TRUE(found);
  }
}

TEST(Contracted, BlocksKeepBodySidesAndBlocks)
{
  expect_coarser(block_with_sides(p1, {24, 12, 1}), 3);
  expect_coarser(block_with_sides(p2, {24, 12, 1}), 3);
  expect_coarser(block_with_sides(p1_in_space, {12, 8, 8}), 4);
  expect_coarser(block_with_sides(p2_in_space, {12, 8, 8}), 4);
}

TEST(Contracted, NodesMayLieAnywhereInside)
{
  for (const Element &element : {p1, p1_in_space}) {
    const std::array<int, 3> cells{12, 10, element.dim == 3 ? 8 : 1};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> by(-0.2, 0.2);
    const MeshData mesh = moved(block_with_sides(element, cells), [&](Point x) {
      for (int d = 0; d < element.dim; ++d)
        if (x[d] == 0 || x[d] == cells[d] || x[0] == cells[0] / 2) return x;
      for (int d = 0; d < element.dim; ++d) x[d] += by(random);
      return x;
    });
    expect_coarser(mesh, element.dim == 2 ? 2.5 : 3.5);
  }
}

TEST(Contracted, BlocksMeetWhereTheyDid)
{
  const MeshData fine = block_with_sides(p1_in_space, {8, 6, 6});
  const auto coarse = contracted(fine);
  ASSERT_TRUE(coarse);
  const int width = coarse->element.num_nodes();
  for (int c = 0; c < coarse->num_cells(); ++c)
    for (int a = 0; a < width; ++a) {
      const double x = point_of(*coarse, coarse->cells[std::size_t(width) * c + a])[0];
      EXPECT_TRUE(coarse->block[c] == 0 ? x <= 4 : x >= 4);
    }
}

TEST(Contracted, NamedPointsStay)
{
  MeshData fine = block_with_sides(p1, {16, 16, 1});
  std::vector<int> named;
  for (int n = 0; n < fine.num_nodes(); n += 37) named.push_back(n);
  fine.points = {{"some", named}};
  const auto coarse = contracted(fine);
  ASSERT_TRUE(coarse);
  ASSERT_EQ(coarse->points.size(), 1U);
  ASSERT_EQ(coarse->points[0].node.size(), named.size());
  for (std::size_t k = 0; k < named.size(); ++k)
    EXPECT_EQ(point_of(*coarse, coarse->points[0].node[k]), point_of(fine, named[k]));
}

TEST(Contracted, CurvedBoundariesAndHolesKeepTheirShape)
{
  for (const Element &element : {p1, p1_in_space}) {
    const std::array<int, 3> cells{10, 40, element.dim == 3 ? 6 : 1};
    const MeshData ring = moved(block_with_sides(element, cells), [&](const Point &x) { // three quarters
      const double angle = 1.5 * M_PI * x[1] / cells[1], r = 1 + x[0] / cells[0];
      return Point{r * std::cos(angle), r * std::sin(angle), x[2] / cells[0]};
    });
    const auto coarse = contracted(ring);
    ASSERT_TRUE(coarse);
    EXPECT_NEAR(measure(*coarse), measure(ring), 0.02 * measure(ring));
    for (const char *const side : {"low", "rest"})
      EXPECT_NEAR(measure(*coarse, side), measure(ring, side), 0.02 * measure(ring, side));
  }
}

TEST(Contracted, OtherMeshesHaveNoCoarserOnes)
{
  EXPECT_FALSE(contracted(rpc::test::block({2, 1, Shape::tensor}, {8, 8, 1})));
  EXPECT_FALSE(contracted(rpc::test::block(p1_in_space, {1, 1, 1}))); // corners alone
  MeshData middles = block_with_sides(p2, {8, 8, 1});                 // a middle node has a name
  middles.points = {{"middle", {middles.cells[5]}}};
  EXPECT_FALSE(contracted(middles));
}

/// The same mesh with its nodes and cells in no order.
MeshData shuffled(const MeshData &mesh)
{
  std::mt19937 random(3);
  const int dim = mesh.element.dim, width = mesh.element.num_nodes();
  std::vector<int> node(mesh.num_nodes()), cell(mesh.num_cells()); // where each goes
  for (auto *const to : {&node, &cell}) {
    std::iota(to->begin(), to->end(), 0);
    std::shuffle(to->begin(), to->end(), random);
  }
  MeshData result = mesh;
  for (int n = 0; n < mesh.num_nodes(); ++n)
    std::copy_n(&mesh.coords[std::size_t(dim) * n], dim, &result.coords[std::size_t(dim) * node[n]]);
  for (int c = 0; c < mesh.num_cells(); ++c) {
    for (int a = 0; a < width; ++a)
      result.cells[std::size_t(width) * cell[c] + a] = node[mesh.cells[std::size_t(width) * c + a]];
    result.block[cell[c]] = mesh.block[c];
  }
  for (auto &side : result.sides)
    for (int &c : side.cell) c = cell[c];
  for (auto &points : result.points) {
    for (int &n : points.node) n = node[n];
    std::sort(points.node.begin(), points.node.end());
  }
  return result;
}

/// Distances between numbers of nodes that share a cell, on one rank: what a product with a matrix jumps over.
double mean_jump(const Mesh &mesh)
{
  const auto cells = rpc::to_host(mesh.cells);
  double sum = 0;
  for (std::size_t c = 0; c < cells.extent(0); ++c)
    for (std::size_t a = 1; a < cells.extent(1); ++a) sum += std::abs(cells(c, a) - cells(c, 0));
  return sum / static_cast<double>(cells.extent(0) * (cells.extent(1) - 1));
}

TEST(Contracted, FilesInNoOrderKeepTheirNumbers)
{
  for (const Element &element : {p1, p2, p1_in_space, p2_in_space})
    for (const bool lattice : {true, false}) {
      const std::array<int, 3> cells = element.dim == 3 ? std::array<int, 3>{12, 9, 8} : std::array<int, 3>{40, 24, 1};
      MeshData whole = block_with_sides(element, cells);
      if (!lattice)
        whole = moved(whole, [](const Point &x) { return Point{x[0] + 0.1 * x[1], x[1], x[2] - 0.1 * x[0]}; });
      whole.points = {{"some", {3, 5, 8}}};
      if (element.order == 2) whole.points.clear();
      const auto in_order = distribute_with_contracted(whole, alone());
      const MeshData file = shuffled(whole);
      const auto mesh = distribute_with_contracted(file, alone());
      ASSERT_TRUE(mesh->parents) << element.name();
      const auto x = rpc::to_host(mesh->coords);
      for (LO n = 0; n < mesh->num_owned_nodes(); ++n)
        for (int d = 0; d < element.dim; ++d) ASSERT_EQ(x(n, d), point_of(file, static_cast<int>(mesh->node_id(n)))[d]);
      const auto nodes = rpc::to_host(mesh->cells);
      const auto block = rpc::to_host(mesh->block);
      const int width = element.num_nodes();
      for (LO c = 0; c < mesh->num_cells(); ++c) {
        const int id = static_cast<int>(mesh->cell_id(c));
        ASSERT_EQ(block(c), file.block[id]);
        for (int a = 0; a < width; ++a) ASSERT_EQ(mesh->node_id(nodes(c, a)), file.cells[std::size_t(width) * id + a]);
      }
      for (std::size_t s = 0; s < file.sides.size(); ++s) {
        const auto cell = rpc::to_host(mesh->sides[s].cell);
        ASSERT_EQ(cell.extent(0), file.sides[s].cell.size());
        for (std::size_t f = 0; f < cell.extent(0); ++f) ASSERT_EQ(mesh->cell_id(cell(f)), file.sides[s].cell[f]);
      }
      for (std::size_t s = 0; s < file.points.size(); ++s) {
        std::vector<int> ids;
        for (const LO n : mesh->points[s].node) ids.push_back(static_cast<int>(mesh->node_id(n)));
        std::sort(ids.begin(), ids.end());
        EXPECT_EQ(ids, file.points[s].node);
      }
      EXPECT_LE(mean_jump(*mesh), 1.2 * mean_jump(*in_order)) << element.name();
    }
}

TEST(Contracted, RanksHaveTheSameMeshes)
{
  for (const Element &element : {p1, p2, p1_in_space, p2_in_space}) {
    const MeshData whole =
        block_with_sides(element, element.dim == 3 ? std::array<int, 3>{12, 9, 8} : std::array<int, 3>{40, 24, 1});
    const auto serial = distribute_with_contracted(whole, alone());
    const auto mesh = distribute_with_contracted(world()->getRank() == 0 ? whole : MeshData{}, world());
    ASSERT_TRUE(serial->parents && mesh->parents) << element.name();
    const Mesh *fine = mesh.get(), *of_one = serial.get();
    for (;; fine = fine->parents->mesh.get(), of_one = of_one->parents->mesh.get()) {
      EXPECT_TRUE(fine->element == element);
      rpc::test::expect_part_of(*of_one, *fine);
      rpc::test::expect_cells_around_owned_nodes(*of_one, *fine);
      ASSERT_EQ(bool(fine->parents), bool(of_one->parents)); // ranks have the same number of meshes
      if (!fine->parents) break;
      EXPECT_FALSE(fine->parents->nested);
      EXPECT_LT(2 * fine->parents->mesh->owned_nodes->getGlobalNumElements(),
                fine->owned_nodes->getGlobalNumElements());
    }
  }
}

} // namespace
} // namespace contracted_test
