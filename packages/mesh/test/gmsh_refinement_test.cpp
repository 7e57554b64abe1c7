// SPDX-License-Identifier: BSD-3-Clause
// Refined meshes of .geo files: new nodes lie on the geometry.

#include "expect_error.hpp"
#include "parts_measures.hpp"
#include "rpc/mesh/make_mesh.hpp"
#include "rpc/mesh/refinement.hpp"
#include "scratch_file.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace gmsh_refinement_test
{
namespace
{

using namespace rpc;
using mesh::GmshOptions;
using mesh::Mesh;

RCP<const Comm> world()
{
  return Tpetra::getDefaultComm();
}
/// This rank by itself: what it makes is the serial result, there to compare with.
RCP<const Comm> alone()
{
  static const RCP<const Comm> comm = world()->split(world()->getRank(), 0);
  return comm;
}

Mesh made(const std::string &geo, const int order, const int refinements)
{
  const test::ScratchFile file("body.geo", geo);
  GmshOptions options{file.path(), 1, order};
  options.refinements = refinements;
  return mesh::make_mesh(options, world());
}

/// Half a disc of radius 2, its straight side at y = 0.
const std::string half_disc =
    "Point(1) = {0, 0, 0, 1}; Point(2) = {-2, 0, 0, 1}; Point(3) = {2, 0, 0, 1}; Point(4) = {0, -2, 0, 1};\n"
    "Circle(1) = {2, 1, 4}; Circle(2) = {4, 1, 3}; Line(3) = {3, 2}; Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = "
    "{1};\n"
    "Physical Surface(\"body\") = {1}; Physical Curve(\"round\") = {1, 2}; Physical Curve(\"top\") = {3};\n";

/// An eighth of a ball of radius 1.
const std::string octant =
    "Point(1) = {0, 0, 0, .5}; Point(2) = {1, 0, 0, .5}; Point(3) = {0, 1, 0, .5}; Point(4) = {0, 0, 1, .5};\n"
    "Line(1) = {1, 2}; Line(2) = {1, 3}; Line(3) = {1, 4};\n"
    "Circle(4) = {2, 1, 3}; Circle(5) = {3, 1, 4}; Circle(6) = {4, 1, 2};\n"
    "Curve Loop(1) = {2, -4, -1}; Plane Surface(1) = {1}; Curve Loop(2) = {3, -5, -2}; Plane Surface(2) = {2};\n"
    "Curve Loop(3) = {1, -6, -3}; Plane Surface(3) = {3}; Curve Loop(4) = {4, 5, 6}; Surface(4) = {4} In Sphere {1};\n"
    "Surface Loop(1) = {1, 2, 3, 4}; Volume(1) = {1};\n"
    "Physical Volume(\"body\") = {1}; Physical Surface(\"skin\") = {4}; Physical Surface(\"flat\") = {1, 2, 3};\n";

/// A measure of a body, and what it is.
struct Measure {
  double exact;
  std::function<double(const Mesh &)> of;
};

/// Errors of measures on meshes of one to three refinements, or from `first` on, fall by 2^(2 order) each time.
void expect_order(const std::string &geo, const int order, const std::vector<Measure> &measures,
                  const double tolerance = 0.3, const int first = 1)
{
  std::vector<double> last(measures.size());
  for (int times = first; times < first + 3; ++times) {
    const Mesh mesh = made(geo, order, times);
    for (std::size_t k = 0; k < measures.size(); ++k) {
      const double error = std::abs(measures[k].of(mesh) / measures[k].exact - 1);
      if (times > first) {
        EXPECT_NEAR(std::log2(last[k] / error), 2 * order, tolerance)
            << "order " << order << ", refined " << times << " times, measure " << k;
      }
      last[k] = error;
    }
  }
}

std::function<double(const Mesh &)> side(const std::string &name)
{
  return [name](const Mesh &mesh) { return test::side_measure(mesh, name); };
}

double body(const Mesh &mesh)
{
  return test::body_measure(mesh);
}

TEST(GmshRefinement, HalfDiscConvergesToItsArea)
{
  for (const int order : {1, 2}) {
    expect_order(half_disc, order, {{2 * M_PI, body}, {2 * M_PI, side("round")}});
    EXPECT_NEAR(test::side_measure(made(half_disc, order, 2), "top"), 4, 1e-13);
  }
}

TEST(GmshRefinement, QuadrilateralsOfTheHalfDiscDoSo)
{
  const std::string geo = half_disc + "Recombine Surface {1}; Mesh.SubdivisionAlgorithm = 1;\n";
  for (const int order : {1, 2}) expect_order(geo, order, {{2 * M_PI, body}});
}

/// On the edges between the skin and the planes new nodes lie on both.
TEST(GmshRefinement, OctantConvergesToItsVolumeAndSides)
{
  for (const int order : {1, 2})
    expect_order(octant, order, {{M_PI / 6, body}, {M_PI / 2, side("skin")}, {3 * M_PI / 4, side("flat")}}, 0.5);
}

TEST(GmshRefinement, NodesOfTheSkinLieOnTheSphere)
{
  for (const int order : {1, 2}) {
    const Mesh mesh = made(octant, order, 2);
    const auto coords = to_host(mesh.coords);
    const auto nodes = mesh.nodes_of("skin", "test");
    for (const LO n : nodes)
      EXPECT_NEAR(std::hypot(coords(n, 0), coords(n, 1), coords(n, 2)), 1, 1e-9); // of gmsh's own nodes
    EXPECT_GT(sum_all(mesh.comm(), GO(nodes.size())), 100);
  }
}

/// A quarter of a cylinder, its end extruded. @param end  commands for the mesh of the end
std::string quarter_of_a_cylinder(const std::string &end)
{
  return "Point(1) = {0, 0, 0, .5}; Point(2) = {1, 0, 0, .5}; Point(3) = {0, 1, 0, .5}; Line(1) = {1, 2};\n"
         "Circle(2) = {2, 1, 3}; Line(3) = {3, 1}; Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};\n" +
         end +
         "out[] = Extrude {0, 0, 2} { Surface{1}; Layers{2}; Recombine; };\n"
         "Physical Volume(\"body\") = {out[1]}; Physical Surface(\"ends\") = {1, out[0]};\n";
}

/// Hexahedra: curved quadrilateral faces, whose middles move too. Wedges: their curved quadrilaterals have become triangles.
TEST(GmshRefinement, ExtrudedQuarterOfACylinderConverges)
{
  for (const char *const end : {"Recombine Surface {1}; Mesh.SubdivisionAlgorithm = 1;\n", ""})
    for (const int order : {1, 2})
      expect_order(quarter_of_a_cylinder(end), order, {{M_PI / 2, body}, {M_PI / 2, side("ends")}});
}

/// Curves without closed formulas: gmsh tells points of them. Half an ellipse under half a circle.
TEST(GmshRefinement, EllipseConvergesToItsArea)
{
  const std::string geo =
      "Point(1) = {0, 0, 0, .5}; Point(2) = {-2, 0, 0, .5}; Point(3) = {2, 0, 0, .5}; Point(4) = {0, -1, 0, .5};\n"
      "Ellipse(1) = {2, 1, 3, 4}; Ellipse(2) = {4, 1, 3, 3}; Line(3) = {3, 2};\n"
      "Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};\n";
  for (const int order : {1, 2}) expect_order(geo, order, {{M_PI, body}}, 0.5);
}

/// Surfaces without closed formulas, of OpenCASCADE, and the curves on which they meet planes.
TEST(GmshRefinement, FrustumOfAConeConverges)
{
  const std::string geo = "SetFactory(\"OpenCASCADE\");\nCone(1) = {0, 0, 0, 0, 0, 1, 1, 0.5};\n"
                          "MeshSize {:} = 0.4;\nMesh.HighOrderOptimize = 1;\nPhysical Volume(\"body\") = {1};\n";
  for (const int order : {1, 2}) expect_order(geo, order, {{M_PI * 1.75 / 3, body}}, 0.5, 0);
}

TEST(GmshRefinement, TheSameOnAnyNumberOfRanks)
{
  for (const int order : {1, 2}) {
    const test::ScratchFile file("body.geo", octant);
    GmshOptions options{file.path(), 1, order};
    options.refinements = 1;
    const Mesh mesh = mesh::make_mesh(options, world());
    const Mesh serial = mesh::make_mesh(options, alone());
    const auto coords = to_host(mesh.coords), all = to_host(serial.coords);
    std::vector<LO> node_of(serial.num_local_nodes());
    for (LO n = 0; n < serial.num_local_nodes(); ++n) node_of[serial.node_id(n)] = n;
    for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
      for (int d = 0; d < 3; ++d) EXPECT_NEAR(coords(n, d), all(node_of[mesh.node_id(n)], d), 1e-14);
  }
}

TEST(GmshRefinement, HasNoCoarserMeshByGmsh)
{
  GmshOptions options{"body.geo", 1, 0};
  options.refinements = 1;
  EXPECT_FALSE(mesh::coarser(options, 2));
}

TEST(CoarserGeometry, IsOnSomeRanksWhereItHasFewerCells)
{
  const test::ScratchFile file(
      "body.geo", "Point(1) = {0, 0, 0, 1}; l[] = Extrude {1, 0, 0} { Point{1}; Layers{1}; };\n"
                  "s[] = Extrude {0, 1, 0} { Curve{l[1]}; Layers{1}; }; Physical Surface(\"body\") = {s[1]};\n");
  const GmshOptions options{file.path(), 1, 1};
  const Mesh mesh =
      mesh::make_mesh(mesh::coarser(options, 2).value(), world()); // two triangles, whatever the sizes are
  EXPECT_EQ(sum_all(*world(), GO(mesh.num_owned_cells)), 2);
  EXPECT_EQ(mesh.owned_nodes->getGlobalNumElements(), 4U);
  if (world()->getSize() > 2)
    test::expect_error(ExitCode::bad_mesh, {"2 cells cannot be divided among"},
                       [&] { mesh::make_mesh(options, world()); });
}

} // namespace
} // namespace gmsh_refinement_test
