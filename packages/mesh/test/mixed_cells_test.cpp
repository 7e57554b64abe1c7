// SPDX-License-Identifier: BSD-3-Clause
// Cells of several kinds, which are divided into simplices: needs no gmsh.

#include "expect_error.hpp"
#include "msh_text.hpp"
#include "rpc/mesh/gmsh.hpp"

namespace mixed_cells_test
{
namespace
{

using rpc::mesh::MeshData;
using rpc::test::expect_noted;
using rpc::test::expect_refused;
using rpc::test::read_text;

using Msh = rpc::test::MshText;

std::string with_element(Msh msh, const std::size_t which, const std::string &line)
{
  msh.elements[which] = line;
  return msh.text();
}

// A wedge beside a pyramid that stand on a quadrilateral each, and share one.
Msh wedge_and_pyramid()
{
  Msh msh;
  msh.names = {"2 1 \"bottom\"", "2 2 \"back\"", "3 3 \"lower\"", "3 4 \"upper\""};
  msh.nodes = {"1 0 0 0", "2 1 0 0", "3 0 1 0", "4 0 0 1", "5 1 0 1", "6 0 1 1", "7 1 1 0.5"};
  msh.elements = {"21 3 2 1 0 1 2 5 4", "22 2 2 2 0 1 2 3", "11 6 2 3 0 1 2 3 4 5 6", "12 7 2 4 0 2 3 6 5 7"};
  return msh;
}

TEST(MixedCells, CellsOfSeveralKindsAreDividedIntoTetrahedra)
{
  const MeshData mesh = read_text(wedge_and_pyramid().text());
  EXPECT_EQ(mesh.element.name(), "P1");
  EXPECT_EQ(mesh.num_cells(), 5);
  EXPECT_EQ(mesh.block, (std::vector<int>{0, 0, 0, 1, 1}));
  ASSERT_EQ(mesh.sides.size(), 2u);
  EXPECT_EQ(mesh.sides[0].cell.size(), 2u); // the quadrilateral
  EXPECT_EQ(mesh.sides[1].cell.size(), 1u);
  expect_noted(mesh, {"1 pyramid and 1 wedge are divided into 5 tetrahedra"});
  // The nodes of the wedge mirrored: its parts are one cell that is turned.
  const MeshData turned = read_text(with_element(wedge_and_pyramid(), 2, "11 6 2 3 0 1 3 2 4 6 5"));
  EXPECT_EQ(turned.num_cells(), 5);
  expect_noted(turned, {"the nodes of 1 cell, cell 11"});
}

TEST(MixedCells, CellsThatCannotBeDividedAreRefused)
{
  expect_refused(with_element(wedge_and_pyramid(), 2, "11 6 2 3 0 1 2 3 4 5 5"),
                 {"wedge 11 of \"lower\" has node 5 twice"});
  expect_refused(with_element(wedge_and_pyramid(), 3, "12 7 2 4 0 2 3 5 6 7"),
                 {"wedge 11 of \"lower\" and pyramid 12 of \"upper\"", "different orders", "2, 3, 5 and 6"});
  expect_refused(with_element(wedge_and_pyramid(), 2, "11 6 2 3 0 1 2 3 5 6 4"),
                 {"wedge 11 of \"lower\", with node 1, is bent so far", "nodes are not in the order of its kind"});
  expect_refused(with_element(wedge_and_pyramid(), 3, "12 7 2 4 0 2 3 6 5 8"), {"node 8", "lacks"});
  expect_refused(with_element(wedge_and_pyramid(), 3, "12 4 2 4 0 3 5 6 7"),
                 {"meets triangles", "3, 5 and 6", "put pyramids between"});
  expect_refused(with_element(wedge_and_pyramid(), 3, "12 17 2 4 0 1 2 3 4 5 1 2 3 4 5 1 2 3 4 5 1 2 3 4 5"),
                 {"\"Hexahedron 27\" in \"upper\"", "one order"});
  expect_refused(with_element(wedge_and_pyramid(), 3, "12 29 2 4 0 1 2 3 4 5 1 2 3 4 5 1 2 3 4 5 1 2 3 4 5"),
                 {"\"Tetrahedron 20\"", "wedges of 6, 15 or 18 and pyramids of 5, 13 or 14 can be read"});
}

// A quadrilateral is cut along its shorter diagonal, whatever the numbers of its nodes.
TEST(MixedCells, QuadrilateralsOfThePlaneAreCutAlongTheirShorterDiagonal)
{
  Msh msh;
  msh.names = {"1 1 \"side\"", "2 2 \"body\""};
  msh.nodes = {"1 0 0 0", "2 1 0 0", "3 1.5 1 0", "4 0.5 1 0", "5 2.5 0 0"};
  msh.elements = {"1 1 2 1 0 1 2", "2 3 2 2 0 1 2 3 4", "3 2 2 2 0 2 5 3"};
  const MeshData mesh = read_text(msh.text());
  EXPECT_EQ(mesh.element.name(), "P1");
  EXPECT_EQ(mesh.cells, (std::vector<int>{1, 4, 2, 1, 2, 3, 1, 3, 0}));
  expect_noted(mesh, {"1 quadrilateral is divided into 2 triangles"});
}

} // namespace
} // namespace mixed_cells_test
