// SPDX-License-Identifier: BSD-3-Clause
// Tools by the triangles of their surface: boxes, whose distances are known, and tori, whose meshes come near them.
#include "expect_error.hpp"
#include "read_obstacle.hpp"
#include "rpc/contact/surface/torus.hpp"
#include "rpc/contact/surface/triangles.hpp"

#include <Teuchos_Array.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <sstream>

namespace surface_mesh_test
{
namespace
{

using namespace rpc;
using contact::direction_into;
using contact::distance_along;
using contact::lies_in;
using contact::Obstacle;
using contact::Triangles;
using rpc::test::expect_error;
using Numbers = Teuchos::Array<double>;

std::string text_stl(const Triangles &t)
{
  std::ostringstream out;
  out.precision(9);
  out << "solid tool\n";
  for (const auto &corners : t.corners) {
    out << "facet normal 0 0 0\n outer loop\n";
    for (const int k : corners)
      out << "  vertex " << t.points[k][0] << " " << t.points[k][1] << " " << t.points[k][2] << "\n";
    out << " endloop\nendfacet\n";
  }
  out << "endsolid tool\n";
  return out.str();
}

std::string binary_stl(const Triangles &t)
{
  std::string bytes(80, ' ');
  const auto add = [&](const std::uint32_t value, const int size) {
    for (int k = 0; k < size; ++k) bytes += static_cast<char>(value >> (8 * k) & 255);
  };
  add(static_cast<std::uint32_t>(t.corners.size()), 4);
  for (const auto &corners : t.corners) {
    for (int k = 0; k < 3; ++k) add(0, 4);
    for (const int k : corners)
      for (const double x : t.points[k]) {
        const float value = static_cast<float>(x);
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        add(bits, 4);
      }
    add(0, 2);
  }
  return bytes;
}

/// With half edges 1, 2 and 0.5, about the origin.
Triangles box()
{
  Triangles t;
  for (int n = 0; n < 8; ++n) t.points.push_back({n & 1 ? 1. : -1., n & 2 ? 2. : -2., n & 4 ? 0.5 : -0.5});
  for (const std::array<int, 4> &face :
       {std::array<int, 4>{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    t.corners.push_back({face[0], face[1], face[2]});
    t.corners.push_back({face[0], face[2], face[3]});
  }
  return t;
}

/// Of radii 1 and 0.4 about the z axis, with 2n x n quadrilaterals.
Triangles torus(const int n)
{
  constexpr double pi = 3.14159265358979;
  Triangles t;
  for (int i = 0; i < 2 * n; ++i)
    for (int k = 0; k < n; ++k) {
      const double turn = pi * i / n, up = 2 * pi * k / n, s = 1 + 0.4 * std::cos(up);
      t.points.push_back({s * std::cos(turn), s * std::sin(turn), 0.4 * std::sin(up)});
    }
  const auto at = [&](const int i, const int k) { return (i % (2 * n)) * n + k % n; };
  for (int i = 0; i < 2 * n; ++i)
    for (int k = 0; k < n; ++k) {
      t.corners.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      t.corners.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  return t;
}

Obstacle read(const std::string &bytes, const std::function<void(Teuchos::ParameterList &)> &change = {},
              const int dim = 3)
{
  Teuchos::ParameterList list;
  list.set("Type", "surface mesh");
  list.set("File", "tool.stl");
  list.set("Origin", Numbers(dim, 0.));
  if (change) change(list);
  return rpc::test::read_obstacle(list, dim, bytes);
}

struct Draw {
  std::mt19937 engine{11};
  std::uniform_real_distribution<double> number{-1, 1};

  Point point(const double size) { return {size * number(engine), size * number(engine), size * number(engine)}; }
};

TEST(SurfaceMesh, OfABoxHasItsDistances)
{
  const Point half = {1, 2, 0.5};
  Draw draw;
  for (const std::string &bytes : {text_stl(box()), binary_stl(box())}) {
    const Obstacle tool = read(bytes);
    for (int n = 0; n < 300; ++n) {
      const Point x = draw.point(2.5);
      Point beyond{};
      double inside = -10; // the largest, < 0 inside
      for (int c = 0; c < 3; ++c) {
        inside = std::max(inside, std::abs(x[c]) - half[c]);
        beyond[c] = std::max(0., std::abs(x[c]) - half[c]);
      }
      const double distance = inside < 0 ? inside : length(beyond);
      EXPECT_EQ(lies_in(tool, x), inside < 0);
      const Point direction = direction_into(tool, x).value();
      EXPECT_NEAR(distance_along(tool, x, direction).value(), distance, 1e-12);
      for (int c = 0; c < 3 && inside > 0; ++c)
        EXPECT_NEAR(direction[c], (x[c] > 0 ? -1 : 1) * beyond[c] / distance, 1e-12);
    }
    EXPECT_NEAR(distance_along(tool, {0, 0, 3}, {0, 0, -1}).value(), 2.5, 1e-14); // where two facets of a face meet
    EXPECT_NEAR(distance_along(tool, {1, 2, 3}, {0, 0, -1}).value(), 2.5, 1e-14); // above a corner
    EXPECT_NEAR(distance_along(tool, {0, 0, 0.2}, {0, 0, -1}).value(), -0.3, 1e-14);
    EXPECT_FALSE(distance_along(tool, {0, 0, 3}, {0, 0, 1}));
    EXPECT_FALSE(distance_along(tool, {1.1, 0, 3}, {0, 0, -1}));
    EXPECT_FALSE(lies_in(tool, {0.3, 0.2, 0.5}));
    EXPECT_NEAR(direction_into(tool, {0.3, 0.2, 0.5}).value()[2], -1, 1e-14); // on it
  }
}

TEST(SurfaceMesh, IsPlacedTurnedAndScaled)
{
  const Obstacle tool = read(binary_stl(box()), [](auto &list) {
    list.set("Origin", Numbers(Teuchos::tuple(10., 0., 0.)));
    list.set("Scale", 1e-1);
    list.set("Axis", Numbers(Teuchos::tuple(0., 0., 3.)));         // the file's x stands upright
    list.set("Second Axis", Numbers(Teuchos::tuple(-1., 0., 0.))); // and its y along -x
  });
  EXPECT_NEAR(distance_along(tool, {10, 0, 1}, {0, 0, -1}).value(), 0.9, 1e-14);
  EXPECT_NEAR(distance_along(tool, {9, 0, 0}, {1, 0, 0}).value(), 0.8, 1e-14);
  EXPECT_NEAR(distance_along(tool, {10, 1, 0}, {0, -1, 0}).value(), 0.95, 1e-14);
}

TEST(SurfaceMesh, MayEncloseTheBody)
{
  const Obstacle cavity = read(text_stl(box()), [](auto &list) { list.set("Encloses Body", true); });
  EXPECT_FALSE(lies_in(cavity, {0, 0, 0.3}));
  EXPECT_TRUE(lies_in(cavity, {0, 0, 0.6}));
  EXPECT_NEAR(direction_into(cavity, {0, 0, 0.3}).value()[2], 1, 1e-14);
  EXPECT_NEAR(distance_along(cavity, {0, 0, 0.3}, {0, 0, 1}).value(), 0.2, 1e-14);
  EXPECT_NEAR(distance_along(cavity, {0, 0, 0.6}, {0, 0, 1}).value(), -0.1, 1e-14);
  EXPECT_FALSE(distance_along(cavity, {0, 0, 0.6}, {0, 0, -1})); // out of the foundation
}

/// Largest errors of distances and normals near the surface, and of distances along lines, against the torus itself.
struct Errors {
  double distance = 0, normal = 0, along = 0;
};
Errors errors_of(const int n, const bool smooth)
{
  const Obstacle tool = read(binary_stl(torus(n)), [&](auto &list) { list.set("Smooth Normals", smooth); });
  const Obstacle exact{contact::Torus{{0, 0, 1}, 1, 0.4}, {}};
  Draw draw;
  Errors errors;
  for (int k = 0; k < 300; ++k) {
    const Point x = draw.point(1.5);
    const Point into = direction_into(exact, x).value();
    const double right = distance_along(exact, x, into).value();
    if (std::abs(right) > 0.2) continue;
    const Point found = direction_into(tool, x).value();
    EXPECT_NEAR(length(found), 1, 1e-12);
    errors.normal = std::max(errors.normal, length(difference(found, into)));
    if (std::abs(right) > 0.05) {
      EXPECT_EQ(lies_in(tool, x), right < 0);
    }
    errors.distance = std::max(errors.distance, std::abs(distance_along(tool, x, found).value() - right));
    const auto steep = distance_along(exact, x, {0, 0, -1}), met = distance_along(tool, x, {0, 0, -1});
    if (steep && met && std::hypot(std::hypot(x[0], x[1]) - 1, 0.) < 0.25)
      errors.along = std::max(errors.along, std::abs(*met - *steep));
  }
  return errors;
}

TEST(SurfaceMesh, ComesNearTheBodyThatItIsOf)
{
  for (const bool smooth : {false, true}) {
    const Errors coarse = errors_of(24, smooth), fine = errors_of(48, smooth);
    EXPECT_LT(coarse.distance, 0.02);
    EXPECT_NEAR(std::log2(coarse.distance / fine.distance), 2, 0.5) << smooth;
    EXPECT_NEAR(std::log2(coarse.along / fine.along), 2, 0.6) << smooth;
    EXPECT_GT(std::log2(coarse.normal / fine.normal), smooth ? 1.2 : 0.7) << smooth;
  }
  EXPECT_LT(errors_of(24, true).normal, 0.5 * errors_of(24, false).normal);
}

TEST(SurfaceMesh, TellsInsideFromOutsideAsLinesDo)
{
  const contact::ClosedSurface surface(torus(9)); // coarse: edges and corners are the nearest of most places
  const Obstacle tool = read(text_stl(torus(9)));
  Draw draw;
  int inside = 0;
  for (int n = 0; n < 500; ++n) {
    const Point x = draw.point(1.4), way = scaled(1 / std::sqrt(3.), {1, 1, -1});
    int count = 0;
    for (const auto &crossing : surface.crossings(x, way)) count += crossing.g > 0 ? 1 : 0;
    EXPECT_EQ(lies_in(tool, x), count % 2 == 1) << x[0] << " " << x[1] << " " << x[2];
    inside += count % 2;
  }
  EXPECT_GT(inside, 30);
}

TEST(SurfaceMesh, HasADirectionOnTheEdgeOfAFinWithoutThickness)
{
  Triangles t = box();
  for (const Point &x : {Point{0, 0, 3}, {1, 0, 3}, {0, 1, 3}}) t.points.push_back(x);
  t.corners.push_back({8, 9, 10});
  t.corners.push_back({8, 10, 9});
  EXPECT_NEAR(direction_into(read(text_stl(t)), {0.5, 0, 3}).value()[1], 1, 1e-14);
}

TEST(SurfaceMesh, MayHaveAPartThatPointsInwardsAsACavityOnly)
{
  const auto with = [](Triangles t, const double size, const double x, const bool turned) {
    const Triangles more = box();
    for (const Point &each : more.points) t.points.push_back({x + size * each[0], size * each[1], size * each[2]});
    for (auto each : more.corners) {
      for (int &k : each) k += static_cast<int>(t.points.size() - more.points.size());
      if (turned) std::swap(each[0], each[1]);
      t.corners.push_back(each);
    }
    return t;
  };
  EXPECT_EQ(contact::fault_of(with(box(), 2, 9, false)), "");
  EXPECT_EQ(contact::fault_of(with(box(), 0.5, 0.1, true)), "");
  EXPECT_EQ(contact::fault_of(with(with(box(), 0.5, 0.1, true), 0.2, 0.1, false)), "");
  for (const double size : {0.5, 2.}) // as a whole they have a volume, or none
    EXPECT_EQ(contact::fault_of(with(box(), size, 9, true)).rfind("the 12 facets of the part at (", 0), 0);
  EXPECT_NE(contact::fault_of(with(with(box(), 0.5, 0.1, true), 0.2, 0.1, true)), ""); // within the cavity
}

TEST(SurfaceMesh, RefusesWhatIsNoSurfaceOfABody)
{
  const auto refuse = [](const std::string &bytes, const std::initializer_list<std::string> &words) {
    expect_error(ExitCode::bad_input, words, [&] { read(bytes); });
  };
  const std::string file = "\"Contact->Obstacle->File\": ";
  Triangles t = box();
  t.corners.erase(t.corners.begin() + 2);
  refuse(text_stl(t),
         {file + "in \"tool.stl\" there is a hole", "(1, 2, 0.5)", "must be closed, also below the side", "MeshLab"});
  t = box();
  std::swap(t.corners[4][0], t.corners[4][1]);
  refuse(binary_stl(t), {file, "turn different ways", "both have the edge from (", "MeshLab"});
  t = box();
  t.corners.push_back({0, 1, 1});
  refuse(text_stl(t), {file, "facet 13 at (-1, -2, -0.5) has no area"});
  t = box();
  for (auto &each : t.corners) std::swap(each[0], each[1]);
  refuse(text_stl(t), {file, "all point inwards", "turn them round"});
  refuse(text_stl({}), {file, "must be an STL file", "gmsh tool.msh -save"});
  refuse("", {file, "got an empty one"});
  refuse("ply\nformat ascii 1.0\n", {file + "\"tool.stl\" must be an STL file", "gmsh tool.msh -save"});
  std::string cut = binary_stl(box());
  cut.resize(cut.size() - 20);
  refuse(cut, {file, "cut off"});
  cut = text_stl(box());
  cut.resize(cut.size() - 200);
  refuse(cut, {file, "cut off"});
  std::string bad = text_stl(box());
  refuse(bad.replace(bad.find("vertex -1"), 9, "vertex x1"), {file, "must hold numbers, got \"x1\" in facet 1"});
  bad = text_stl(box());
  refuse(bad.replace(bad.find("vertex -1"), 9, "vertex nan"), {file, "must hold finite numbers", "in facet 1"});
  expect_error(ExitCode::bad_input, {"surface mesh goes with a body in space"}, [] { read(text_stl(box()), {}, 2); });
  expect_error(ExitCode::bad_input, {"\"Contact->Obstacle->File\" must name an STL file, got none"},
               [] { read(text_stl(box()), [](auto &list) { list.set("File", ""); }); });
  expect_error(ExitCode::bad_input, {"\"Contact->Obstacle->Scale\" must be > 0 and finite [-], got -1"},
               [] { read(text_stl(box()), [](auto &list) { list.set("Scale", -1.); }); });
}

} // namespace
} // namespace surface_mesh_test
