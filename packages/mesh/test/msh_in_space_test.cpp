// SPDX-License-Identifier: BSD-3-Clause
// Reading .msh files of bodies in space: needs no gmsh.

#include "expect_error.hpp"
#include "measures.hpp"
#include "msh_text.hpp"
#include "rpc/core/tpetra.hpp"
#include "rpc/mesh/gmsh.hpp"
#include "rpc/mesh/make_mesh.hpp"
#include "same_mesh.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>

namespace msh_in_space_test
{
namespace
{

using rpc::ExitCode;
using rpc::mesh::MeshData;
using rpc::mesh::read_gmsh;
using rpc::test::expect_error;
using rpc::test::expect_noted;
using rpc::test::expect_refused;
using rpc::test::expect_same_mesh;
using rpc::test::integrals;
using rpc::test::path_of_data;
using rpc::test::read_data;
using rpc::test::read_text;
using rpc::test::ScratchFile;
using rpc::test::volume;
using rpc::test::volume_within_sides;

using Point = std::array<double, 3>;

using Msh = rpc::test::MshText;

/// Two tetrahedra with the face 2, 3, 4 in common: cell 11 of "lower" with a facet in "bottom", cell 12 of "upper".
Msh tetrahedra()
{
  return {{"2 1 \"bottom\"", "2 2 \"back\"", "3 3 \"lower\"", "3 4 \"upper\""},
          {"1 0 0 0", "2 1 0 0", "3 0 1 0", "4 0 0 1", "5 1 1 1"},
          {"21 2 2 1 0 1 2 3", "22 2 2 2 0 5 4 3", "11 4 2 3 0 1 2 3 4", "12 4 2 4 0 2 3 4 5"}};
}

/// Two cubes with the face 2, 3, 7, 6 in common.
Msh cubes()
{
  return {
      {"2 1 \"left\"", "2 2 \"right\"", "3 3 \"steel\"", "3 4 \"rubber\""},
      {"1 0 0 0", "2 1 0 0", "3 1 1 0", "4 0 1 0", "5 0 0 1", "6 1 0 1", "7 1 1 1", "8 0 1 1", "9 2 0 0", "10 2 1 0",
       "11 2 1 1", "12 2 0 1"},
      {"21 3 2 1 0 1 4 8 5", "22 3 2 2 0 12 11 10 9", "11 5 2 3 0 1 2 3 4 5 6 7 8", "12 5 2 4 0 2 9 10 3 6 12 11 7"}};
}

/// Its text, with one list changed.
template <class Change>
std::string changed(Msh msh, const Change &change)
{
  change(msh);
  return msh.text();
}

/// Its text, with one element of another line.
std::string with_element(Msh msh, const std::size_t which, const std::string &line)
{
  return changed(std::move(msh), [&](Msh &m) { m.elements[which] = line; });
}

// Nodes of the reference cells, as gmsh's manual numbers them ("Node ordering"), on a lattice of {0, 1, 2}^3.
const std::vector<std::array<int, 3>> tetrahedron_of_gmsh = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0},
                                                             {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
const std::vector<std::array<int, 3>> hexahedron_of_gmsh = {
    {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0},
    {0, 1, 0}, {0, 0, 1}, {2, 1, 0}, {2, 0, 1}, {1, 2, 0}, {2, 2, 1}, {0, 2, 1}, {1, 0, 2}, {0, 1, 2},
    {2, 1, 2}, {1, 2, 2}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}, {1, 1, 1}};

/// Where a curved map puts a point of the lattice.
Point bent(const int i, const int j, const int k)
{
  const double x = i / 2., y = j / 2., z = k / 2.;
  return {x + .1 * y * z, 2 * y + .2 * x * x, 3 * z + .1 * x * y};
}

/// One curved cell of order 2, with the nodes in gmsh's order, numbered from 1.
Msh one_cell(const std::vector<std::array<int, 3>> &lattice, const int type)
{
  Msh msh;
  msh.names = {"3 1 \"body\""};
  std::string element = "1 " + std::to_string(type) + " 2 1 0";
  for (std::size_t n = 0; n < lattice.size(); ++n) {
    const auto &[i, j, k] = lattice[n];
    const Point x = bent(i, j, k);
    std::ostringstream line;
    line.precision(17);
    line << n + 1 << " " << x[0] << " " << x[1] << " " << x[2];
    msh.nodes.push_back(line.str());
    element += " " + std::to_string(n + 1);
  }
  msh.elements = {element};
  return msh;
}

TEST(MshInSpace, AllFormatsGiveTheSameMesh)
{
  const MeshData mesh = read_data("octant_41.msh");
  for (const char *const name : {"octant_22.msh", "octant_22_binary.msh", "octant_41_binary.msh"})
    expect_same_mesh(read_data(name), mesh, name);
}

TEST(MshInSpace, QuadraticTetrahedraFollowTheSphere)
{
  const MeshData mesh = read_data("octant_41.msh");
  EXPECT_EQ(mesh.element, (rpc::mesh::Element{3, 2, rpc::mesh::Shape::simplex}));
  EXPECT_EQ(mesh.num_nodes(), 59);
  EXPECT_EQ(mesh.num_cells(), 20);
  EXPECT_EQ(mesh.blocks, std::vector<std::string>{"body"});
  ASSERT_EQ(mesh.sides.size(), 2u);
  EXPECT_EQ(mesh.sides[0].name, "sphere");
  EXPECT_EQ(mesh.sides[1].name, "flat");
  for (std::size_t f = 0; f < mesh.sides[0].cell.size(); ++f)
    for (const int local : mesh.element.facets()[mesh.sides[0].ordinal[f]]) {
      const double *const x = &mesh.coords[3 * mesh.cells[10 * mesh.sides[0].cell[f] + local]];
      EXPECT_NEAR(std::hypot(x[0], x[1], x[2]), 1, 1e-12);
    }
  const double pi = std::acos(-1.);
  EXPECT_NEAR(volume(mesh), pi / 6, .02 * pi / 6); // with straight edges they have 23 % less
  EXPECT_NEAR(volume_within_sides(mesh), volume(mesh), 1e-14);
  for (const double component : integrals(mesh, mesh.sides[1]).normal) EXPECT_NEAR(component, -pi / 4, 1e-3);
}

TEST(MshInSpace, NodesOfGmshsOrderComeToTheirPlaces)
{
  const auto expect_places = [](const Msh &msh, const std::string &name) {
    const MeshData mesh = read_text(msh.text());
    EXPECT_EQ(mesh.element.name(), name);
    for (int a = 0; a < mesh.element.num_nodes(); ++a) {
      const auto &at = mesh.element.lattice()[a];
      const Point x = bent(at[0], at[1], at[2]);
      for (int d = 0; d < 3; ++d) EXPECT_NEAR(mesh.coords[3 * mesh.cells[a] + d], x[d], 1e-14) << name << ", " << a;
    }
  };
  expect_places(one_cell(tetrahedron_of_gmsh, 11), "P2");
  expect_places(one_cell(hexahedron_of_gmsh, 12), "Q2");
}

TEST(MshInSpace, BlocksAndSidesOfTetrahedra)
{
  const MeshData mesh = read_text(tetrahedra().text());
  EXPECT_EQ(mesh.element, (rpc::mesh::Element{3, 1, rpc::mesh::Shape::simplex}));
  EXPECT_EQ(mesh.coords, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(mesh.cells, (std::vector<int>{0, 1, 2, 3, 1, 2, 3, 4}));
  EXPECT_EQ(mesh.blocks, (std::vector<std::string>{"lower", "upper"}));
  EXPECT_EQ(mesh.block, (std::vector<int>{0, 1}));
  ASSERT_EQ(mesh.sides.size(), 2u);
  EXPECT_EQ(mesh.sides[0].name, "bottom");
  EXPECT_EQ(mesh.sides[0].cell, std::vector<int>{0});
  EXPECT_NEAR(integrals(mesh, mesh.sides[0]).normal[2], -.5, 1e-15);
  EXPECT_EQ(mesh.sides[1].cell, std::vector<int>{1});
  const auto normal = integrals(mesh, mesh.sides[1]).normal;
  for (const int d : {0, 1, 2}) EXPECT_NEAR(normal[d], d == 0 ? -.5 : .5, 1e-15);
}

TEST(MshInSpace, BlocksAndSidesOfHexahedra)
{
  const MeshData mesh = read_text(cubes().text());
  EXPECT_EQ(mesh.element, (rpc::mesh::Element{3, 1, rpc::mesh::Shape::tensor}));
  EXPECT_NEAR(volume(mesh), 2, 1e-14);
  EXPECT_EQ(mesh.blocks, (std::vector<std::string>{"steel", "rubber"}));
  ASSERT_EQ(mesh.sides.size(), 2u);
  for (const int s : {0, 1}) {
    EXPECT_EQ(mesh.sides[s].cell, std::vector<int>{s});
    EXPECT_NEAR(integrals(mesh, mesh.sides[s]).normal[0], s == 0 ? -1 : 1, 1e-15); // the file has them inward too
  }
}

TEST(MshInSpace, WhatIsOutsideEveryVolumeAndPhysicalCurvesDoNotMatter)
{
  const MeshData lower = read_text(changed(tetrahedra(), [](Msh &msh) {
    msh.names.pop_back();
    msh.elements = {msh.elements[0], msh.elements[2], "12 4 2 0 0 2 3 4 5", "1 1 2 7 0 1 2", "2 15 2 8 0 1"};
    msh.names.erase(msh.names.begin() + 1);
  }));
  EXPECT_EQ(lower.num_cells(), 1);
  EXPECT_EQ(lower.num_nodes(), 4);
  EXPECT_EQ(lower.sides.size(), 1u);
}

TEST(MshInSpace, DimensionIsKnownFromTheNamesOfVolumes)
{
  const rpc::mesh::GmshOptions solid{path_of_data("octant_41_binary.msh"), 1, 0};
  const rpc::mesh::GmshOptions flat{path_of_data("sector_22_binary.msh"), 1, 0};
  const auto comm = Tpetra::getDefaultComm();
  EXPECT_EQ(rpc::mesh::dimension(solid, *comm), 3);
  EXPECT_EQ(rpc::mesh::dimension(flat, *comm), 2);
  expect_error(ExitCode::bad_input, "cannot be opened", [&] {
    rpc::mesh::dimension(rpc::mesh::GmshOptions{"none.msh", 1, 0}, *comm);
  });
}

TEST(MshInSpace, RanksTogetherHaveTheWholeMesh)
{
  const MeshData whole = read_data("octant_22.msh");
  const auto comm = Tpetra::getDefaultComm();
  const auto mesh = rpc::mesh::make_mesh(rpc::mesh::GmshOptions{path_of_data("octant_22.msh"), 1, 0}, comm);
  EXPECT_EQ(mesh.dim(), 3);
  rpc::Vector id(mesh.owned_nodes), id_overlap(mesh.overlap_nodes());
  for (rpc::LO n = 0; n < mesh.num_owned_nodes(); ++n) id.replaceLocalValue(n, static_cast<double>(mesh.node_id(n)));
  id_overlap.doImport(id, rpc::Import(mesh.owned_nodes, mesh.overlap_nodes()), Tpetra::INSERT);
  const auto node_id = id_overlap.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto cells = rpc::to_host(mesh.cells);
  const auto coords = rpc::to_host(mesh.coords);
  for (rpc::LO c = 0; c < mesh.num_owned_cells; ++c)
    for (int a = 0; a < 10; ++a)
      EXPECT_EQ(static_cast<int>(node_id(cells(c, a), 0)), whole.cells[10 * mesh.cell_id(c) + a]);
  for (rpc::LO n = 0; n < mesh.num_local_nodes(); ++n)
    for (int d = 0; d < 3; ++d) EXPECT_EQ(coords(n, d), whole.coords[3 * static_cast<std::size_t>(node_id(n, 0)) + d]);
  for (std::size_t s = 0; s < whole.sides.size(); ++s) {
    std::set<std::pair<int, int>> all, mine; // cell id, ordinal
    for (std::size_t f = 0; f < whole.sides[s].cell.size(); ++f)
      all.emplace(whole.sides[s].cell[f], whole.sides[s].ordinal[f]);
    const auto cell = rpc::to_host(mesh.sides[s].cell);
    const auto ordinal = rpc::to_host(mesh.sides[s].ordinal);
    for (std::size_t f = 0; f < cell.extent(0); ++f)
      if (cell(f) < mesh.num_owned_cells) mine.emplace(static_cast<int>(mesh.cell_id(cell(f))), ordinal(f));
    for (const auto &facet : mine) EXPECT_EQ(all.count(facet), 1u);
    EXPECT_EQ(rpc::sum_all(*comm, static_cast<int>(mine.size())), static_cast<int>(all.size()));
  }
}

TEST(MshInSpace, GroupsWithoutNamesAreNamedByTheirNumbers)
{
  const MeshData mesh = read_text(changed(tetrahedra(), [](Msh &msh) { msh.names = {"3 3 \"lower\""}; }));
  EXPECT_EQ(mesh.blocks, (std::vector<std::string>{"lower", "4"}));
  ASSERT_EQ(mesh.sides.size(), 2u);
  EXPECT_EQ(mesh.sides[0].name, "1");
  EXPECT_EQ(mesh.sides[1].name, "2");
  expect_refused(changed(tetrahedra(), [](Msh &msh) { msh.names = {"3 3 \"4\""}; }),
                 {"physical volumes 3 and 4", "share the name \"4\""});
}

TEST(MshInSpace, WithoutAPhysicalVolumeAllCellsAreTheBody)
{
  const auto ungrouped = [](Msh &msh) {
    msh.names.resize(2);
    msh.elements[2] = "11 4 2 0 0 1 2 3 4";
    msh.elements[3] = "12 4 2 0 0 2 3 4 5";
  };
  const MeshData mesh = read_text(changed(tetrahedra(), ungrouped));
  EXPECT_EQ(mesh.num_cells(), 2);
  EXPECT_EQ(mesh.blocks, std::vector<std::string>{"body"});
  ASSERT_EQ(mesh.sides.size(), 2u);
  EXPECT_EQ(mesh.sides[0].name, "bottom");
  // In one of several groups: the others are not part of the body.
  const MeshData part = read_text(changed(tetrahedra(), [](Msh &msh) {
    msh.names = {"2 1 \"bottom\"", "3 3 \"lower\""};
    msh.elements[3] = "12 4 2 0 0 2 3 4 5";
    msh.elements.erase(msh.elements.begin() + 1);
  }));
  EXPECT_EQ(part.num_cells(), 1);
}

TEST(MshInSpace, IsInSpaceWithVolumesHoweverTheyAreGrouped)
{
  const auto comm = Tpetra::getDefaultComm();
  const auto dimension_of = [&](const std::string &text) {
    const ScratchFile file("mesh.msh", text);
    return rpc::mesh::dimension(rpc::mesh::GmshOptions{file.path(), 1, 0}, *comm);
  };
  EXPECT_EQ(dimension_of(tetrahedra().text()), 3);
  EXPECT_EQ(dimension_of(changed(tetrahedra(), [](Msh &msh) { msh.names.clear(); })), 3);
  EXPECT_EQ(dimension_of(changed(tetrahedra(),
                                 [](Msh &msh) {
                                   msh.names.clear();
                                   msh.elements = {"11 4 2 0 0 1 2 3 4", "12 4 2 0 0 2 3 4 5"};
                                 })),
            3);
  const auto surfaces_alone = [](Msh &msh) {
    msh.names.resize(2);
    msh.elements.resize(2);
  };
  expect_error(ExitCode::bad_mesh, {"mesh.msh\": has no volumes", "off the plane", "Physical Volume(\"body\")"},
               [&] { dimension_of(changed(tetrahedra(), surfaces_alone)); });
}

TEST(MshInSpace, GroupsMustBeFilledAndCellsInOneBlock)
{
  expect_noted(read_text(changed(tetrahedra(), [](Msh &msh) { msh.names.push_back("3 5 \"air\""); })),
               {"physical volume \"air\"", "no elements"});
  expect_refused(changed(tetrahedra(), [](Msh &msh) { msh.elements.resize(2); }),
                 {"has no cells in a volume", "Physical Volume(\"body\")"});
  expect_refused(with_element(tetrahedra(), 3, "11 4 2 4 0 2 3 4 5"),
                 {"cell 11", "physical volumes \"lower\" and \"upper\""});
}

TEST(MshInSpace, FacetsMustFitTheCells)
{
  expect_refused(
      with_element(tetrahedra(), 0, "21 9 2 1 0 1 2 3 1 2 3"),
      {"triangles of type \"Triangle 6\" in physical surface \"bottom\"", "cells of type \"Tetrahedron 4\""});
  expect_refused(with_element(tetrahedra(), 0, "21 3 2 1 0 1 2 3 4"),
                 {"quadrilaterals of type \"Quadrilateral 4\"", "\"Tetrahedron 4\""});
}

TEST(MshInSpace, NodesMustBeApartAndUsed)
{
  const auto node_5 = [](const std::string &line) {
    return changed(tetrahedra(), [&](Msh &msh) { msh.nodes[4] = line; });
  };
  expect_refused(node_5("5 1 1 nan"), {"node 5", "finite"});
  expect_refused(node_5("5 1e-13 1 0"), {"node 3 at (0, 1, 0) and node 5", "one place"});
  for (const char *const near :
       {"9 1 1.0000000000001 1", "9 1 1 0.9999999999999", "9 0.9999999999999 1 1.0000000000001"})
    expect_refused(changed(tetrahedra(),
                           [&](Msh &msh) {
                             msh.nodes.push_back(near);
                             msh.elements.push_back("13 4 2 4 0 9 2 3 4");
                           }),
                   {"node 5 at (1, 1, 1) and node 9", "one place"});
  expect_noted(read_text(changed(tetrahedra(), [](Msh &msh) { msh.nodes.push_back("7 5 5 5"); })),
               {"no cell uses node 7 at (5, 5, 5)"});
  EXPECT_NO_THROW(read_text(node_5("5 1 1 1.00001")));
}

TEST(MshInSpace, CellsMustHaveVolumeAndNotOverlap)
{
  const MeshData turned = read_text(with_element(tetrahedra(), 3, "12 4 2 4 0 3 2 4 5"));
  expect_noted(turned, {"nodes of 1 cell, cell 12", "wrong way round"});
  expect_refused(with_element(tetrahedra(), 3, "12 4 2 4 0 2 3 3 5"), {"cell 12 of \"upper\"", "node 3", "twice"});
  expect_refused(changed(tetrahedra(), [](Msh &msh) { msh.nodes[4] = "5 .5 .5 0"; }),
                 {"cell 12 of \"upper\"", "degenerate: its volume is"});
  const std::string overlap = "cell 11 of \"lower\" and cell 13 of \"upper\" overlap: they lie on the same side of the "
                              "face with node 2 at (1, 0, 0), node 3 at (0, 1, 0) and node 4 at (0, 0, 1)";
  const auto third = [](const std::string &node) {
    return changed(tetrahedra(), [&](Msh &msh) {
      msh.nodes.push_back(node);
      msh.elements.push_back("13 4 2 4 0 6 2 3 4");
    });
  };
  expect_refused(third("6 .1 .1 .1"), {overlap}); // three cells at one face
  expect_refused(changed(cubes(), [](Msh &msh) { msh.nodes[8] = "9 1.2 .8 .8"; }),
                 {"cell 12 of \"rubber\"", "inverted: an angle between its edges or faces is 180 degrees or more"});
}

// Four vertices of a tetrahedron are a face in more than one order: the first cell lies behind them along x, the second
// in front of them along y.
TEST(MshInSpace, CellsMustGoInOneOrderAroundAFace)
{
  const Msh msh = {{"3 1 \"body\""},
                   {"1 1 -1 -1", "2 -1 1 -1", "3 1 1 1", "4 -1 -1 1", "5 -5 -1 -1", "6 -5 1 -1", "7 -5 1 1",
                    "8 -5 -1 1", "9 -1 5 -1", "10 -1 5 1", "11 1 5 1", "12 1 5 -1"},
                   {"1 5 2 1 0 5 6 7 8 1 2 3 4", "2 5 2 1 0 2 4 3 1 9 10 11 12"}};
  expect_refused(msh.text(),
                 {"cell 1 of \"body\" and cell 2 of \"body\" go in different orders around the face with node 1"});
}

TEST(MshInSpace, SidesMustLieOnTheBoundary)
{
  const auto with_another = [](Msh msh, const std::string &element) {
    msh.elements.push_back(element);
    return msh.text();
  };
  expect_refused(
      with_another(tetrahedra(), "31 2 2 1 0 4 3 2"),
      {"triangle 31 of physical surface \"bottom\", with the nodes 4, 3 and 2, lies inside the body, between "
       "the cells 11 and 12"});
  expect_refused(with_another(tetrahedra(), "31 2 2 1 0 1 2 5"), {"with the nodes 1, 2 and 5, is a face of no cell"});
  expect_refused(with_another(cubes(), "31 3 2 1 0 2 3 7 6"),
                 {"quadrilateral 31 of physical surface \"left\", with the nodes 2, 3, 7 and 6, lies inside the body"});
}

TEST(MshInSpace, MiddleNodesOfSidesMustBeThoseOfTheirCells)
{
  std::ifstream file(path_of_data("octant_22.msh"), std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::smatch line;
  ASSERT_TRUE(std::regex_search(text, line, std::regex(R"(\n(\d+ 9 2 3 \d+ \d+ \d+ \d+ )(\d+))")));
  const auto position = line.position(2), length = line.length(2);
  expect_refused(text.replace(position, length, "1"),
                 {"triangle ", "physical surface \"sphere\"", "has the middle nodes 1, ", ", but the cell there has "});
}

TEST(MshInSpace, CellsAroundAnEdgeMustShareItsMiddleNode)
{
  Msh msh = {{"3 1 \"body\""},
             {"1 0 0 0", "2 1 0 0", "3 0 1 0", "4 0 0 1", "5 2 2 0", "6 1 1 1", "7 .5 0 0", "8 .5 .5 0", "9 0 .5 0",
              "10 0 0 .5", "11 0 .5 .5", "12 .5 0 .5", "13 1.5 1 0", "14 1 1.5 0", "15 1 .5 .5", "16 .5 1 .5",
              "17 1.5 1.5 .5"},
             {"1 11 2 1 0 1 2 3 4 7 8 9 10 11 12", "2 11 2 1 0 2 5 3 6 13 14 8 15 16 17"}};
  EXPECT_EQ(read_text(msh.text()).num_nodes(), 17);
  msh.nodes.push_back("18 .501 .501 0");
  msh.elements[1] = "2 11 2 1 0 2 5 3 6 13 14 18 15 16 17";
  expect_refused(msh.text(),
                 {"cell 1 of \"body\" and cell 2 of \"body\" have different middle nodes on the edge between "
                  "node 2 at (1, 0, 0) and node 3 at (0, 1, 0)"});
}

TEST(MshInSpace, HexahedraMustShareTheMiddleNodeOfAFace)
{
  Msh msh;
  msh.names = {"3 1 \"body\""};
  std::map<std::array<int, 3>, std::size_t> number;
  for (const int c : {0, 1}) {
    std::string element = std::to_string(c + 1) + " 12 2 1 0";
    for (auto at : hexahedron_of_gmsh) {
      at[0] += 2 * c;
      const auto [node, fresh] = number.emplace(at, number.size() + 1);
      element += " " + std::to_string(node->second);
      std::ostringstream line;
      line << node->second << " " << at[0] << " " << at[1] << " " << at[2];
      if (fresh) msh.nodes.push_back(line.str());
    }
    msh.elements.push_back(element);
  }
  EXPECT_NEAR(volume(read_text(msh.text())), 16, 1e-13);
  const std::string middle = " " + std::to_string(number.at({2, 1, 1})) + " ";
  msh.nodes.push_back("99 2.01 1 1");
  msh.elements[1].replace(msh.elements[1].find(middle), middle.size(), " 99 ");
  expect_refused(msh.text(), {"have different middle nodes on the face with node ", "(2, 0, 0)", "(2, 2, 2)"});
}

} // namespace
} // namespace msh_in_space_test
