// SPDX-License-Identifier: BSD-3-Clause
#include "expect_error.hpp"
#include "read_obstacle.hpp"
#include "rpc/contact/between_nodes.hpp"
#include "rpc/contact/surface/height_map.hpp"
#include "rpc/contact/surface/sphere.hpp"
#include "touching_box.hpp"

#include <Teuchos_Array.hpp>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace height_map_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using contact::Obstacle;

using Numbers = Teuchos::Array<double>;
using Function = std::function<double(double, double)>;

/// A .csv of heights of columns x rows places, h apart.
std::string csv(const Function &height, const int columns, const int rows, const double h)
{
  std::ostringstream text;
  text << std::setprecision(17);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) text << height(i * h, j * h) << (i + 1 == columns ? '\n' : ',');
  return text.str();
}

Teuchos::ParameterList map_list(const double spacing, const int dim = 3)
{
  Teuchos::ParameterList list;
  list.set("Type", "height map");
  list.set("File", "heights.csv");
  list.set("Spacing X", spacing);
  Numbers origin(dim, 0.), normal(dim, 0.);
  normal[dim - 1] = 1;
  list.set("Origin", origin);
  list.set("Normal", normal);
  return list;
}

Obstacle read(const Teuchos::ParameterList &list, const std::string &bytes, const int dim = 3)
{
  return read_obstacle(list, dim, bytes);
}

/// The upper side of a sphere of radius 1 below z = 0, whose top is at (0.5, 0.5).
double cap(const double x, const double y)
{
  return std::sqrt(1 - (x - 0.5) * (x - 0.5) - (y - 0.5) * (y - 0.5)) - 1;
}

TEST(HeightMap, OfASphereAgreesWithTheSphereTheFinerTheBetter)
{
  const Obstacle sphere{contact::Sphere{1, false}, {0.5, 0.5, -1}};
  for (const auto &[interpolation, least, of_direction] :
       {std::tuple{"bicubic", 6.5, 3.5}, std::tuple{"bilinear", 3.5, 1.8}}) {
    double before[3] = {};
    for (const int n : {8, 16, 32}) {
      auto list = map_list(1. / n);
      list.set("Interpolation", interpolation);
      const Obstacle map = read(list, csv(cap, n + 1, n + 1, 1. / n));
      double most[3] = {}; // of gaps along fixed and own normals, and of these
      for (int k = 0; k < 100; ++k) {
        const Point x{0.2 + 0.6 * std::fmod(0.618034 * k, 1), 0.2 + 0.6 * std::fmod(0.754878 * k, 1),
                      -0.05 + 0.002 * k};
        const Point down{0.28, 0, -0.96};
        const Point into = *direction_into(map, x), right = *direction_into(sphere, x);
        most[0] = std::max(most[0], std::abs(*distance_along(map, x, down) - *distance_along(sphere, x, down)));
        most[1] = std::max(most[1], std::abs(*distance_along(map, x, into) - *distance_along(sphere, x, right)));
        most[2] = std::max(most[2], length(difference(into, right)));
        if (std::abs(*distance_along(sphere, x, right)) > 5e-3) {
          EXPECT_EQ(lies_in(map, x), lies_in(sphere, x)) << k;
        }
      }
      for (int e = 0; e < 3 && before[0] > 0; ++e)
        EXPECT_GT(before[e] / most[e], e < 2 ? least : of_direction) << interpolation << n << ' ' << e;
      std::copy_n(most, 3, before);
    }
    EXPECT_LT(before[1], 3e-4);
  }
}

TEST(HeightMap, IsPlacedTurnedAndMoved)
{
  const auto ramp = [](const double x, const double y) { return 0.1 * x + 0.3 * y; };
  auto list = map_list(0.5);
  list.set("Origin", Teuchos::Array<std::string>(Teuchos::tuple<std::string>("5", "6", "t")));
  list.set("Angle", 90.); // X runs along y, Y along -x
  const Obstacle map = read(list, csv(ramp, 3, 3, 0.5)).seen_at(0.5);
  EXPECT_NEAR(*distance_along(map, {4.5, 6.25, 3}, {0, 0, -1}), 3 - (1 + 0.1 * 0.25 + 0.3 * 0.5), 1e-14);
  EXPECT_FALSE(distance_along(map, {5.5, 6.25, 3}, {0, 0, -1}));
  EXPECT_NEAR(*distance_along(map.seen_at(1), {4.5, 6.25, 3}, {0, 0, -1}), 1 - 0.1 * 0.25 - 0.3 * 0.5, 1e-14);
  // Hanging from above, where X stays and Y turns round.
  list.set("Angle", 0.);
  list.set("Normal", Numbers(Teuchos::tuple(0., 0., -2.)));
  const Obstacle ceiling = read(list, csv(ramp, 3, 3, 0.5)).seen_at(0.5);
  EXPECT_NEAR(*distance_along(ceiling, {5.25, 5.5, 0}, {0, 0, 1}), 1 - (0.1 * 0.25 + 0.3 * 0.5), 1e-14);
  const Point into = *direction_into(ceiling, {5.25, 5.5, 0});
  EXPECT_NEAR(into[2], 1 / std::sqrt(1.1), 1e-14);
}

TEST(HeightMap, ScaleTurnsTheFilesUnitsIntoTheDecks)
{
  auto list = map_list(0, 2);
  list.set("Scale", 1e-3);
  const Obstacle map = read(list, "x,height\n0,1\n2,3\n4,5\n", 2);
  EXPECT_NEAR(*distance_along(map, {1e-3, 1}, {0, -1}), 1 - 2e-3, 1e-15);
  EXPECT_FALSE(distance_along(map, {5e-3, 1}, {0, -1}));
  list.set("Spacing X", 1.);
  EXPECT_NEAR(*distance_along(read(list, "x,height\n0,1\n2,3\n4,5\n", 2), {0.5, 1}, {0, -1}), 1 - 2e-3, 1e-15);
}

TEST(HeightMap, TellsWhatItIs)
{
  const Obstacle map = read(map_list(0.1), csv(cap, 11, 11, 0.1));
  const std::string told = map.surface->detail->told("mm");
  for (const std::string part :
       {"height map \"heights.csv\" of 11 x 11 heights, bicubic", "1 x 1 mm, spacing 0.1 mm", "rms slope"})
    EXPECT_NE(told.find(part), std::string::npos) << told;
}

TEST(HeightMap, RefusesWhatDoesNotFit)
{
  const auto refuse = [](const std::initializer_list<std::string> &words, const std::string &bytes, const int dim,
                         const std::function<void(Teuchos::ParameterList &)> &change) {
    auto list = map_list(0.1, dim);
    change(list);
    expect_error(ExitCode::bad_input, words, [&] { read(list, bytes, dim); });
  };
  const auto nothing = [](Teuchos::ParameterList &) {};
  const std::string good = "1,2,3\n2,3,4\n";
  refuse({"\"Contact->Obstacle->File\"", "must name a file of heights"}, good, 3,
         [](auto &list) { list.remove("File"); });
  refuse({"must hold 3 numbers, got 0"}, good, 3, [](auto &list) { list.remove("Normal"); });
  refuse({"\"Contact->Obstacle->Spacing X\" must be > 0", "does not say how far"}, good, 3,
         [](auto &list) { list.set("Spacing X", 0.); });
  refuse({"->Spacing Y\"", "got -1"}, good, 3, [](auto &list) { list.set("Spacing Y", -1.); });
  refuse({"->Scale\" must be > 0", "got 0"}, good, 3, [](auto &list) { list.set("Scale", 0.); });
  refuse({"->Angle\"", "in the plane", "got 30"}, "1,2,3\n", 2, [](auto &list) { list.set("Angle", 30.); });
  refuse({"must be a profile", "2 rows of 3"}, good, 2, nothing);
  refuse({"two rows and two columns", "got 1 rows of 3"}, "1,2,3\n", 3, nothing);
  refuse({"must end in .npy", "Gwyddion"}, good, 3, [](auto &list) { list.set("File", "heights.sur"); });
  refuse({"h5py"}, good, 3, [](auto &list) { list.set("File", "heights.h5"); });
  refuse({"SurfaceTopography"}, good, 3, [](auto &list) { list.set("File", "heights.x3p"); });
  refuse({"does not go with"}, good, 3, [](auto &list) { list.set("Radius", 1.); });
}

/// Spacing of the maps below, and where their peaks are.
constexpr double h = 1. / 64;
constexpr double peak[2] = {0.71875, 0.6875};

/// What is seen of a map below a body at rest whose nodes are 0.5 m apart.
/// @param heights  of (x, y)
template <class Heights>
contact::ContactResult seen(const int dim, const contact::Normal normal, const Heights &heights)
{
  auto list = map_list(h, dim);
  list.set("Normal", dim == 2 ? Numbers(Teuchos::tuple(0., 1.)) : Numbers(Teuchos::tuple(0., 0., 1.)));
  const fem::Discretization d = body({dim, 1});
  auto options = touching(dim == 2 ? "bottom" : "back");
  options.normal = normal;
  options.direction = dim == 2 ? Point{0, -1, 0} : Point{0, 0, -1};
  options.obstacle = read(list, csv(heights, 129, dim == 2 ? 1 : 65, h), dim);
  const auto points = nodes_of(d, {options});
  contact::ContactState state;
  state.displacement = rcp(new Vector(d.owned_dofs));
  state.multiplier.normal = DeviceView<double *>("pressure", points.size());
  const auto sides = contact::contact_sides(*d.mesh, {options});
  auto result = contact::contact_result(d, sides, points, state);
  contact::look_between_nodes(d, sides, {options}, points, fem::Material{2000, 0.3}, *state.displacement, result);
  EXPECT_NE(contact::unseen_contact_note(result, {options}, dim, 0).find("unseen contact"), std::string::npos);
  return result;
}

/// Flat at -0.01, with one height of 0.02, that is not seen by nodes.
TEST(HeightMap, ASpikeBetweenNodesIsUnseenAndTheSizeThatWouldSeeItIsTold)
{
  for (const int dim : {2, 3}) {
    const auto spike = [&](const double x, const double y) {
      const bool here = std::abs(x - peak[0]) < h / 2 && (dim == 2 || std::abs(y - peak[1]) < h / 2);
      return here ? 0.02 : -0.01;
    };
    const auto unseen = seen(dim, contact::Normal::fixed, spike).between.unseen;
    EXPECT_NEAR(unseen.depth, 0.02, 1e-9) << dim; // samples meet the nodes of the map
    EXPECT_NEAR(unseen.place[0], peak[0], 1e-9);
    EXPECT_LT(unseen.width, 3 * h);
    EXPECT_GT(unseen.width, h / 2);
  }
}

/// Its slopes are at most 0.02. Along the map's own normals most samples are ruled out by their distance from it, along a fixed one none is.
TEST(HeightMap, AHillBetweenNodesIsTheSameAlongEitherNormal)
{
  for (const int dim : {2, 3}) {
    const auto hill = [&](const double x, const double y) {
      const double across = dim == 2 ? 0 : y - peak[1], squared = (x - peak[0]) * (x - peak[0]) + across * across;
      return 0.002 * std::exp(-squared / (0.08 * 0.08)) - 0.001;
    };
    const auto along = seen(dim, contact::Normal::foundation, hill), fixed = seen(dim, contact::Normal::fixed, hill);
    EXPECT_NEAR(along.between.unseen.depth, 0.001, 1e-9) << dim;
    EXPECT_NEAR(along.between.unseen.width, fixed.between.unseen.width, 1e-9);
    EXPECT_GT(fixed.total.unseen_energy, 0);
    EXPECT_NEAR(along.total.unseen_energy, fixed.total.unseen_energy, 1e-2 * fixed.total.unseen_energy);
  }
}

} // namespace
} // namespace height_map_test
