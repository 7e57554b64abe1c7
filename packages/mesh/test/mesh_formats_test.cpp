// SPDX-License-Identifier: BSD-3-Clause
// Meshes of Exodus, cells of 8 and 20 nodes, meshes that are divided among processors, sides that a deck chooses: all of it needs no gmsh.

#include "expect_error.hpp"
#include "msh_text.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/mesh/make_mesh.hpp"
#include "rpc/mesh/mesh_summary.hpp"
#include "same_mesh.hpp"
#include "scratch_file.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>

namespace mesh_formats_test
{
namespace
{

using rpc::ExitCode;
using rpc::mesh::GmshOptions;
using rpc::mesh::MeshData;
using rpc::mesh::read_gmsh;
using rpc::mesh::SidePlace;
using rpc::test::expect_error;
using rpc::test::expect_noted;
using rpc::test::expect_same_mesh;
using rpc::test::path_of_data;
using rpc::test::read_data;
using rpc::test::read_text;
using rpc::test::ScratchFile;

/// Two blocks of one square each, side by side, as the Exodus files have them.
rpc::test::MshText squares()
{
  return {
      {"1 1 \"left\"", "1 2 \"right\"", "1 5 \"floor\"", "2 3 \"steel\"", "2 4 \"rubber\""},
      {"1 0 0 0", "2 1 0 0", "3 2 0 0", "4 0 1 0", "5 1 1 0", "6 2 1 0"},
      {"1 1 2 1 0 1 4", "2 1 2 2 0 3 6", "5 1 2 5 0 1 2", "6 1 2 5 0 2 3", "3 3 2 3 0 1 2 5 4", "4 3 2 4 0 2 3 6 5"}};
}

MeshData with_sides(const std::vector<SidePlace> &places, const std::string &text = squares().text())
{
  const ScratchFile file("mesh.msh", text);
  GmshOptions options;
  options.file = file.path();
  options.sides = places;
  return read_gmsh(options);
}

TEST(ExodusMesh, BlocksAndSetsAreThoseOfTheSameMsh)
{
  MeshData expected = read_text(squares().text());
  for (const char *const name : {"two_squares.exo", "two_squares_4.exo"}) { // NetCDF's classic format and HDF5
    const MeshData mesh = read_data(name);
    ASSERT_EQ(mesh.points.size(), 1u);
    EXPECT_EQ(mesh.points[0].name, "node set 8"); // it has no name
    EXPECT_EQ(mesh.points[0].node, std::vector<int>{5});
    expected.points = mesh.points;
    expect_same_mesh(mesh, expected, name);
    expect_noted(mesh, {"set \"floor\"", "2 whole facets", "a side"});
  }
}

TEST(ExodusMesh, AFileIsReadOnceForItsDimensionAndItsMesh)
{
  std::ifstream in(path_of_data("two_squares.exo"), std::ios::binary);
  auto file = std::make_unique<ScratchFile>("mesh.exo", std::string{std::istreambuf_iterator<char>(in), {}});
  Teuchos::ParameterList list("Mesh");
  list.set("Type", "gmsh").set("File", file->path());
  rpc::validate(list, rpc::mesh::valid_parameters());
  const auto options = rpc::mesh::mesh_options(list, "", *Tpetra::getDefaultComm());
  EXPECT_EQ(rpc::mesh::dimension(options, *Tpetra::getDefaultComm()), 2);
  file.reset(); // it is gone from the disk
  expect_same_mesh(read_gmsh(std::get<GmshOptions>(options)), read_data("two_squares.exo"), "read once");
}

TEST(ExodusMesh, DamagedFilesAreRefused)
{
  std::ifstream in(path_of_data("two_squares.exo"), std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto refused = [](const std::string &text, const std::string &part) {
    const ScratchFile file("mesh.e", text);
    expect_error(ExitCode::bad_mesh, {"mesh.e\": ", part}, [&] { read_gmsh({file.path(), 1, 0}); });
  };
  refused("", "is no Exodus file");
  refused("hello", "is no Exodus file");
  refused(good.substr(0, 100), "is no Exodus file");
  std::string other = good;
  const std::string cell("\0\0\0\1\0\0\0\2\0\0\0\5\0\0\0\4", 16); // of the first block, in the order of bytes of NetCDF
  const std::size_t at = good.find(cell);
  ASSERT_NE(at, good.npos);
  other[at + 3] = 7;
  refused(other, "cell 1 of block 3 uses node 7; there are 1 to 6");
  other = good;
  other.replace(other.find("QUAD4"), 5, "BLOB4");
  refused(other, "block 3 has cells of type \"BLOB4\" with 4 nodes, which are unknown");
}

// The first two sides of a shell are its faces: side 4 is the second edge, which lies between the cells here.
TEST(ExodusMesh, SidesOfShellsAreNumberedFromTheirFaces)
{
  std::ifstream in(path_of_data("two_squares.exo"), std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  text.replace(text.find("QUAD4"), 5, "SHELL"); // of the block "steel"
  const ScratchFile file("mesh.e", text);
  expect_noted(read_gmsh({file.path(), 1, 0}), {"side set \"left\" lies inside the body"});
}

TEST(MeshFormats, APlaneBodyMayLieAtAnyHeight)
{
  rpc::test::MshText msh = squares();
  for (std::string &node : msh.nodes) node.back() = '3';
  const MeshData mesh = read_text(msh.text());
  expect_noted(mesh, {"all nodes have z = 3"});
  EXPECT_EQ(mesh.coords, read_text(squares().text()).coords);
  msh.nodes[0].back() = '2';
  expect_error(ExitCode::bad_mesh, {"off the plane", "tetrahedra or hexahedra"}, [&] { read_text(msh.text()); });
}

TEST(MeshFormats, WhatIsNoMshSaysWhatItIs)
{
  expect_error(ExitCode::bad_mesh, {"*NODE", "Abaqus", ".inp"}, [] { read_text("*NODE, NSET=Nall\n1, 0, 0\n"); });
  expect_error(ExitCode::bad_mesh, {"pointer of Git LFS", "git lfs pull"},
               [] { read_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n"); });
  rpc::test::MshText msh = squares();
  msh.names[0] += " lower_dimensional_block";
  expect_noted(read_text(msh.text()), {"words after a name", "lower_dimensional_block"});
}

/// Nodes of the one cell by their coordinates' index.
std::vector<double> node(const MeshData &mesh, const int local)
{
  const auto begin = mesh.coords.begin() + 3 * mesh.cells[local];
  return {begin, begin + 3};
}

TEST(Serendipity, HexahedraGetTheMiddlesOfTheirOwnMap)
{
  const MeshData mesh = read_data("brick_20.exo");
  EXPECT_EQ(mesh.element.name(), "Q2");
  ASSERT_EQ(mesh.num_nodes(), 27);
  expect_noted(mesh, {"1 serendipity cells, of 20 nodes", "Q2 cells of the same shape"});
  // By the 20 shape functions: the middle of the cell is a quarter of the sum of the edges' middle nodes less that of the corners.
  const auto &lattice = mesh.element.lattice();
  double middle[3] = {}, found[3] = {};
  for (int a = 0; a < 27; ++a) {
    int halves = 0;
    for (int d = 0; d < 3; ++d) halves += lattice[a][d] == 1;
    for (int d = 0; d < 3; ++d) {
      if (halves < 2) middle[d] += (halves == 0 ? -0.25 : 0.25) * node(mesh, a)[d];
      if (halves == 3) found[d] = node(mesh, a)[d];
    }
  }
  for (int d = 0; d < 3; ++d) EXPECT_NEAR(found[d], middle[d], 1e-15);
  ASSERT_EQ(mesh.sides.size(), 2u);
  EXPECT_EQ(mesh.sides[1].ordinal, std::vector<int>{5});
}

// The same cell written with all of its 27 nodes is the same mesh.
TEST(Serendipity, QuadrilateralsOf8NodesAreThoseOf9)
{
  rpc::test::MshText msh = {
      {"2 1 \"body\"", "1 2 \"left\""},
      {"1 0 0 0", "2 2 0 0", "3 2 2 0", "4 0 2 0", "5 1 -.2 0", "6 2.1 1 0", "7 1 2 0", "8 0 1 0"},
      {"1 8 2 2 0 4 1 8", "2 16 2 1 0 1 2 3 4 5 6 7 8"}};
  const MeshData eight = read_text(msh.text());
  msh.nodes.push_back("9 1.05 .9 0"); // -1/4 of the corners, 1/2 of the middles
  msh.elements[1] = "2 10 2 1 0 1 2 3 4 5 6 7 8 9";
  expect_same_mesh(eight, read_text(msh.text()), "Q8 and Q9");
}

TEST(Partitioned, AMeshThatIsDividedAmongProcessorsIsWhole)
{
  const MeshData whole = read_data("square_41.msh"), parts = read_data("square_partitioned_41.msh");
  EXPECT_EQ(parts.num_cells(), whole.num_cells());
  EXPECT_EQ(parts.blocks, whole.blocks);
  ASSERT_EQ(parts.sides.size(), whole.sides.size());
  for (std::size_t s = 0; s < whole.sides.size(); ++s) {
    EXPECT_EQ(parts.sides[s].name, whole.sides[s].name);
    EXPECT_EQ(parts.sides[s].cell.size(), whole.sides[s].cell.size());
  }
}

TEST(MeshFormats, EndingsMayBeInUpperCase)
{
  const ScratchFile file("MESH.MSH", squares().text());
  EXPECT_EQ(read_gmsh({file.path(), 1, 0}).num_cells(), 2);
}

TEST(SidePlaces, PlanesAndBoxesTakeFacetsOfTheBoundary)
{
  SidePlace roof, wall;
  roof.name = "roof";
  roof.plane = {1, 1.};
  wall.name = "wall";
  wall.box = {1.5, -1, 3, 3};
  const MeshData mesh = with_sides({roof, wall});
  ASSERT_EQ(mesh.sides.size(), 5u);
  EXPECT_EQ(mesh.sides[3].name, "roof");
  EXPECT_EQ(mesh.sides[3].cell.size(), 2u);
  EXPECT_EQ(mesh.sides[4].cell, mesh.sides[1].cell); // right
  EXPECT_EQ(mesh.sides[4].ordinal, mesh.sides[1].ordinal);
}

TEST(SidePlaces, WhatTakesNothingIsRefused)
{
  SidePlace place;
  place.name = "roof";
  place.plane = {1, 1.5};
  expect_error(ExitCode::bad_input, {"\"Mesh->Sides->roof\"", "y = 1.5", "y from 0 to 1"},
               [&] { with_sides({place}); });
  place.plane = {0, 1.}; // between the squares
  expect_error(ExitCode::bad_input, {"no facet of the boundary", "x = 1"}, [&] { with_sides({place}); });
  place.plane = {2, 0.};
  expect_error(ExitCode::bad_input, {"no z"}, [&] { with_sides({place}); });
  place.plane.reset();
  place.surfaces = {1};
  expect_error(ExitCode::bad_input, {"\"Surfaces\" goes with a geometry", "\"Plane\""}, [&] { with_sides({place}); });
  place.surfaces.clear();
  place.box = {0, 0, 1};
  expect_error(ExitCode::bad_input, {"\"Box\" must have 4 numbers", "got 3"}, [&] { with_sides({place}); });
  place.box = {3, -1, 1.5, 3};
  expect_error(ExitCode::bad_input,
               {"must have the lower corner before the upper one, got x from 3 to 1.5", "Write {1.5, -1, 3, 3}"},
               [&] { with_sides({place}); });
  place.box = {0, 0, 1, 1};
  place.name = "left";
  expect_error(ExitCode::bad_input, {"the file has a side of that name"}, [&] { with_sides({place}); });
}

TEST(MeshSummary, AreasNormalsAndQualityAreThoseOfTheSquares)
{
  const rpc::mesh::MeshSummary summary = rpc::mesh::summary_of(read_text(squares().text()));
  EXPECT_NEAR(summary.body.measure, 2, 1e-14);
  EXPECT_NEAR(summary.body.centroid[0], 1, 1e-14);
  EXPECT_NEAR(summary.boundary.measure, 6, 1e-14);
  EXPECT_EQ(summary.least_quality, 1);
  EXPECT_EQ(summary.greatest_edge, 1);
  ASSERT_EQ(summary.sides.size(), 3u);
  EXPECT_NEAR(summary.sides[0].normal[0], -1, 1e-14);
  EXPECT_NEAR(summary.sides[2].centroid[0], 1, 1e-14);
  EXPECT_NEAR(summary.sides[2].measure, 2, 1e-14);
}

} // namespace
} // namespace mesh_formats_test
