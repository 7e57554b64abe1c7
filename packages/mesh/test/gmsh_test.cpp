// SPDX-License-Identifier: BSD-3-Clause
// Meshing .geo files in process.

#include "expect_error.hpp"
#include "msh_text.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/mesh/gmsh.hpp"
#include "same_mesh.hpp"
#include "scratch_file.hpp"

#include <Tpetra_Core.hpp>
#include <clocale>
#include <cmath>
#include <csignal>
#include <cstring>
#include <sys/resource.h>

namespace gmsh_test
{
namespace
{

using rpc::ExitCode;
using rpc::mesh::GmshOptions;
using rpc::mesh::MeshData;
using rpc::mesh::read_gmsh;
using rpc::test::expect_alike_mesh;
using rpc::test::expect_error;
using rpc::test::expect_noted;
using rpc::test::expect_same_mesh;
using rpc::test::ScratchFile;

const std::string sector = std::string(RPC_TEST_DATA_DIR) + "/sector.geo";

/// The unit square, counterclockwise unless turned, before its groups are named.
std::string square(const std::string &loop = "1, 2, 3, 4")
{
  return "Point(1) = {0, 0, 0, .5}; Point(2) = {1, 0, 0, .5}; Point(3) = {1, 1, 0, .5}; Point(4) = {0, 1, 0, .5};\n"
         "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
         "Curve Loop(1) = {" +
         loop + "}; Plane Surface(1) = {1};\n";
}
const std::string body = "Physical Surface(\"body\") = {1};\n";

MeshData read_geo(const std::string &text, const double size_factor = 1, const int order = 0)
{
  const ScratchFile file("mesh.geo", text);
  return read_gmsh({file.path(), size_factor, order});
}

double area(const MeshData &mesh)
{
  double sum = 0;
  const int vertices = mesh.element.num_vertices();
  for (int c = 0; c < mesh.num_cells(); ++c)
    for (int v = 0; v < vertices; ++v) {
      const int a = mesh.cells[c * mesh.element.num_nodes() + v];
      const int b = mesh.cells[c * mesh.element.num_nodes() + (v + 1) % vertices];
      sum += (mesh.coords[2 * a] * mesh.coords[2 * b + 1] - mesh.coords[2 * b] * mesh.coords[2 * a + 1]) / 2;
    }
  return sum;
}

TEST(Gmsh, GeoAndItsMshGiveAlikeMeshes)
{
  const MeshData now = read_gmsh({sector, 1, 0}),
                 then = read_gmsh({std::string(RPC_TEST_DATA_DIR) + "/sector_41.msh", 1, 0});
  expect_alike_mesh(now, then, "sector");
  EXPECT_NEAR(area(now), area(then), 1e-3 * area(then)); // of the curved side other nodes lie on the arc
}

TEST(Gmsh, MeshesTheSameEachTime)
{
  expect_same_mesh(read_gmsh({sector, .3, 0}), read_gmsh({sector, .3, 0}), "sector");
}

TEST(Gmsh, MakesAllFourElements)
{
  const std::string quads = "Transfinite Surface {1}; Recombine Surface {1};\n";
  const std::string right = "Physical Curve(\"right\") = {2};\n";
  for (const bool recombine : {false, true})
    for (const int order : {1, 2}) {
      const MeshData mesh = read_geo(square() + (recombine ? quads : "") + body + right, 1, order);
      EXPECT_EQ(mesh.element.name(), (recombine ? "Q" : "P") + std::to_string(order));
      EXPECT_NEAR(area(mesh), 1, 1e-14);
      ASSERT_EQ(mesh.sides.size(), 1u);
      EXPECT_EQ(mesh.sides[0].cell.size(), 2u);
      for (std::size_t f = 0; f < mesh.sides[0].cell.size(); ++f)
        for (const int local : mesh.element.facets()[mesh.sides[0].ordinal[f]])
          EXPECT_NEAR(mesh.coords[2 * mesh.cells[mesh.sides[0].cell[f] * mesh.element.num_nodes() + local]], 1, 1e-14);
      if (recombine) {
        EXPECT_EQ(mesh.num_nodes(), order == 1 ? 9 : 25);
      }
    }
}

/// gmsh's simple recombination leaves some triangles.
TEST(Gmsh, QuadrilateralsBesideTrianglesAreDivided)
{
  const std::string some = "Recombine Surface {1}; Mesh.RecombinationAlgorithm = 0;\n";
  for (const int order : {1, 2}) {
    const MeshData mesh = read_geo(square() + some + body + "Physical Curve(\"right\") = {2};\n", .3, order);
    EXPECT_EQ(mesh.element.name(), "P" + std::to_string(order));
    EXPECT_NEAR(area(mesh), 1, 1e-14);
    ASSERT_EQ(mesh.sides.size(), 1u);
    expect_noted(mesh, {"quadrilaterals are divided into", "triangles along diagonals", "SubdivisionAlgorithm = 1"});
  }
}

TEST(Gmsh, OrderIsTwoUnlessAskedForWhateverTheGeoSays)
{
  EXPECT_EQ(read_geo(square() + body + "Mesh.ElementOrder = 1;").element.order, 2);
  EXPECT_EQ(read_geo(square() + body + "Mesh.ElementOrder = 3;", 1, 1).element.order, 1);
  EXPECT_EQ(read_geo(square() + "Recombine Surface {1}; Mesh.SecondOrderIncomplete = 1;" + body).element.name(), "Q2");
}

TEST(Gmsh, SizeFactorMultipliesTheGeosOwn)
{
  const int coarse = read_geo(square() + body).num_cells();
  const int fine = read_geo(square() + body, .25).num_cells();
  EXPECT_GT(fine, 8 * coarse);
  EXPECT_EQ(read_geo(square() + body + "Mesh.MeshSizeFactor = .5;", .5).num_cells(), fine);
  EXPECT_EQ(read_geo(square() + body).num_cells(), coarse) << "a .geo's options leaked into the next";
}

TEST(Gmsh, BlocksAndSidesComeInTheOrderOfTheirTags)
{
  const std::string two = square() + "Point(5) = {2, 0, 0, .5}; Point(6) = {2, 1, 0, .5};\n"
                                     "Line(5) = {2, 5}; Line(6) = {5, 6}; Line(7) = {6, 3};\n"
                                     "Curve Loop(2) = {5, 6, 7, -2}; Plane Surface(2) = {2};\n";
  const MeshData mesh = read_geo(two + "Physical Surface(\"b\", 20) = {1}; Physical Surface(\"a\", 10) = {2};\n"
                                       "Physical Curve(\"top\", 8) = {3, -7}; Physical Curve(\"all\", 2) = {1, 3:7};\n"
                                       "Physical Point(\"corner\") = {1};\n");
  EXPECT_EQ(mesh.blocks, (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(mesh.sides.size(), 2u);
  EXPECT_EQ(mesh.sides[0].name, "all");
  EXPECT_EQ(mesh.sides[0].cell.size(), 12u);
  EXPECT_EQ(mesh.sides[1].name, "top");
  EXPECT_EQ(mesh.sides[1].cell.size(), 4u);
  ASSERT_EQ(mesh.points.size(), 1u);
  for (int c = 0; c < mesh.num_cells(); ++c) {
    double x = 0;
    for (int v = 0; v < 3; ++v) x += mesh.coords[2 * mesh.cells[c * 6 + v]] / 3;
    EXPECT_EQ(mesh.block[c], x < 1 ? 1 : 0);
  }
}

TEST(Gmsh, PhysicalPointsAreNodesWithNames)
{
  for (const int order : {1, 2}) {
    const MeshData mesh =
        read_geo(square() + body +
                     "Point(9) = {7, 7, 0}; Physical Point(\"away\") = {9}; Physical Point(77) = {1};\n"
                     "Physical Point(\"ends\", 3) = {4, 2}; Physical Point(\"corner\", 5) = {3};\n",
                 1, order);
    ASSERT_EQ(mesh.points.size(), 2u); // one lies at no cell, one has no name
    EXPECT_EQ(mesh.points[0].name, "ends");
    EXPECT_EQ(mesh.points[1].name, "corner");
    ASSERT_EQ(mesh.points[0].node.size(), 2u);
    for (const int node : mesh.points[0].node) EXPECT_NEAR(mesh.coords[2 * node] + mesh.coords[2 * node + 1], 1, 1e-15);
    ASSERT_EQ(mesh.points[1].node.size(), 1u);
    for (int c = 0; c < 2; ++c) EXPECT_EQ(mesh.coords[2 * mesh.points[1].node[0] + c], 1);
  }
}

TEST(Gmsh, RefusalsNameFileRuleAndRemedy)
{
  const auto refused = [](const std::string &text, const std::initializer_list<std::string> &parts) {
    expect_error(ExitCode::bad_mesh, "mesh.geo\": ", [&] { read_geo(text); });
    expect_error(ExitCode::bad_mesh, parts, [&] { read_geo(text); });
  };
  refused("Point(1) = {0, 0", {"gmsh: line ", "syntax error"});
  refused(square() + "Foo(1) = {2};", {"gmsh: line 3: syntax error"});
  refused("", {"has no cells in a surface", "Physical Surface(\"body\")"});
  refused(square() + body + "Physical Surface(\"skin\") = {1};",
          {"\"body\" and \"skin\"", "each cell must belong to one"});
  refused(square() + body + "Translate {0, 0, 1} { Surface{1}; }\n", {"off the plane", "z must be 0"});
  refused(square() + body + "Point(8) = {5, 5, 0}; Physical Curve(\"last\") = {3};", {"last line", "line break"});
  refused(square() + square() + body, {"gmsh: "});
}

TEST(Gmsh, WhatIsMendedIsNoted)
{
  expect_noted(read_geo(square("-4, -3, -2, -1") + body), {"nodes of", "run the wrong way round", "are turned"});
  const MeshData cut =
      read_geo(square() + body + "Line(9) = {1, 3}; Curve{9} In Surface{1}; Physical Curve(\"cut\") = {9};\n");
  expect_noted(cut, {"\"cut\" lies inside the body"});
  EXPECT_TRUE(cut.sides.empty());
  ASSERT_EQ(cut.points.size(), 1u);
  expect_noted(
      read_geo(square() + body + "Point(8) = {5, 5, 0, .5}; Line(9) = {3, 8}; Physical Curve(\"away\") = {9};\n"),
      {"\"away\" belongs to no cell"});
}

/// A ring that is thinner than the arcs of its cells are high: the first mesh has inverted cells, the second one is straightened. A
/// ring of 1e-7 of its radius cannot be.
TEST(Gmsh, StraightensCellsWhoseCurvedEdgesBendTooFar)
{
  const auto ring = [](const std::string &inner) {
    std::string text = "Point(1) = {0, 0, 0, 1};\n";
    for (const std::string &radius : {std::string("1"), inner})
      for (const char *const at : {"r, 0", "0, r", "-r, 0", "0, -r"})
        text += "r = " + radius + "; Point(newp) = {" + at + ", 0, 1};\n";
    return text +
           "Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};\n"
           "Circle(5) = {6, 1, 7}; Circle(6) = {7, 1, 8}; Circle(7) = {8, 1, 9}; Circle(8) = {9, 1, 6};\n"
           "Curve Loop(1) = {1:4}; Curve Loop(2) = {5:8}; Plane Surface(1) = {1, 2};\n" +
           body;
  };
  const MeshData mesh = read_geo(ring("0.95"));
  EXPECT_GT(mesh.num_cells(), 8);
  for (std::size_t n = 0; n + 1 < mesh.coords.size(); n += 2) {
    const double r = std::hypot(mesh.coords[n], mesh.coords[n + 1]);
    EXPECT_TRUE(r > 0.95 - 1e-9 && r < 1 + 1e-9) << r;
  }
  expect_error(ExitCode::bad_mesh, {"inverted", "curved edges bend too far", "smaller cells"},
               [&] { read_geo(ring("0.9999999")); });
}

TEST(Gmsh, GroupsWithoutNamesAreNumberedAndWithoutABlockAllIsTheBody)
{
  const MeshData plain = read_geo(square() + "Physical Curve(7) = {1};\n");
  EXPECT_EQ(plain.blocks, std::vector<std::string>{"body"});
  ASSERT_EQ(plain.sides.size(), 1u);
  EXPECT_EQ(plain.sides[0].name, "7");
  EXPECT_NEAR(area(plain), 1, 1e-12);
  EXPECT_EQ(read_geo(square() + "Physical Surface(3) = {1};\n").blocks, std::vector<std::string>{"3"});
}

TEST(Gmsh, AbsurdSizesAreRefusedInGoodTime)
{
  const auto line_to = [](const std::string &x, const std::string &size) {
    return "Point(8) = {0, 0, 0, " + size + "}; Point(9) = {" + x + ", 0, 0, " + size + "}; Line(9) = {8, 9};\n";
  };
  const auto refused = [](const std::string &text, const double factor, const std::string &part) {
    expect_error(ExitCode::bad_mesh, {"mesh.geo\": gmsh: ", part}, [&] { read_geo(text, factor); });
  };
  refused(square() + body + line_to("1e308", ".5"), 1, "at most 1e+50 [m]");
  refused(square() + body + line_to("2", "1e-300"), 1, "too small for a body of size");
  refused(square() + body, 1e-300, "1e-09 to 1e+09, got 1e-300");
}

TEST(Gmsh, ThatEndsWithoutAMeshIsABadMesh)
{
  expect_error(ExitCode::bad_mesh, {"mesh.geo\": gmsh ended without a mesh"}, [] { read_geo("Exit;\n"); });
}

TEST(Gmsh, AnErrorDoesNotSpoilTheNextFile)
{
  const MeshData before = read_gmsh({sector, 1, 0});
  expect_error(ExitCode::bad_mesh, "syntax error",
               [] { read_geo("Point(1) = {0, 0; If (1) Mesh.ElementOrder = {\n"); });
  expect_same_mesh(read_gmsh({sector, 1, 0}), before, "sector");
}

TEST(Gmsh, SaysNothingAndLeavesTheProcessAsItWas)
{
  const auto handlers = [] {
    std::vector<void (*)(int)> all;
    for (int s = 1; s < 32; ++s) {
      struct sigaction action;
      sigaction(s, nullptr, &action);
      all.push_back(action.sa_handler);
    }
    return all;
  };
  const auto stack = [] {
    rlimit limit{};
    getrlimit(RLIMIT_STACK, &limit);
    return limit.rlim_cur;
  };
  const auto handlers_before = handlers();
  const auto stack_before = stack();
  const std::string path_before = std::getenv("PATH"), locale_before = std::setlocale(LC_ALL, nullptr);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  read_gmsh({sector, 1, 0});
  EXPECT_THROW(read_geo("Point("), rpc::Error);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(handlers() == handlers_before);
  EXPECT_EQ(stack(), stack_before);
  EXPECT_EQ(std::getenv("PATH"), path_before);
  EXPECT_EQ(std::setlocale(LC_ALL, nullptr), locale_before);
}

TEST(Gmsh, OneRankReadsWhileTheOthersWait)
{
  const auto comm = Tpetra::getDefaultComm();
  MeshData mesh;
  rpc::on_root(*comm, ExitCode::bad_mesh, [&] { mesh = read_gmsh({sector, 1, 0}); });
  EXPECT_EQ(mesh.num_cells(), comm->getRank() == 0 ? 10 : 0);
  expect_error(ExitCode::bad_mesh, "syntax error",
               [&] { rpc::on_root(*comm, ExitCode::bad_mesh, [] { read_geo("Point("); }); });
}

} // namespace
} // namespace gmsh_test
