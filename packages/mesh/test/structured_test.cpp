// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/structured.hpp"

#include "measures.hpp"
#include "refined_meshes.hpp"
#include "rpc/mesh/refinement.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <random>

namespace structured_test
{
namespace
{

using rpc::GO;
using rpc::LO;
using rpc::mesh::CoarserMesh;
using rpc::mesh::distribute_with_parents;
using rpc::mesh::Element;
using rpc::mesh::layered;
using rpc::mesh::Mesh;
using rpc::mesh::MeshData;
using rpc::mesh::Shape;
using rpc::test::world;

using Point = std::array<double, 3>;
using Where = std::function<bool(const Point &)>;

const Element q1{2, 1, Shape::tensor}, q2{2, 2, Shape::tensor}, q1_in_space{3, 1, Shape::tensor},
    q2_in_space{3, 2, Shape::tensor};

Point point_of(const MeshData &mesh, const int node)
{
  Point x{};
  for (int d = 0; d < mesh.element.dim; ++d) x[d] = mesh.coords[std::size_t(mesh.element.dim) * node + d];
  return x;
}

/// The boundary's facets all of whose nodes are somewhere.
void add_side(MeshData &mesh, const std::string &name, const Where &where)
{
  rpc::mesh::SideData side{name, {}, {}};
  const auto facets = rpc::mesh::facets_of(mesh.element, mesh.cells);
  for (int f = 0; f < facets.size(); ++f) {
    const int *const first = &facets.vertices[std::size_t(facets.num_vertices) * f];
    if (facets.num_cells_at(f) != 1 ||
        !std::all_of(first, first + facets.num_vertices, [&](const int n) { return where(point_of(mesh, n)); }))
      continue;
    side.cell.push_back(facets.cell(f, 0));
    side.ordinal.push_back(facets.ordinal(f, 0));
  }
  mesh.sides.push_back(side);
}

void add_point(MeshData &mesh, const std::string &name, const Point &at)
{
  mesh.points.push_back({name, {}});
  for (int n = 0; n < mesh.num_nodes(); ++n)
    if (point_of(mesh, n) == at) mesh.points.back().node.push_back(n);
}

/// Without the cells whose lowest corner is somewhere, and their nodes.
MeshData without(const MeshData &whole, const Where &where)
{
  MeshData part = whole;
  part.coords.clear();
  part.cells.clear();
  part.block.clear();
  std::map<int, int> number;
  const int dim = whole.element.dim, width = whole.element.num_nodes();
  for (int c = 0; c < whole.num_cells(); ++c) {
    if (where(point_of(whole, whole.cells[std::size_t(width) * c]))) continue;
    part.block.push_back(whole.block[c]);
    for (int a = 0; a < width; ++a) {
      const int node = whole.cells[std::size_t(width) * c + a];
      const auto [entry, is_new] = number.emplace(node, static_cast<int>(number.size()));
      for (int d = 0; d < dim && is_new; ++d) part.coords.push_back(whole.coords[std::size_t(dim) * node + d]);
      part.cells.push_back(entry->second);
    }
  }
  return part;
}

/// Nodes and cells in another order, each cell turned in one of the ways in which it fits itself.
MeshData shuffled(const MeshData &mesh)
{
  std::mt19937 random(7);
  const Element &element = mesh.element;
  const int dim = element.dim, width = element.num_nodes();
  std::vector<std::vector<int>> turns; // local nodes
  std::vector<int> axes(dim);
  std::iota(axes.begin(), axes.end(), 0);
  do
    for (int signs = 0; signs < 1 << dim; ++signs) {
      int odd = 0; // number of exchanged axes and turned ones
      for (int d = 0; d < dim; ++d) {
        odd += signs >> d & 1;
        for (int e = 0; e < d; ++e) odd += axes[e] > axes[d];
      }
      if (odd % 2) continue; // a reflection
      turns.emplace_back();
      for (const auto &place : element.lattice()) {
        std::vector<int> turned(dim);
        for (int d = 0; d < dim; ++d) turned[d] = signs >> d & 1 ? element.order - place[axes[d]] : place[axes[d]];
        turns.back().push_back(static_cast<int>(std::find(element.lattice().begin(), element.lattice().end(), turned) -
                                                element.lattice().begin()));
      }
    }
  while (std::next_permutation(axes.begin(), axes.end()));
  EXPECT_EQ(turns.size(), dim == 2 ? 4u : 24u);
  std::vector<int> node(mesh.num_nodes()), cell(mesh.num_cells());
  std::iota(node.begin(), node.end(), 0);
  std::iota(cell.begin(), cell.end(), 0);
  std::shuffle(node.begin(), node.end(), random);
  std::shuffle(cell.begin(), cell.end(), random);
  MeshData result;
  result.element = element;
  result.blocks = mesh.blocks;
  result.coords.resize(mesh.coords.size());
  for (int n = 0; n < mesh.num_nodes(); ++n)
    for (int d = 0; d < dim; ++d) result.coords[std::size_t(dim) * node[n] + d] = mesh.coords[std::size_t(dim) * n + d];
  for (const int c : cell) {
    result.block.push_back(mesh.block[c]);
    for (const int a : turns[random() % turns.size()])
      result.cells.push_back(node[mesh.cells[std::size_t(width) * c + a]]);
  }
  return result;
}

/// Moves all nodes by a map.
MeshData moved(MeshData mesh, const std::function<Point(Point)> &map)
{
  for (int n = 0; n < mesh.num_nodes(); ++n) {
    const Point x = map(point_of(mesh, n));
    for (int d = 0; d < mesh.element.dim; ++d) mesh.coords[std::size_t(mesh.element.dim) * n + d] = x[d];
  }
  return mesh;
}

/// x, y and z of the finer mesh's nodes are what the coarser mesh's functions say: children lie in their parents as told, from every cell alike.
void expect_nested(const MeshData &fine, const CoarserMesh &coarser, const double tolerance = 1e-12)
{
  const MeshData &coarse = coarser.mesh;
  const int dim = fine.element.dim, width = fine.element.num_nodes();
  const auto weights = rpc::mesh::child_weights(coarse.element, fine.element, coarser.vertices);
  for (int c = 0; c < fine.num_cells(); ++c) {
    EXPECT_EQ(fine.block[c], coarse.block[coarser.parent[c]]);
    for (int a = 0; a < width; ++a)
      for (int d = 0; d < dim; ++d) {
        double x = 0;
        for (int b = 0; b < width; ++b)
          x += weights[coarser.kind[c]][a][b] *
               coarse.coords[std::size_t(dim) * coarse.cells[std::size_t(width) * coarser.parent[c] + b] + d];
        EXPECT_NEAR(x, fine.coords[std::size_t(dim) * fine.cells[std::size_t(width) * c + a] + d], tolerance);
      }
  }
}

/// @return numbers of cells from the finest mesh on
std::vector<int> chain(MeshData mesh, const double tolerance = 1e-12)
{
  std::vector<int> cells{mesh.num_cells()};
  for (;;) {
    auto found = layered(mesh);
    if (!found.coarser) return cells;
    expect_nested(mesh, *found.coarser, tolerance);
    std::sort(found.order.begin(), found.order.end());
    for (int n = 0; n < mesh.num_nodes(); ++n) EXPECT_EQ(found.order[n], n);
    mesh = found.coarser->mesh;
    cells.push_back(mesh.num_cells());
  }
}

Point sheared(const Point &x)
{
  return {x[0] + 0.3 * x[1], x[1] - 0.2 * x[2], x[2]};
}

TEST(Structured, BlocksOfAnyNumberingAreHalvedInAllDirections)
{
  for (const Element &element : {q1, q2})
    EXPECT_EQ(chain(shuffled(moved(rpc::test::block(element, {8, 5, 1}), sheared))), (std::vector<int>{40, 8, 2}));
  for (const Element &element : {q1_in_space, q2_in_space})
    EXPECT_EQ(chain(shuffled(moved(rpc::test::block(element, {8, 4, 5}), sheared))), (std::vector<int>{160, 16, 2}));
}

TEST(Structured, OrderOfNodesRunsAlongLayers)
{
  const auto mesh = rpc::test::block(q1_in_space, {6, 4, 5});
  const auto order = layered(shuffled(mesh)).order;
  const auto numbered = shuffled(mesh);
  int repeated = 0; // nodes whose next one lies where that of the node before lies
  for (std::size_t n = 2; n < order.size(); ++n) {
    double squared = 0;
    for (int d = 0; d < 3; ++d) {
      const double step = point_of(numbered, order[n])[d] - point_of(numbered, order[n - 1])[d];
      squared += step * step;
    }
    repeated += squared == 1;
  }
  EXPECT_EQ(repeated, 7 * 6 * 4 - 1); // along each of 7 x 6 lines of 5 nodes, but for the first step
}

TEST(Structured, StretchedCellsBecomeSquareFirst)
{
  const auto flat = moved(rpc::test::block(q1, {8, 8, 1}), [](const Point &x) { return Point{x[0], 4 * x[1], 0}; });
  EXPECT_EQ(chain(flat), (std::vector<int>{64, 32, 16, 4}));
}

TEST(Structured, GradedLayersKeepTheirParts)
{
  const auto graded = [](const Point &x) { return Point{(std::pow(1.1, x[0]) - 1) * 10, x[1], 0}; };
  const auto mesh = moved(rpc::test::block(q1, {8, 8, 1}), graded);
  const auto coarser = layered(mesh).coarser;
  ASSERT_TRUE(coarser);
  EXPECT_EQ(coarser->mesh.num_cells(), 16);
  expect_nested(mesh, *coarser, 3.2 / 120); // of the longest coarse cell, whose parts are rounded to 1/60
}

TEST(Structured, ThinBodiesKeepTheirCells)
{
  EXPECT_EQ(chain(rpc::test::block(q1_in_space, {8, 8, 1})), (std::vector<int>{64}));
  const auto flat = [](const Point &x) { return Point{x[0], x[1], 4 * x[2]}; }; // no longer thin: 8 x 8 x 4
  EXPECT_EQ(chain(moved(rpc::test::block(q1_in_space, {8, 8, 1}), flat)), (std::vector<int>{64, 16, 4}));
}

TEST(Structured, BlocksSidesAndPointsStayWhereTheyEnd)
{
  MeshData mesh = rpc::test::block(q1, {12, 8, 1});
  mesh.blocks = {"left", "right"};
  for (int c = 0; c < mesh.num_cells(); ++c)
    mesh.block[c] = point_of(mesh, mesh.cells[4 * std::size_t(c)])[0] < 3 ? 0 : 1;
  add_side(mesh, "bottom", [](const Point &x) { return x[1] == 0; });
  add_side(mesh, "part of top", [](const Point &x) { return x[1] == 8 && x[0] >= 7; });
  add_point(mesh, "inside", {7, 3, 0});
  const auto coarser = layered(mesh).coarser;
  ASSERT_TRUE(coarser);
  expect_nested(mesh, *coarser);
  const MeshData &coarse = coarser->mesh;
  // x: 0 3 | 5 7 | 9 12, y: 0 3 | 5 8
  EXPECT_EQ(coarse.num_cells(), 5 * 3);
  EXPECT_EQ(coarse.blocks, mesh.blocks);
  ASSERT_EQ(coarse.sides.size(), 2u);
  EXPECT_EQ(coarse.sides[0].cell.size(), 5u);
  EXPECT_EQ(coarse.sides[1].cell.size(), 2u);
  for (std::size_t f = 0; f < 2; ++f)
    for (const int node : coarse.element.facets()[coarse.sides[1].ordinal[f]]) {
      const Point x = point_of(coarse, coarse.cells[4 * std::size_t(coarse.sides[1].cell[f]) + node]);
      EXPECT_EQ(x[1], 8);
      EXPECT_GE(x[0], 7);
    }
  ASSERT_EQ(coarse.points[0].node.size(), 1u);
  EXPECT_EQ(point_of(coarse, coarse.points[0].node[0]), (Point{7, 3, 0}));
}

TEST(Structured, MiddleNodesWithNamesStay)
{
  MeshData mesh = rpc::test::block(q2, {8, 8, 1});
  add_point(mesh, "middle", {2.5, 4, 0});
  const auto coarser = layered(mesh).coarser;
  ASSERT_TRUE(coarser);
  expect_nested(mesh, *coarser);
  ASSERT_EQ(coarser->mesh.points[0].node.size(), 1u);
  EXPECT_EQ(point_of(coarser->mesh, coarser->mesh.points[0].node[0]), (Point{2.5, 4, 0}));
}

TEST(Structured, BlocksThatShareFacesFit)
{
  for (const Element &element : {q1, q2, q1_in_space}) {
    const int high = element.dim == 3 ? 4 : 1;
    const auto l_shaped =
        without(rpc::test::block(element, {8, 8, high}), [](const Point &x) { return x[0] >= 5 && x[1] >= 3; });
    const auto found = layered(shuffled(l_shaped)).coarser;
    ASSERT_TRUE(found);
    expect_nested(shuffled(l_shaped), *found);
    // x: 2 + 3 | 3, y: 3 | 2 + 3
    EXPECT_EQ(found->mesh.num_cells(), (3 * 3 - 2) * (high == 4 ? 2 : 1));
  }
}

TEST(Structured, RingsAreClosed)
{
  const auto strip = rpc::test::block(q1, {16, 4, 1});
  const auto around = [](const Point &x) {
    return Point{(2 + x[1]) * std::cos(M_PI / 8 * x[0]), -(2 + x[1]) * std::sin(M_PI / 8 * x[0]), 0};
  };
  MeshData ring = moved(strip, around);
  std::vector<int> last(ring.num_nodes()); // nodes of the last column become those of the first
  for (int n = 0; n < ring.num_nodes(); ++n) {
    last[n] = n;
    for (int m = 0; m < n; ++m)
      if (std::hypot(point_of(ring, n)[0] - point_of(ring, m)[0], point_of(ring, n)[1] - point_of(ring, m)[1]) < 1e-9)
        last[n] = m;
  }
  for (int &node : ring.cells) node = last[node];
  const auto found = layered(without(ring, [](const Point &) { return false; })).coarser;
  ASSERT_TRUE(found);
  EXPECT_EQ(found->mesh.num_cells(), 16 * 4 / 4);
  EXPECT_EQ(found->mesh.num_nodes(), 8 * 3);
}

/// Three quadrilaterals around a point, each divided into so many in both directions.
MeshData three_around_a_point(const int times)
{
  MeshData mesh;
  mesh.element = q1;
  mesh.blocks = {"body"};
  std::map<std::pair<long, long>, int> known;
  for (int k = 0; k < 3; ++k) {
    const auto at = [](const double angle, const double radius) {
      return Point{radius * std::cos(angle), radius * std::sin(angle), 0};
    };
    const double a = 2 * M_PI / 3 * k;
    const Point corner[] = {{}, at(a, 1), at(a + M_PI / 3, 1.2), at(a + 2 * M_PI / 3, 1)};
    for (int j = 0; j < times; ++j)
      for (int i = 0; i < times; ++i) {
        mesh.block.push_back(0);
        for (const auto &[di, dj] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
          const double s = double(i + di) / times, t = double(j + dj) / times;
          Point x{};
          for (int d = 0; d < 2; ++d)
            x[d] = s * (1 - t) * corner[1][d] + s * t * corner[2][d] + (1 - s) * t * corner[3][d];
          const auto [entry, is_new] = known.emplace(std::make_pair(std::lround(1e6 * x[0]), std::lround(1e6 * x[1])),
                                                     static_cast<int>(known.size()));
          if (is_new) mesh.coords.insert(mesh.coords.end(), x.begin(), x.begin() + 2);
          mesh.cells.push_back(entry->second);
        }
      }
  }
  return mesh;
}

TEST(Structured, BlocksAroundAPointGoDownToOneCellEach)
{
  EXPECT_EQ(chain(shuffled(three_around_a_point(4)), 1e-9), (std::vector<int>{48, 12, 3}));
}

TEST(Structured, BlocksThatShareNoNodesGoTheirOwnWay)
{
  MeshData both = rpc::test::block(q1, {8, 8, 1});
  const auto beside = moved(rpc::test::block(q1, {6, 6, 1}), [](const Point &x) { // 8 high too
    return Point{8 + x[0] * 8 / 6, x[1] * 8 / 6, 0};
  });
  const int first = both.num_nodes();
  both.coords.insert(both.coords.end(), beside.coords.begin(), beside.coords.end());
  for (const int node : beside.cells) both.cells.push_back(first + node);
  both.block.resize(64 + 36, 0);
  EXPECT_EQ(chain(shuffled(both)), (std::vector<int>{64 + 36, 16 + 9, 4 + 1, 1 + 1}));
}

TEST(Structured, OtherMeshesHaveNoCoarserOnes)
{
  EXPECT_FALSE(layered(rpc::test::block({2, 1, Shape::simplex}, {8, 8, 1})).coarser);
  EXPECT_FALSE(layered(three_around_a_point(1)).coarser);
  MeshData pieces = rpc::test::block(q1, {4, 4, 1}); // all cells of other blocks than their neighbours'
  pieces.blocks = {"a", "b"};
  for (int c = 0; c < pieces.num_cells(); ++c) pieces.block[c] = (c + c / 4) % 2;
  EXPECT_FALSE(layered(pieces).coarser);
}

TEST(Structured, InvertedCellsAreNotMade)
{
  const auto around = [](const Point &x) { // three cells around 300 degrees: as one they would run around the hole
    const double angle = -M_PI * 100 / 180 * x[0];
    return Point{(1 + x[1]) * std::cos(angle), (1 + x[1]) * std::sin(angle), 0};
  };
  const auto mesh = moved(rpc::test::block(q1, {3, 2, 1}), around);
  const auto across = layered(mesh).coarser;
  ASSERT_TRUE(across);
  EXPECT_EQ(across->mesh.num_cells(), 3);
  EXPECT_FALSE(layered(across->mesh).coarser);
}

Point first_corner(const Mesh &mesh, const LO cell)
{
  const auto cells = rpc::to_host(mesh.cells);
  const auto coords = rpc::to_host(mesh.coords);
  Point x{};
  for (int d = 0; d < mesh.dim(); ++d) x[d] = coords(cells(cell, 0), d);
  return x;
}

TEST(Structured, RanksHaveTheSameMeshes)
{
  for (const Element &element : {q1, q2, q1_in_space, q2_in_space}) {
    const bool space = element.dim == 3;
    MeshData whole = rpc::test::block(element, space ? std::array<int, 3>{12, 9, 8} : std::array<int, 3>{64, 32, 1});
    whole = shuffled(moved(whole, sheared));
    add_side(whole, "bottom", [](const Point &x) { return x[2] == 0; });
    add_point(whole, "corner", {0, 0, 0});
    const auto serial = distribute_with_parents(whole, rpc::test::alone());
    const auto mesh = distribute_with_parents(world()->getRank() == 0 ? whole : MeshData{}, world());
    ASSERT_TRUE(serial->parents && mesh->parents);
    const Mesh *fine = mesh.get(), *of_one = serial.get();
    for (; fine->parents; fine = fine->parents->mesh.get(), of_one = of_one->parents->mesh.get()) {
      ASSERT_TRUE(of_one->parents);
      rpc::test::expect_part_of(*of_one, *fine);
      rpc::test::expect_cells_around_owned_nodes(*of_one, *fine);
      EXPECT_NEAR(rpc::test::body_measure(*fine), rpc::test::body_measure(*fine->parents->mesh),
                  1e-9 * whole.num_cells());
      const auto &parents = *fine->parents;
      std::map<GO, Point> parent_of; // its first corner, by ids
      for (LO c = 0; c < of_one->num_cells(); ++c)
        parent_of[of_one->cell_id(c)] = first_corner(*of_one->parents->mesh, of_one->parents->cell[c]);
      for (LO c = 0; c < fine->num_owned_cells; ++c) {
        ASSERT_GE(parents.cell[c], 0);
        ASSERT_LT(parents.cell[c], parents.mesh->num_cells());
        EXPECT_EQ(first_corner(*parents.mesh, parents.cell[c]), parent_of[fine->cell_id(c)]);
      }
    }
    EXPECT_FALSE(of_one->parents); // ranks have the same number of meshes
  }
}

TEST(Structured, SmallMeshesAreDealtOutAsBefore)
{
  const auto whole = rpc::test::block(q1, {8, 8, 1});
  EXPECT_FALSE(distribute_with_parents(world()->getRank() == 0 ? whole : MeshData{}, world())->parents);
}

} // namespace
} // namespace structured_test
