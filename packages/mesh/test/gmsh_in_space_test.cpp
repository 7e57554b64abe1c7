// SPDX-License-Identifier: BSD-3-Clause
// Meshing .geo files with volumes.

#include "expect_error.hpp"
#include "measures.hpp"
#include "msh_text.hpp"
#include "rpc/core/tpetra.hpp"
#include "rpc/mesh/gmsh.hpp"
#include "rpc/mesh/make_mesh.hpp"
#include "same_mesh.hpp"
#include "scratch_file.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <memory>

namespace gmsh_in_space_test
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
using rpc::test::integrals;
using rpc::test::ScratchFile;
using rpc::test::volume;
using rpc::test::volume_within_sides;

const std::string octant = std::string(RPC_TEST_DATA_DIR) + "/octant.geo";

/// A box of 1 x 2 x 3, its lower face extruded upwards, before its groups are named.
std::string box(const std::string &extrusion = "")
{
  return "Point(1) = {0, 0, 0, 1}; Point(2) = {1, 0, 0, 1}; Point(3) = {1, 2, 0, 1}; Point(4) = {0, 2, 0, 1};\n"
         "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
         "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n" +
         extrusion;
}
const std::string lift = "out[] = Extrude {0, 0, 3} { Surface{1}; ";
const std::string names = "Physical Volume(\"body\") = {out[1]}; Physical Surface(\"top\") = {out[0]};\n"
                          "Physical Surface(\"rest\") = {1, out[2], out[3], out[4], out[5]};\n";
const std::string tetrahedra = box(lift + "};\n") + names;
const std::string hexahedra =
    box("Transfinite Surface {1}; Recombine Surface {1};\n" + lift + "Layers{2}; Recombine; };\n") + names;

MeshData read_geo(const std::string &text, const double size_factor = 1, const int order = 0)
{
  const ScratchFile file("mesh.geo", text);
  return read_gmsh({file.path(), size_factor, order});
}

int dimension_of(const std::string &text)
{
  const ScratchFile file("mesh.geo", text);
  return rpc::mesh::dimension(GmshOptions{file.path(), 1, 0}, *Tpetra::getDefaultComm());
}

TEST(GmshInSpace, GeoAndItsMshGiveAlikeMeshes)
{
  const MeshData now = read_gmsh({octant, 1, 0}),
                 then = read_gmsh({std::string(RPC_TEST_DATA_DIR) + "/octant_41.msh", 1, 0});
  expect_alike_mesh(now, then, "octant");
  EXPECT_NEAR(volume(now), volume(then), 5e-3 * volume(then)); // of the curved side other nodes lie on the sphere
}

TEST(GmshInSpace, MakesAllFourElements)
{
  for (const char shape : {'P', 'Q'})
    for (const int order : {1, 2}) {
      const MeshData mesh = read_geo(shape == 'P' ? tetrahedra : hexahedra, 1, order);
      SCOPED_TRACE(mesh.element.name());
      EXPECT_EQ(mesh.element.dim, 3);
      EXPECT_EQ(mesh.element.name(), shape + std::to_string(order));
      EXPECT_EQ(mesh.blocks, std::vector<std::string>{"body"});
      EXPECT_NEAR(volume(mesh), 6, 1e-13);
      EXPECT_NEAR(volume_within_sides(mesh), 6, 1e-13);
      ASSERT_EQ(mesh.sides.size(), 2u);
      EXPECT_EQ(mesh.sides[0].name, "top");
      EXPECT_NEAR(integrals(mesh, mesh.sides[0]).normal[2], 2, 1e-13);
      EXPECT_NEAR(integrals(mesh, mesh.sides[1]).normal[2], -2, 1e-13);
    }
}

TEST(GmshInSpace, OrderIsTwoUnlessAskedForWhateverTheGeoSays)
{
  EXPECT_EQ(read_geo(hexahedra + "Mesh.ElementOrder = 1; Mesh.SecondOrderIncomplete = 1;\n").element.name(), "Q2");
  EXPECT_EQ(read_geo(tetrahedra + "Mesh.ElementOrder = 3;\n", 1, 1).element.name(), "P1");
}

TEST(GmshInSpace, CurvedTetrahedraFillABallToTheFourthOrder)
{
  const double exact = std::acos(-1.) / 6;
  const double coarse = exact - volume(read_gmsh({octant, .5, 2})), fine = exact - volume(read_gmsh({octant, .25, 2}));
  EXPECT_LT(std::abs(coarse), 1e-3 * exact);
  EXPECT_LT(std::abs(fine), std::abs(coarse) / 8);
  EXPECT_GT(std::abs(exact - volume(read_gmsh({octant, .25, 1}))), 10 * std::abs(coarse));
}

/// A part of a thin tube. @param size  of cells, which bend so far that some are inverted where it is much larger than the tube is thick
std::string tube(const double size)
{
  return "S = " + std::to_string(size) + "; s = Sin(1.1); c = Cos(1.1);\n" +
         "Point(1) = {0, 1, 0, S}; Point(2) = {-s, 1 - c, 0, S}; Point(3) = {s, 1 - c, 0, S};\n"
         "Point(4) = {.96*s, 1 - .96*c, 0, S}; Point(5) = {-.96*s, 1 - .96*c, 0, S};\n"
         "Circle(1) = {2, 1, 3}; Line(2) = {3, 4}; Circle(3) = {4, 1, 5}; Line(4) = {5, 2};\n"
         "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1}; out[] = Extrude {0, 0, .6} { Surface{1}; };\n"
         "Physical Volume(\"body\") = {out[1]};\n";
}

/// Edges of cells of which the middle node is not in the middle.
int curved_edges(const MeshData &mesh)
{
  const auto &edges = mesh.element.edges();
  int curved = 0;
  for (int cell = 0; cell < mesh.num_cells(); ++cell)
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto at = [&](const int k, const int d) {
        return mesh.coords[3 * mesh.cells[cell * mesh.element.num_nodes() + edges[e][k]] + d];
      };
      double off = 0;
      for (int d = 0; d < 3; ++d) off = std::max(off, std::abs((at(0, d) + at(1, d)) / 2 - at(2, d)));
      if (off > 1e-6) ++curved;
    }
  return curved;
}

TEST(GmshInSpace, MakesCellsStraightWhereThatIsEnough)
{
  for (const double size : {0.3, 0.1}) { // some cells would be inverted, or none
    const ScratchFile file("tube.geo", tube(size));
    GmshOptions options{file.path(), 1, 2};
    EXPECT_GT(curved_edges(read_gmsh(options)), 0) << size;
    options.straight_where_bent = true;
    EXPECT_EQ(curved_edges(read_gmsh(options)) == 0, size == 0.3) << size;
  }
  EXPECT_TRUE(std::get<GmshOptions>(*rpc::mesh::coarser(GmshOptions{"body.geo"}, 2)).straight_where_bent);
}

TEST(GmshInSpace, OpenCascadeTakesPartsAway)
{
  const std::string plate = "SetFactory(\"OpenCASCADE\");\n"
                            "Box(1) = {0, 0, 0, 2, 1, 1}; Cylinder(2) = {2, 0, 0, 0, 1, 0, .5};\n"
                            "BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };\n"
                            "Mesh.MeshSizeMax = .25;\n"
                            "Physical Volume(\"plate\") = {3};\n"
                            "Physical Surface(\"left\") = Surface In BoundingBox {-.1, -.1, -.1, .1, 1.1, 1.1};\n";
  const MeshData mesh = read_geo(plate);
  EXPECT_EQ(mesh.element.name(), "P2");
  EXPECT_EQ(mesh.blocks, std::vector<std::string>{"plate"});
  EXPECT_NEAR(volume(mesh), 2 - std::acos(-1.) / 16, 1e-4);
  ASSERT_EQ(mesh.sides.size(), 1u);
  EXPECT_NEAR(integrals(mesh, mesh.sides[0]).normal[0], -1, 1e-14);
}

TEST(GmshInSpace, DimensionIsKnownBeforeTheMesh)
{
  EXPECT_EQ(dimension_of(tetrahedra), 3);
  EXPECT_EQ(dimension_of(box() + "Physical Surface(\"body\") = {1};\n"), 2);
  expect_error(ExitCode::bad_mesh, "syntax error", [] { dimension_of("Point("); });
}

TEST(GmshInSpace, TetrahedraAreDividedIntoHexahedra)
{
  const MeshData mesh = read_geo(tetrahedra + "Mesh.SubdivisionAlgorithm = 2;\n");
  EXPECT_EQ(mesh.element.name(), "Q2");
  EXPECT_NEAR(volume(mesh), 6, 1e-13);
  EXPECT_NEAR(volume_within_sides(mesh), 6, 1e-13);
}

TEST(GmshInSpace, WedgesAreDividedIntoTetrahedra)
{
  const std::string wedges = box("out[] = Extrude {0, 0, 3} { Surface{1}; Layers{2}; Recombine; };\n") + names;
  for (const int order : {1, 2}) {
    const MeshData mesh = read_geo(wedges, 1, order);
    EXPECT_EQ(mesh.element.name(), "P" + std::to_string(order));
    expect_noted(mesh, {"wedges are divided into", "tetrahedra along diagonals"});
    EXPECT_NEAR(volume(mesh), 6, 1e-13);
    EXPECT_NEAR(volume_within_sides(mesh), 6, 1e-13);
  }
}

/// Hexahedra below, tetrahedra above: gmsh puts pyramids between them.
TEST(GmshInSpace, HexahedraBesideTetrahedraAreDividedToo)
{
  const std::string both = box("Transfinite Surface {1}; Recombine Surface {1};\n" + lift +
                               "Layers{2}; Recombine; };\nmore[] = Extrude {0, 0, 1} { Surface{out[0]}; };\n") +
                           "Physical Volume(\"body\") = {out[1]}; Physical Volume(\"cap\") = {more[1]};\n"
                           "Physical Surface(\"top\") = {more[0]};\n"
                           "Physical Surface(\"rest\") = {1, out[2], out[3], out[4], out[5], more[2], more[3], "
                           "more[4], more[5]};\n";
  for (const int order : {1, 2}) {
    const MeshData mesh = read_geo(both, 1, order);
    EXPECT_EQ(mesh.element.name(), "P" + std::to_string(order));
    EXPECT_EQ(mesh.blocks, (std::vector<std::string>{"body", "cap"}));
    expect_noted(mesh, {"hexahedra and", "pyramids are divided into", "tetrahedra along diagonals"});
    EXPECT_NEAR(volume(mesh), 8, 1e-13);
    EXPECT_NEAR(volume_within_sides(mesh), 8, 1e-13);
    ASSERT_EQ(mesh.sides.size(), 2u);
    EXPECT_NEAR(integrals(mesh, mesh.sides[0]).normal[2], 2, 1e-13);
  }
}

TEST(GmshInSpace, CoarserMeshesHaveFewerCells)
{
  const auto coarse = rpc::mesh::coarser(GmshOptions{octant, .3, 2}, 2);
  ASSERT_TRUE(coarse);
  const auto comm = Tpetra::getDefaultComm();
  const auto fine = rpc::mesh::make_mesh(GmshOptions{octant, .3, 2}, comm);
  const auto mesh = rpc::mesh::make_mesh(*coarse, comm);
  EXPECT_EQ(mesh.dim(), 3);
  EXPECT_LT(3 * rpc::sum_all(*comm, mesh.num_owned_cells), rpc::sum_all(*comm, fine.num_owned_cells));
}

TEST(GmshInSpace, RefusalsNameFileRuleAndRemedy)
{
  const auto refused = [](const std::string &text, const std::initializer_list<std::string> &parts) {
    expect_error(ExitCode::bad_mesh, "mesh.geo\": ", [&] { read_geo(text); });
    expect_error(ExitCode::bad_mesh, parts, [&] { read_geo(text); });
  };
  const std::string solid = box(lift + "};\n"), volume_named = "Physical Volume(\"body\") = {out[1]};\n";
  expect_noted(read_geo(solid + volume_named +
                        "more[] = Extrude {0, 0, 1} { Surface{out[0]}; };\n"
                        "Physical Volume(\"cap\") = {more[1]}; Physical Surface(\"between\") = {out[0]};\n"),
               {"physical surface \"between\" lies inside the body"});
  expect_noted(read_geo(solid + volume_named +
                        "Point(90) = {9, 0, 0, 1}; Line(90) = {2, 90}; s[] = Extrude {0, 0, 1} { Curve{90}; };\n"
                        "Physical Surface(\"away\") = {s[1]};\n"),
               {"physical surface \"away\" belongs to no cell"});
}

TEST(GmshInSpace, GroupsWithoutNamesAreNumberedAndWithoutABlockAllIsTheBody)
{
  const std::string solid = box(lift + "};\n");
  const MeshData whole = read_geo(solid + "Physical Surface(7) = {1};\n");
  EXPECT_EQ(whole.element.dim, 3);
  EXPECT_EQ(whole.blocks, std::vector<std::string>{"body"});
  ASSERT_EQ(whole.sides.size(), 1u);
  EXPECT_EQ(whole.sides[0].name, "7");
  EXPECT_NEAR(volume(whole), 6, 1e-9);
  EXPECT_EQ(read_geo(solid + "Physical Volume(3) = {out[1]};\n").blocks, std::vector<std::string>{"3"});
}

} // namespace
} // namespace gmsh_in_space_test
