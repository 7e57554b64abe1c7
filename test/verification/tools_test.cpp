// SPDX-License-Identifier: BSD-3-Clause
#include "friction_scene.hpp"

#include <filesystem>
#include <fstream>

// Ellipsoids, cones, wedges, flat punches and tori as tools that press a block and move along it.

namespace tools_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

const std::string decks = std::string(RPC_TEST_DECKS) + "/";

/// A tool whose point is at (x, height), or at (x, x/2, height) in space; `place` gives the coordinates as expressions of t.
struct Tool {
  std::string name;
  Assignments shape; // without its point
  std::string point = "Point";
  double height = 0; // of its highest place above its point

  Assignments placed(const std::string &place) const
  {
    Assignments all = joined(shape, {"Contact->Obstacle->" + point + "=" + place});
    return all;
  }
};

Assignments obstacle(const Assignments &parameters)
{
  Assignments all;
  for (const std::string &each : parameters) all.push_back("Contact->Obstacle->" + each);
  return all;
}

std::vector<Tool> plane_tools()
{
  return {{"wedge", obstacle({"Type=wedge", "Normal={0, 1}", "Slope=0.1", "Edge Radius=0.2"})},
          {"sharp cone", obstacle({"Type=cone", "Axis={0, 1}", "Slope=0.1"})},
          {"punch", obstacle({"Type=flat punch", "Normal={0, 2}", "Radius=0.4", "Edge Radius=0.2"})},
          {"ellipse", obstacle({"Type=ellipse", "Semi-Axes={0.2, 2}", "Axis={0, 1}"}), "Centre", 0.2}};
}

std::vector<Tool> space_tools()
{
  return {{"wedge", obstacle({"Type=wedge", "Normal={0, 0, 1}", "Slope=0.1", "Axis={1, 1, 0}"})},
          {"cone", obstacle({"Type=cone", "Axis={0, 0, 1}", "Slope=0.1", "Tip Radius=0.3"})},
          {"punch", obstacle({"Type=flat punch", "Normal={0, 0, 1}", "Radius=0.4", "Edge Radius=0.3"})},
          {"ellipsoid",
           obstacle({"Type=ellipsoid", "Semi-Axes={2, 1, 0.5}", "Axis={1, 1, 0}", "Second Axis={-1, 1, 0}"}), "Centre",
           0.5},
          {"torus", obstacle({"Type=torus", "Axis={0, 0, 1}", "Radius=0.4", "Tube Radius=0.3"}), "Centre", 0.3}};
}

const Assignments in_space = {"Mesh->Lower={-1, -1, 0}", "Mesh->Upper={1, 1, 1}",      "Mesh->Cells={10, 10, 5}",
                              "Mesh->Element=P1",        "Dirichlet->top->Side=front", "Dirichlet->top->Z=0",
                              "Contact->Side=back",      "Contact->Normal=0, 0, -1"};

Solution pressed(const Assignments &assignments)
{
  Solution s = run_scene(decks + "tools.xml", assignments);
  EXPECT_TRUE(s.uzawa.converged) << s.uzawa.reason;
  EXPECT_FALSE(s.failure) << s.failure->reason;
  return s;
}

TEST(Tools, PressAlikeWhetherTheyComeUpOrTheBodyComesDown)
{
  for (const std::string kinematics : {"plane strain", "axisymmetric", "space"}) {
    const bool space = kinematics == "space";
    for (const Tool &tool : space ? space_tools() : plane_tools()) {
      SCOPED_TRACE(tool.name + ", " + kinematics);
      Assignments scene = space ? in_space : Assignments{"Kinematics=" + kinematics};
      if (kinematics == "axisymmetric") scene = joined(scene, {"Mesh->Lower={0, 0}"});
      const std::string across = space ? "0.03, 0.01, " : kinematics == "axisymmetric" ? "0, " : "0.03, ";
      const Solution up = pressed(joined(scene, tool.placed("{" + across + text(0.02 - tool.height) + "}")));
      const Solution down = pressed(joined(joined(scene, tool.placed("{" + across + text(-tool.height) + "}")),
                                           {space ? "Dirichlet->top->Z=-0.02" : "Dirichlet->top->Y=-0.02"}));
      const auto &force = up.contact.total.force;
      EXPECT_GT(force[space ? 2 : 1], 0.01);
      EXPECT_NEAR(up.contact.total.force[space ? 2 : 1] / down.contact.total.force[space ? 2 : 1], 1, 1e-6);
      EXPECT_NEAR(up.contact.total.max_pressure / down.contact.total.max_pressure, 1, 1e-6);
    }
  }
}

TEST(Tools, ThatAreMovedFarAlongARoughSideDragItWithMuTimesTheForce)
{
  constexpr double mu = 0.2;
  for (const bool space : {false, true})
    for (const Tool &tool : space ? space_tools() : plane_tools()) {
      SCOPED_TRACE(tool.name + (space ? " in space" : " in the plane"));
      const std::string height = text(0.02 - tool.height) + " - 0.02*max(0, 1 - t)";
      const std::string place = "{0.1*max(0, t - 1) - 0.1, " + std::string(space ? "0, " : "") + height + "}";
      const Solution s = pressed(joined(
          joined(space ? in_space : Assignments{}, tool.placed(place)),
          {"Contact->Friction Coefficient=" + text(mu), "Contact->Yield Stress=80", "Steps->Times={1, 1.5, 2}"}));
      const auto &force = s.contact.total.force;
      EXPECT_GT(force[space ? 2 : 1], 0.1);
      EXPECT_NEAR(force[0] / force[space ? 2 : 1], mu, 0.02 * mu);
    }
}

TEST(Tools, OfOneShapeByTwoNamesAreOne)
{
  const auto force = [](const Assignments &shape) {
    return pressed(joined({"Contact->Normal=foundation"}, obstacle(shape))).contact.total.force;
  };
  const auto expect_same = [](const std::array<double, 3> &a, const std::array<double, 3> &b) {
    EXPECT_GT(a[1], 1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-8 * a[1]);
  };
  expect_same(force({"Type=circle", "Centre={0.1, -0.48}", "Radius=0.5"}),
              force({"Type=ellipse", "Centre={0.1, -0.48}", "Semi-Axes={0.5, 0.5}"}));
  expect_same(force({"Type=cone", "Point={0.1, 0.02}", "Axis={0, 1}", "Slope=0.1", "Tip Radius=0.1"}),
              force({"Type=wedge", "Point={0.1, 0.02}", "Normal={0, 1}", "Slope=0.1", "Edge Radius=0.1"}));
  expect_same(force({"Type=flat punch", "Point={0.1, 0.02}", "Normal={0, 1}", "Radius=0.5", "Edge Radius=0.5"}),
              force({"Type=circle", "Centre={0.1, -0.48}", "Radius=0.5"})); // none of it is flat
}

/// Writes the torus of space_tools() as triangles, 2n around it and n around its tube.
void write_torus(const std::string &file, const int n)
{
  std::ofstream out(file);
  out.precision(12);
  const auto vertex = [&](const int i, const int k) {
    constexpr double pi = 3.14159265358979;
    const double turn = pi * (i % (2 * n)) / n, up = 2 * pi * (k % n) / n, s = 0.4 + 0.3 * std::cos(up);
    out << "vertex " << s * std::cos(turn) << " " << s * std::sin(turn) << " " << 0.3 * std::sin(up) << "\n";
  };
  out << "solid torus\n";
  for (int i = 0; i < 2 * n; ++i)
    for (int k = 0; k < n; ++k)
      for (const int half : {0, 1}) {
        out << "facet normal 0 0 0\nouter loop\n";
        vertex(i, k);
        vertex(i + 1, k + half);
        vertex(i + 1 - half, k + 1);
        out << "endloop\nendfacet\n";
      }
  out << "endsolid torus\n";
}

TEST(Tools, GivenByTheirTrianglesPressAsTheirShapesDo)
{
  const auto comm = Tpetra::getDefaultComm();
  const std::string file =
      (std::filesystem::current_path() / ("rpc_torus_" + std::to_string(comm->getSize()) + ".stl")).string();
  if (comm->getRank() == 0) write_torus(file, 96); // alone: the others get it from there
  comm->barrier();
  const Assignments place =
      joined(in_space, {"Contact->Yield Stress=80", "Contact->Friction Coefficient=0.2", "Steps->Times={1, 2}"});
  const std::string origin = "{0.03 + 0.02*max(0, t - 1), 0.01, -0.28 - 0.02*max(0, 1 - t)}";
  const Solution shape = pressed(joined(place, space_tools().back().placed(origin)));
  const Solution mesh = pressed(joined(place, obstacle({"Type=surface mesh", "File=" + file, "Origin=" + origin})));
  for (const int c : {0, 2}) {
    EXPECT_GT(shape.contact.total.force[c], 0.1);
    EXPECT_NEAR(mesh.contact.total.force[c] / shape.contact.total.force[c], 1, 0.02) << c;
  }
  comm->barrier();
  if (comm->getRank() == 0) std::filesystem::remove(file);
}

TEST(Tools, ThatReachIntoTheBodyBetweenItsNodesAreSeen)
{
  for (const Tool &tool : plane_tools()) {
    SCOPED_TRACE(tool.name);
    Assignments shape = tool.shape; // narrow, between the nodes at 0.25 and 0.375 of the deck's body from 0 to 1
    for (std::string &each : shape) {
      if (each.find("Radius") != std::string::npos) each = each.substr(0, each.find('=')) + "=0.02";
      if (each.find("Slope") != std::string::npos) each = each.substr(0, each.find('=')) + "=1";
      if (each.find("Semi-Axes") != std::string::npos) each = each.substr(0, each.find('=')) + "={0.2, 0.04}";
    }
    const Solution s = run_scene(
        decks + "tools.xml",
        joined(
            joined(shape, {"Contact->Obstacle->" + tool.point + "={0.3125, " + text(0.01 - tool.height) + "}"}),
            {"Mesh->Lower={0, 0}", "Mesh->Cells={4, 4}", "Contact->Normal=foundation", "Adapt->Estimate Error=true"}));
    ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    EXPECT_EQ(s.contact.total.force[1], 0);
    EXPECT_NEAR(s.contact.total.unseen_penetration, 0.01, 1e-3);
  }
}

} // namespace
} // namespace tools_test
