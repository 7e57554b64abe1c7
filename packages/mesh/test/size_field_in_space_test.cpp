// SPDX-License-Identifier: BSD-3-Clause
// Meshes of bodies in space with cell sizes from a field.

#include "expect_error.hpp"
#include "measures.hpp"
#include "rpc/mesh/make_mesh.hpp"
#include "same_mesh.hpp"
#include "scratch_file.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

namespace size_field_in_space_test
{
namespace
{

using namespace rpc::mesh;
using rpc::ExitCode;
using rpc::test::expect_error;
using rpc::test::expect_same_mesh;
using rpc::test::integrals;
using rpc::test::ScratchFile;
using rpc::test::volume;

using Size = std::function<double(double, double, double)>;
using Sizes = std::shared_ptr<const SizeField>;

const std::string octant = std::string(RPC_TEST_DATA_DIR) + "/octant.geo";

/// At the vertices of n^3 cubes that fill a box, each cut into six tetrahedra around its diagonal.
Sizes field_of(const std::array<double, 3> &low, const std::array<double, 3> &high, const int n, const Size &size)
{
  auto field = std::make_shared<SizeField>();
  field->dim = 3;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const int at[3] = {i, j, k};
        double x[3];
        for (int d = 0; d < 3; ++d) x[d] = low[d] + (high[d] - low[d]) * at[d] / n;
        field->coords.insert(field->coords.end(), x, x + 3);
        field->size.push_back(size(x[0], x[1], x[2]));
      }
  const int step[3] = {1, n + 1, (n + 1) * (n + 1)};
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        int way[3] = {0, 1, 2}; // the edges that lead from one end of the diagonal to the other
        do {
          int node = i + step[1] * j + step[2] * k;
          field->simplices.push_back(node);
          for (const int d : way) field->simplices.push_back(node += step[d]);
        } while (std::next_permutation(way, way + 3));
      }
  return field;
}

Sizes constant(const double size)
{
  return std::make_shared<SizeField>(
      SizeField{{0, 0, 0, .5, 0, 0, 0, .5, 0, 0, 0, .5}, {0, 1, 2, 3}, {size, size, size, size}, 3});
}

MeshData made(const MeshOptions &options, const Sizes &sizes)
{
  return read_gmsh(std::get<GmshOptions>(with_sizes(options, sizes).value()));
}

BoxOptions box(const std::string &element)
{
  return {{-1, 2, 0}, {1, 3, 1}, {4, 2, 2}, parse_element(element, 3)};
}

/// Of a cell of order 1 or straight: the edge of a cube that holds tetrahedra_per_cube of its size.
double size_of_cell(const MeshData &mesh, const int cell)
{
  const auto at = [&](const int a, const int d) {
    return mesh.coords[3 * mesh.cells[mesh.element.num_nodes() * cell + a] + d];
  };
  double arm[3][3];
  for (int a = 0; a < 3; ++a)
    for (int d = 0; d < 3; ++d) arm[a][d] = at(a + 1, d) - at(0, d);
  double six = 0;
  for (int d = 0; d < 3; ++d)
    six += arm[0][d] * (arm[1][(d + 1) % 3] * arm[2][(d + 2) % 3] - arm[1][(d + 2) % 3] * arm[2][(d + 1) % 3]);
  return std::cbrt(std::abs(six) / 6 * tetrahedra_per_cube);
}

std::array<double, 3> centre(const MeshData &mesh, const int cell)
{
  std::array<double, 3> x{};
  for (int a = 0; a < 4; ++a)
    for (int d = 0; d < 3; ++d) x[d] += mesh.coords[3 * mesh.cells[mesh.element.num_nodes() * cell + a] + d] / 4;
  return x;
}

TEST(SizeFieldInSpace, ABoxKeepsItsNamesItsVolumeAndItsOrderInTetrahedra)
{
  for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
    SCOPED_TRACE(element);
    const MeshData mesh = made(box(element), constant(.4));
    EXPECT_EQ(mesh.element.name(), "P" + element.substr(1));
    EXPECT_EQ(mesh.blocks, std::vector<std::string>{"body"});
    EXPECT_NEAR(volume(mesh), 2, 1e-12);
    std::vector<std::string> sides, points;
    for (const auto &side : mesh.sides) sides.push_back(side.name);
    EXPECT_EQ(sides, (std::vector<std::string>{"left", "right", "bottom", "top", "back", "front"}));
    const double area[6] = {1, 1, 2, 2, 2, 2};
    for (int s = 0; s < 6; ++s) {
      const auto normal = integrals(mesh, mesh.sides[s]).normal;
      for (int d = 0; d < 3; ++d)
        EXPECT_NEAR(normal[d], d == s / 2 ? (s % 2 ? area[s] : -area[s]) : 0, 1e-12) << sides[s];
    }
    const Mesh whole = make_mesh(box(element), Tpetra::getDefaultComm()->split(Tpetra::getDefaultComm()->getRank(), 0));
    for (const auto &set : whole.points) {
      const auto same = std::find_if(mesh.points.begin(), mesh.points.end(),
                                     [&](const PointData &point) { return point.name == set.name; });
      ASSERT_NE(same, mesh.points.end()) << set.name;
      ASSERT_EQ(same->node.size(), 1u);
      const auto expected = rpc::to_host(whole.coords);
      for (int d = 0; d < 3; ++d) EXPECT_EQ(mesh.coords[3 * same->node[0] + d], expected(set.node[0], d)) << set.name;
    }
    EXPECT_EQ(mesh.points.size(), 8u);
  }
}

TEST(SizeFieldInSpace, CellsAreAsManyAndAsLongAsTheFieldSays)
{
  const Size size = [](const double x, const double y, const double z) {
    return std::min(.2, .03 + .15 * std::hypot(x + 1, y - 2, z));
  };
  const Sizes field = field_of({-1, 2, 0}, {1, 3, 1}, 20, size);
  const MeshData mesh = made(box("P2"), field);
  EXPECT_NEAR(mesh.num_cells() / expected_cells(*field), 1, .25);
  double sum = 0;
  for (int c = 0; c < mesh.num_cells(); ++c) {
    const auto x = centre(mesh, c);
    sum += std::log(size_of_cell(mesh, c) / size(x[0], x[1], x[2]));
  }
  EXPECT_NEAR(std::exp(sum / mesh.num_cells()), 1, .1);
  double least = 1, most = 0;
  for (int c = 0; c < mesh.num_cells(); ++c) {
    least = std::min(least, size_of_cell(mesh, c));
    most = std::max(most, size_of_cell(mesh, c));
  }
  EXPECT_LT(least, .035);
  EXPECT_GT(most, .18);
}

TEST(SizeFieldInSpace, ExpectedCellsAreTheIntegralOfTheSizes)
{
  EXPECT_NEAR(expected_cells(*field_of({0, 0, 0}, {1, 2, 3}, 2, [](double, double, double) { return .1; })), 30000,
              1e-6);
  // int_0^1 (1 + x)^-3 dx = 3 / 8
  EXPECT_NEAR(expected_cells(*field_of({0, 0, 0}, {1, 1, 1}, 3, [](const double x, double, double) { return 1 + x; })),
              5 * 3. / 8, 1e-9);
  // Sizes that differ by less than what is worth a formula.
  EXPECT_NEAR(
      expected_cells(*field_of({0, 0, 0}, {1, 1, 1}, 1, [](const double x, double, double) { return 1 + .009 * x; })),
      5 * (1 - std::pow(1.009, -2)) / (2 * .009), 1e-3);
}

TEST(SizeFieldInSpace, AGeoKeepsItsCurvedShape)
{
  const GmshOptions options{octant, 1, 2};
  const MeshData own = read_gmsh(options), mesh = made(options, constant(.15));
  EXPECT_EQ(mesh.element.name(), "P2");
  EXPECT_EQ(mesh.blocks, own.blocks);
  ASSERT_EQ(mesh.sides.size(), own.sides.size());
  for (std::size_t s = 0; s < mesh.sides.size(); ++s) EXPECT_EQ(mesh.sides[s].name, own.sides[s].name);
  EXPECT_GT(mesh.num_cells(), own.num_cells());
  EXPECT_NEAR(volume(mesh), std::acos(-1.) / 6, 1e-4);
}

TEST(SizeFieldInSpace, RefinementsHalveCellsThatAreMadeTwiceAsLong)
{
  const auto comm = Tpetra::getDefaultComm();
  const Sizes field = comm->getRank() == 0 ? constant(.1) : nullptr;
  const auto cells = [&](const MeshOptions &options) {
    const Mesh mesh = make_mesh(options, comm);
    return double(rpc::sum_all(*comm, rpc::GO(mesh.num_owned_cells)));
  };
  const double plain = cells(with_sizes(box("Q2"), field).value()),
               refined = cells(with_sizes(box("Q2"), field, 1).value());
  EXPECT_NEAR(refined / plain, 1, .35);
  EXPECT_EQ(std::fmod(refined, 8), 0);
  GmshOptions again = std::get<GmshOptions>(with_sizes(box("Q2"), field, 2).value());
  EXPECT_EQ(again.refinements, 2);
  EXPECT_EQ(again.size_factor, 4);
  again = std::get<GmshOptions>(with_sizes(again, field).value());
  EXPECT_EQ(again.refinements, 0);
  EXPECT_EQ(again.size_factor, 1);
}

/// A plate with a hole in cells that are wider than it: halved they would be inverted, gmsh's own small ones are not.
TEST(SizeFieldInSpace, CellsTooLargeForACurvedBoundaryAreMadeSmallByGmsh)
{
  const ScratchFile geo("hole.geo", "Mesh.HighOrderOptimize = 1;\nSetFactory(\"OpenCASCADE\");\n"
                                    "Box(1) = {0, 0, 0, 2, 1, 1};\nCylinder(2) = {0.8, 0.5, 0, 0, 0, 1, 0.17};\n"
                                    "BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };\n"
                                    "Physical Volume(\"body\") = {3};\n");
  GmshOptions options;
  options.file = geo.path();
  options.order = 2;
  const auto comm = Tpetra::getDefaultComm();
  int halved = 0, small = 0;
  for (const double size : {0.1, 0.15, 0.25, 0.35, 0.45}) {
    const Mesh mesh = make_mesh(with_sizes(options, comm->getRank() == 0 ? constant(size) : nullptr, 1).value(), comm);
    (mesh.parents ? halved : small) += 1;
  }
  EXPECT_GT(halved, 0);
  EXPECT_GT(small, 0);
}

TEST(SizeFieldInSpace, EqualOptionsGiveEqualMeshesBitByBit)
{
  const Sizes field = field_of({-1, 2, 0}, {1, 3, 1}, 8, [](const double x, const double y, const double z) {
    return std::min(.3, .05 + .3 * std::hypot(x + 1, y - 2, z));
  });
  const MeshData mesh = made(box("P2"), field);
  made(box("P1"), constant(.4)); // leaves no trace
  expect_same_mesh(made(box("P2"), field), mesh, "box");
  double sum = std::accumulate(mesh.coords.begin(), mesh.coords.end(), 0.), others = sum;
  Teuchos::broadcast(*Tpetra::getDefaultComm(), 0, 1, &others); // of another process
  EXPECT_EQ(sum, others);
}

TEST(SizeFieldInSpace, OutsideOfItTheNearestPointTells)
{
  // Sizes on a tetrahedron with the corner x + y + z < 1 of a cube of 2: on the rest of the cube that of its faces.
  auto field =
      std::make_shared<SizeField>(SizeField{{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1, 2, 3}, {.1, .4, .4, .4}, 3});
  const MeshData mesh = made(BoxOptions{{0, 0, 0}, {2, 2, 2}, {1, 1, 1}, parse_element("P1", 3)}, field);
  double near[2] = {}, far[2] = {}; // sums of sizes and cells
  for (int c = 0; c < mesh.num_cells(); ++c) {
    const auto x = centre(mesh, c);
    double *const sum = std::hypot(x[0], x[1], x[2]) < .3 ? near : x[0] + x[1] + x[2] > 2 ? far : nullptr;
    if (!sum) continue;
    sum[0] += size_of_cell(mesh, c);
    ++sum[1];
  }
  ASSERT_GT(near[1], 5);
  ASSERT_GT(far[1], 50);
  EXPECT_GT(near[0] / near[1], .1);
  EXPECT_LT(near[0] / near[1], .19);
  EXPECT_NEAR(far[0] / far[1], .4, .06);
}

TEST(SizeFieldInSpace, Refusals)
{
  const auto refused = [](const SizeField &field, const std::initializer_list<std::string> &parts) {
    expect_error(ExitCode::bad_mesh, parts, [&] { made(box("P1"), std::make_shared<SizeField>(field)); });
  };
  const std::vector<double> corners = constant(1)->coords;
  refused({corners, {0, 1, 2, 3}, {1e-4, 1e-4, 1e-4, 1e-4}, 3}, {"too small", "1.04167e+11 cells"});
  refused({corners, {0, 1, 2, 3}, {1, 1, 0, 1}, 3}, {"must be > 0", "got 0"});
  refused({corners, {0, 1, 2}, {1, 1, 1, 1}, 3}, {"one triangle or tetrahedron or more, of its nodes"});
  refused({{0, 0, 9, 0, 0, 9}, {0, 1, 2}, {1, 1, 1}}, {"a body in 3D", "cell sizes in 2D"});
  const ScratchFile plane("plane.geo", "Rectangle(1) = {0, 0, 0, 1, 1};\n");
  expect_error(ExitCode::bad_mesh, {"plane.geo\": "}, [&] { made(GmshOptions{plane.path(), 1, 1}, constant(.1)); });
  const ScratchFile layers("layers.geo", "Point(1) = {0, 0, 0, 1}; Point(2) = {1, 0, 0, 1}; Point(3) = {0, 1, 0, 1};\n"
                                         "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};\n"
                                         "Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};\n"
                                         "Extrude {0, 0, 1} { Surface{1}; Layers{3}; }\n");
  expect_error(ExitCode::bad_mesh, {"layers.geo\": gmsh: curve ", "Transfinite or Layers", "nested"}, [&] {
    made(GmshOptions{layers.path(), 1, 1}, constant(.1));
  });
}

TEST(SizeFieldInSpace, ReachesBodiesWithCurvesWithoutLength)
{
  const std::string kernel = "SetFactory(\"OpenCASCADE\");\n";
  for (const std::string body : {"Sphere(1) = {0, 0, 0, 1};\n", "Cone(1) = {0, 0, 0, 0, 0, 1, 0.5, 0};\n"}) {
    const ScratchFile file("poles.geo", kernel + body + "MeshSize{:} = 1;\n");
    int cells = 0;
    for (const double size : {.5, .4, .3, .25, .2, .15}) { // for some of them a tip takes gmsh 4.13 a second attempt
      const auto mesh = made(GmshOptions{file.path(), 1, 1}, constant(size));
      EXPECT_GT(mesh.num_cells(), cells) << body << size;
      cells = mesh.num_cells();
    }
    EXPECT_GT(cells, 400) << body;
  }
}

} // namespace
} // namespace size_field_in_space_test
