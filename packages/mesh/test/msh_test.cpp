// SPDX-License-Identifier: BSD-3-Clause
// Reading .msh files: needs no gmsh.

#include "expect_error.hpp"
#include "msh_text.hpp"
#include "rpc/mesh/gmsh.hpp"
#include "same_mesh.hpp"
#include "scratch_file.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <regex>

namespace msh_test
{
namespace
{

using rpc::ExitCode;
using rpc::mesh::GmshOptions;
using rpc::mesh::MeshData;
using rpc::mesh::read_gmsh;
using rpc::test::expect_error;
using rpc::test::expect_noted;
using rpc::test::expect_refused;
using rpc::test::expect_same_mesh;
using rpc::test::read_data;
using rpc::test::read_text;
using rpc::test::ScratchFile;

std::string text_of_data(const std::string &name)
{
  std::ifstream file(rpc::test::path_of_data(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Two blocks of one square each, side by side.
struct Msh : rpc::test::MshText {
  Msh()
      : MshText{{"1 1 \"left\"", "1 2 \"right\"", "2 3 \"steel\"", "2 4 \"rubber\""},
                {"1 0 0 0", "2 1 0 0", "3 2 0 0", "4 0 1 0", "5 1 1 0", "6 2 1 0"},
                {"1 1 2 1 0 1 4", "2 1 2 2 0 3 6", "3 3 2 3 0 1 2 5 4", "4 3 2 4 0 2 3 6 5"}}
  {
  }
};

/// The two squares side by side of Msh, with one list changed.
template <class Change>
std::string squares_with(const Change &change)
{
  Msh msh;
  change(msh);
  return msh.text();
}

TEST(Msh, AllFormatsGiveTheSameMesh)
{
  const MeshData mesh = read_data("sector_41.msh");
  for (const char *const name : {"sector_22.msh", "sector_22_binary.msh", "sector_41_binary.msh", "sector_meshio.msh"})
    expect_same_mesh(read_data(name), mesh, name);
}

TEST(Msh, QuadraticTrianglesFollowTheArc)
{
  const MeshData mesh = read_data("sector_41.msh");
  EXPECT_EQ(mesh.element.name(), "P2");
  EXPECT_EQ(mesh.num_nodes(), 29);
  EXPECT_EQ(mesh.num_cells(), 10);
  EXPECT_EQ(mesh.blocks, std::vector<std::string>{"body"});
  ASSERT_EQ(mesh.sides.size(), 2u);
  EXPECT_EQ(mesh.sides[0].name, "arc");
  EXPECT_EQ(mesh.sides[1].name, "straight");
  ASSERT_EQ(mesh.sides[0].cell.size(), 4u);
  EXPECT_EQ(mesh.sides[1].cell.size(), 4u);
  for (std::size_t f = 0; f < 4; ++f)
    for (const int local : mesh.element.facets()[mesh.sides[0].ordinal[f]]) {
      const int node = mesh.cells[mesh.sides[0].cell[f] * 6 + local];
      EXPECT_NEAR(std::hypot(mesh.coords[2 * node], mesh.coords[2 * node + 1]), 1, 1e-12);
    }
}

// gmsh itself would put both lines into both sides: their elementary number, the second, is the same.
TEST(Msh, EachElementIsInItsOwnPhysicalGroupOnly)
{
  const MeshData mesh = read_text(Msh().text());
  EXPECT_EQ(mesh.element.name(), "Q1");
  EXPECT_EQ(mesh.coords, (std::vector<double>{0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1}));
  EXPECT_EQ(mesh.cells, (std::vector<int>{0, 1, 4, 3, 1, 2, 5, 4}));
  EXPECT_EQ(mesh.blocks, (std::vector<std::string>{"steel", "rubber"}));
  EXPECT_EQ(mesh.block, (std::vector<int>{0, 1}));
  ASSERT_EQ(mesh.sides.size(), 2u);
  EXPECT_EQ(mesh.sides[0].name, "left");
  EXPECT_EQ(mesh.sides[0].cell, std::vector<int>{0});
  EXPECT_EQ(mesh.sides[0].ordinal, std::vector<int>{3});
  EXPECT_EQ(mesh.sides[1].name, "right");
  EXPECT_EQ(mesh.sides[1].cell, std::vector<int>{1});
  EXPECT_EQ(mesh.sides[1].ordinal, std::vector<int>{1});
}

TEST(Msh, NumbersWithGapsInAnyOrderBecomeCompact)
{
  const MeshData mesh = read_text(squares_with([](Msh &msh) {
    msh.nodes = {"60 2 1 0", "10 0 0 0", "30 2 0 0", "40 0 1 0", "20 1 0 0", "50 1 1 0"};
    msh.elements = {"70 3 2 4 8 20 30 60 50", "9 3 2 3 9 10 20 50 40", "7 1 2 2 0 60 30", "1 1 2 1 0 10 40"};
  }));
  expect_same_mesh(mesh, read_text(Msh().text()), "gaps");
}

TEST(Msh, PhysicalPointsAreNodesWithNames)
{
  const MeshData mesh = read_text(squares_with([](Msh &msh) {
    msh.names.push_back("0 6 \"feet\"");
    for (const char *const point : {"5 15 2 6 1 3", "6 15 2 6 2 1", "7 15 2 8 3 2"}) msh.elements.push_back(point);
  }));
  ASSERT_EQ(mesh.points.size(), 1u);
  EXPECT_EQ(mesh.points[0].name, "feet");
  EXPECT_EQ(mesh.points[0].node, (std::vector<int>{0, 2}));
}

TEST(Msh, FacetsListedTwiceCountOnce)
{
  const MeshData mesh = read_text(squares_with([](Msh &msh) { msh.elements.push_back("5 1 2 1 7 4 1"); }));
  EXPECT_EQ(mesh.sides[0].cell.size(), 1u);
}

TEST(Msh, CellsOutsideEveryPhysicalSurfaceAreLeftOut)
{
  const MeshData mesh = read_text(squares_with([](Msh &msh) {
    msh.names = {"2 3 \"steel\""};
    msh.elements = {"3 3 2 3 0 1 2 5 4", "4 3 2 0 0 2 3 6 5"};
  }));
  EXPECT_EQ(mesh.num_cells(), 1);
  EXPECT_EQ(mesh.num_nodes(), 4);
}

TEST(Msh, OptionsThatOnlyGoWithAGeoAreRefused)
{
  const std::string file = std::string(RPC_TEST_DATA_DIR) + "/sector_41.msh";
  expect_error(ExitCode::bad_input, {"only goes with a geometry", "got 2"}, [&] { read_gmsh({file, 2, 0}); });
  expect_error(ExitCode::bad_input, {"order 2", "\"Order\" = 1"}, [&] { read_gmsh({file, 1, 1}); });
  EXPECT_NO_THROW(read_gmsh({file, 1, 2}));
}

TEST(Msh, FilesThatCannotBeOpenedAreBadInput)
{
  expect_error(ExitCode::bad_input, {"\"none.msh\"", "cannot be opened", "No such file"}, [] {
    read_gmsh({"none.msh", 1, 0});
  });
  expect_error(ExitCode::bad_input, "one of .geo, .step", [] { read_gmsh({"none.abc", 1, 0}); });
}

TEST(Msh, WhatIsNoMeshIsRefused)
{
  expect_refused("", {"$MeshFormat"});
  expect_refused("hello", {"$Nodes", "\"hello\""});
  expect_refused("$Nodes\n", {"$MeshFormat"});
  expect_refused("$MeshFormat\n3 0 8\n$EndMeshFormat\n", {"2.2 or 4.1", "\"3\"", "convert"});
  expect_refused("$MeshFormat\nx\n$EndMeshFormat\n", {"version", "\"x\""});
  expect_refused("$MeshFormat\n4.1 0 4\n$EndMeshFormat\n", {"data size must be 8", "got 4"});
  expect_refused("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", {"no $Nodes"});
  const std::string good = Msh().text();
  const auto replaced = [&](const std::string &from, const std::string &to) {
    return std::regex_replace(good, std::regex(from), to);
  };
  expect_refused(replaced("Nodes\n6", "Nodes\n7"), {"$Nodes", "\"$EndNodes\""});
  expect_refused(replaced("Nodes\n6", "Nodes\n5"), {"$Nodes", "counts do not fit", "\"6 2 1 0\""});
  expect_refused(replaced("2 1 0 0", "2 1 zero 0"), {"$Nodes", "a number was expected", "\"zero\""});
  expect_refused(replaced("1 1 2 1 0 1 4", "1 99 2 1 0 1 4"), {"$Elements", "type 99"});
  expect_refused(replaced("2 3 \"steel\"", "5 3 \"steel\""), {"$PhysicalNames", "0 to 3"});
  expect_refused(good + "$Nodes\n", {"$Nodes", "twice"});
  expect_refused(good + "$Comment\n", {"no $EndComment"});
}

TEST(Msh, TruncatedFilesAreRefusedWhereverTheyEnd)
{
  for (const char *const name : {"sector_22.msh", "sector_22_binary.msh", "sector_41.msh", "sector_41_binary.msh"}) {
    const std::string text = text_of_data(name);
    const std::size_t whole = text.find("$EndElements") + std::string("$EndElements").size();
    for (std::size_t size = 0; size < whole; size += 19) {
      SCOPED_TRACE(std::string(name) + ", " + std::to_string(size) + " bytes");
      expect_error(ExitCode::bad_mesh, "mesh.msh\": ", [&] { read_text(text.substr(0, size)); });
    }
  }
}

TEST(Msh, GroupsAreNamedOnceOrNumberedAndFilled)
{
  const MeshData numbered = read_text(squares_with([](Msh &msh) { msh.names.clear(); }));
  EXPECT_EQ(numbered.blocks, (std::vector<std::string>{"3", "4"}));
  EXPECT_EQ(numbered.sides[1].name, "2");
  expect_refused(squares_with([](Msh &msh) { msh.names[1] = "1 2 \"left\""; }),
                 {"physical curves 1 and 2", "\"left\""});
  expect_refused(squares_with([](Msh &msh) { msh.names[1] = "1 2 \"" + std::string(256, 'n') + "\""; }),
                 {"physical curve 2", "at most 255 characters"});
  expect_refused(squares_with([](Msh &msh) { msh.names[2] = std::string("2 3 \"a\0b\"", 9); }),
                 {"physical surface 3", "control character"});
  EXPECT_NO_THROW(read_text(squares_with([](Msh &msh) { msh.names[1] = "1 2 \"" + std::string(255, 'n') + "\""; })));
  expect_noted(read_text(squares_with([](Msh &msh) { msh.names.push_back("2 5 \"air\""); })),
               {"physical surface \"air\"", "no elements"});
  const MeshData blanks = read_text(squares_with([](Msh &msh) { msh.names[1] = "1 2 \"right  \""; }));
  EXPECT_EQ(blanks.sides[1].name, "right");
  expect_noted(blanks, {"physical curve \"right  \" ends in blanks"});
  expect_refused(squares_with([](Msh &msh) {
                   msh.names.resize(2);
                   msh.elements.resize(2);
                 }),
                 {"has no cells in a surface", "Physical Surface(\"body\")"});
  const MeshData whole = read_text(squares_with([](Msh &msh) {
    msh.names.resize(2);
    msh.elements[2] = "3 3 2 0 0 1 2 5 4";
    msh.elements[3] = "4 3 2 0 0 2 3 6 5";
  }));
  EXPECT_EQ(whole.num_cells(), 2);
  EXPECT_EQ(whole.blocks, std::vector<std::string>{"body"});
}

TEST(Msh, CellsMustBeOfOneKindThatCanBeRead)
{
  expect_refused(squares_with([](Msh &msh) { msh.elements.push_back("5 4 2 0 0 1 2 4 5"); }),
                 {"\"body\"", "its volume is 0"});
  expect_refused(squares_with([](Msh &msh) { msh.elements[3] = "4 9 2 4 0 2 3 6 1 4 5"; }),
                 {"one order", "1 of type \"Quadrilateral 4\" in \"steel\"", "1 of type \"Triangle 6\" in \"rubber\""});
  expect_refused(squares_with([](Msh &msh) { msh.elements[3] = "4 16 2 4 0 2 3 6 5 1 1 1 1"; }),
                 {"one order", "\"Quadrilateral 9\" in \"rubber\""});
  expect_refused(squares_with([](Msh &msh) { msh.elements[0] = "1 8 2 1 0 1 4 5"; }),
                 {"\"Line 3\"", "\"left\"", "order 1"});
}

TEST(Msh, NodesMustBeInThePlaneAndApart)
{
  const auto node_6 = [](const std::string &line) { return squares_with([&](Msh &msh) { msh.nodes[5] = line; }); };
  expect_refused(node_6("6 2 1 0.1"), {"node 6 at (2, 1, 0.1)", "z must be 0"});
  expect_refused(node_6("6 2 nan 0"), {"node 6", "finite"});
  expect_refused(node_6("6 2 inf 0"), {"node 6", "finite"});
  expect_refused(node_6("6 2 1e400 0"), {"\"1e400\""});
  expect_refused(node_6("5 2 1 0"), {"two nodes 5"});
  expect_refused(node_6("7 2 1 0"), {"node 6", "lacks"});
  expect_refused(node_6("6 1 1.0000000000001 0"), {"node 5 at (1, 1) and node 6", "one place"});
  const MeshData mesh = read_text(squares_with([](Msh &msh) { msh.nodes.push_back("7 5 5 0"); }));
  EXPECT_EQ(mesh.num_nodes(), 6);
  expect_noted(mesh, {"no cell uses node 7 at (5, 5, 0)", "left out"});
}

TEST(Msh, CellsMustBeConvexCounterclockwiseAndApart)
{
  const auto cell_4 = [](const std::string &line) { return squares_with([&](Msh &msh) { msh.elements[3] = line; }); };
  const MeshData turned = read_text(cell_4("4 3 2 4 0 2 5 6 3"));
  EXPECT_EQ(turned.cells, (std::vector<int>{0, 1, 4, 3, 1, 2, 5, 4}));
  expect_noted(turned, {"nodes of 1 cell, cell 4", "wrong way round"});
  expect_refused(cell_4("4 3 2 4 0 2 3 3 5"), {"cell 4 of \"rubber\"", "node 3 at (2, 0)", "twice"});
  expect_refused(squares_with([](Msh &msh) { msh.nodes[5] = "6 1.2 0.3 0"; }),
                 {"cell 4 of \"rubber\"", "inverted", "180 degrees"});
  expect_refused(squares_with([](Msh &msh) {
                   msh.nodes = {"1 0 0 0", "2 1 0 0", "3 2 0 0", "4 0 1 0", "5 1 1 0", "6 1 0.5 0"};
                   msh.elements[3] = "4 2 2 4 0 2 6 5";
                   msh.elements[2] = "3 2 2 3 0 1 2 5";
                 }),
                 {"cell 4 of \"rubber\"", "degenerate", "area"});
  expect_refused(cell_4("4 3 2 4 0 1 2 5 4"), {"cell 3 of \"steel\" and cell 4 of \"rubber\" overlap"});
  expect_refused(cell_4("3 3 2 4 0 2 3 6 5"), {"cell 3", "\"steel\" and \"rubber\""});
  expect_refused(squares_with([](Msh &msh) { msh.elements.push_back("4 3 2 4 0 2 3 6 5"); }), {"two cells 4"});
}

TEST(Msh, SidesMustLieOnTheBoundary)
{
  const auto line_1 = [](const std::string &line) { return squares_with([&](Msh &msh) { msh.elements[0] = line; }); };
  const auto also = [](const std::string &line) {
    return squares_with([&](Msh &msh) { msh.elements.push_back(line); });
  };
  expect_refused(also("5 1 2 1 0 2 5"), {"line 5 of physical curve \"left\"", "inside the body", "cells 3 and 4"});
  expect_refused(also("5 1 2 1 0 1 5"), {"line 5 of physical curve \"left\"", "nodes 1 and 5", "edge of no cell"});
  expect_refused(also("5 1 2 1 0 1 99"), {"nodes 1 and 99", "edge of no cell"});
  // A group with no facet of the boundary is no side at all.
  const MeshData inner = read_text(line_1("1 1 2 1 0 2 5"));
  ASSERT_EQ(inner.sides.size(), 1u);
  ASSERT_EQ(inner.points.size(), 1u);
  EXPECT_EQ(inner.points[0].name, "left");
  EXPECT_EQ(inner.points[0].node, (std::vector<int>{1, 4}));
  expect_noted(inner, {"physical curve \"left\" lies inside the body", "no side"});
  const MeshData stray = read_text(line_1("1 1 2 1 0 1 5"));
  EXPECT_EQ(stray.sides.size(), 1u);
  EXPECT_TRUE(stray.points.empty());
  expect_noted(stray, {"physical curve \"left\" belongs to no cell"});
}

TEST(Msh, MiddleNodesMustAgree)
{
  const std::string good = text_of_data("sector_22.msh");
  std::smatch line;
  ASSERT_TRUE(std::regex_search(good, line, std::regex(R"(\n(\d+ 8 2 5 \d+ \d+ \d+ )(\d+))")));
  std::string text = good;
  text.replace(line.position(2), line.length(2), "14");
  expect_refused(text, {"physical curve \"arc\"", "middle node 14"});
}

} // namespace
} // namespace msh_test
