// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/support.hpp"

#include "drawn_mesh.hpp"
#include "expect_error.hpp"
#include "rpc/contact/surface/sphere.hpp"
#include "rpc/fem/elasticity.hpp"
#include "rpc/mesh/box.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

namespace support_test
{
namespace
{

using namespace rpc;
using contact::ContactOptions;
using contact::Normal;
using contact::Support;
using rpc::test::expect_error;

constexpr double inf = std::numeric_limits<double>::infinity();

fem::DirichletCondition hold(const std::string &side, const std::vector<int> &components)
{
  fem::DirichletCondition condition{side, side, {}};
  for (const int c : components) condition.displacement[c] = ScalarField(0.);
  return condition;
}

ContactOptions on(const std::string &side, const double yield)
{
  ContactOptions options;
  options.path = "Contact->Sides->" + side;
  options.side = side;
  options.yield_stress = ScalarField(yield);
  return options;
}

fem::TractionLoad pull(const std::string &side, const double x, const double y, const double z = 0)
{
  return {side, side, {ScalarField(x), ScalarField(y), ScalarField(z)}};
}

/// A body, what holds it, and what acts on it.
struct Scene {
  std::shared_ptr<const mesh::Mesh> mesh;
  std::vector<fem::DirichletCondition> held;
  std::vector<ContactOptions> foundations;
  std::vector<fem::TractionLoad> tractions;

  Support check() const
  {
    const auto d = fem::discretize(mesh);
    const auto dirichlet = fem::dirichlet_dofs(d, held);
    Vector load(d.owned_dofs);
    for (const auto &t : tractions) fem::add_traction(d, mesh->side(t.side, "test"), t.traction, "test", load);
    return contact::check_support(d, contact::free_parts(d, dirichlet), load,
                                  contact::contact_nodes(d, foundations, dirichlet), foundations);
  }
  void refuses(const std::initializer_list<std::string> &parts) const
  {
    expect_error(ExitCode::no_solution, parts, [&] { check(); });
  }
};

/// 4 m x 1 m, its lower left corner at the origin, scaled.
std::shared_ptr<const mesh::Mesh> plate(const double scale = 1)
{
  const mesh::BoxOptions box{{0, 0}, {4 * scale, scale}, {8, 3}, {2, 1}};
  return std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
}
std::shared_ptr<const mesh::Mesh> brick()
{
  const mesh::BoxOptions box{{0, 0, 0}, {2, 1, 1}, {4, 2, 3}, {3, 1}};
  return std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm()));
}

TEST(Support, OfBodiesJoinedInACornerIsAskedOfBoth)
{
  const auto squares = rpc::test::distributed(rpc::test::drawn({"aa..", "..bb"}));
  Scene scene{squares, {hold("a left", {0, 1})}, {on("b bottom", inf)}, {}};
  scene.refuses({"joins a piece of 2 cells around (1, 1.5)", "2 cells around (3, 0.5)", "at (2, 1)", "rotate"});
  scene.held.push_back(hold("b right", {0}));
  EXPECT_FALSE(scene.check().by_contact_only);
}

TEST(Support, OfAClampedBodyNeedsNoContact)
{
  for (const auto &mesh : {plate(), brick()}) {
    const Support s = Scene{mesh, {hold("left", {0, 1, 2})}, {on("bottom", 1)}, {pull("top", 0, -1e9)}}.check();
    EXPECT_FALSE(s.by_contact_only);
    EXPECT_EQ(s.num_parts, 1);
  }
}

ContactOptions rough(const std::string &side, const double yield, const double mu, const double bound = 0)
{
  ContactOptions options = on(side, yield);
  options.friction_coefficient = ScalarField(mu);
  options.friction_bound = ScalarField(bound);
  return options;
}

TEST(SupportByFriction, HoldsWhatThePressureTimesItsCoefficientIs)
{
  // 4 m long, 1 m high: pressed by 4 * 10 N/m, friction holds 0.3 of it; one more for each of 4 m.
  for (const double bound : {0., 1.}) {
    const double limit = 0.3 * 40 + 4 * bound;
    const auto pushed = [&](const double by, const double yield) {
      return Scene{plate(), {}, {rough("bottom", yield, 0.3, bound)}, {pull("top", 0, -10), pull("left", by, 0)}};
    };
    for (const double yield : {inf, 60.}) {
      EXPECT_TRUE(pushed((1 - 1e-4) * limit, yield).check().by_contact_only);
      EXPECT_TRUE(pushed(-(1 - 1e-4) * limit, yield).check().by_contact_only);
      std::ostringstream holds;
      holds << "friction holds at most " << limit << " [N/m]";
      pushed((1 + 1e-4) * limit, yield)
          .refuses({"support: the load pushes the body over the foundation", holds.str(),
                    "Lower the load, raise the friction"});
      pushed((1 + 1e-10) * limit, yield).refuses({"translation along (1, 0)", "is all that friction holds"});
    }
  }
}

TEST(SupportByFriction, DependsOnThePressuresWhereTheRestDoesNotHoldTheLoad)
{
  const auto depends = [](const double by, const double mu, const double bound) {
    return Scene{plate(), {}, {rough("bottom", inf, mu, bound)}, {pull("top", 0, -10), pull("left", by, 0)}}
        .check()
        .by_coulomb_only;
  };
  EXPECT_TRUE(depends(3, 0.3, 0)); // of 12 N/m
  EXPECT_TRUE(depends(5, 0.3, 1)); // 4 N/m whatever the pressure is
  EXPECT_FALSE(depends(3.9, 0.3, 1));
  EXPECT_FALSE(depends(3.9, 0, 1));
  Scene held{plate(), {hold("left", {0, 1})}, {rough("bottom", inf, 0.3)}, {pull("top", 0, -10)}};
  EXPECT_FALSE(held.check().by_coulomb_only);
}

TEST(SupportByFriction, HoldsInEveryDirectionOfAPlane)
{
  const auto pushed = [&](const double x, const double z) {
    return Scene{
        brick(), {}, {rough("bottom", inf, 0.5)}, {pull("top", 0, -10), pull("left", x, 0), pull("back", 0, 0, z)}};
  };
  // 2 m^2 times 10 Pa times 0.5 = 10 N; sides of 1 m^2 and 2 m^2. The load tilts the body, too: small against its weight.
  EXPECT_TRUE(pushed(3, 0).check().by_contact_only);
  EXPECT_TRUE(pushed(2, 1).check().by_contact_only);
  pushed(11, 0).refuses({"support: the load"});
}

TEST(SupportByFriction, OfTrescaHoldsABodyThatDoesNotTouch)
{
  const auto pulled = [&](const double by) {
    return Scene{plate(), {hold("left", {1})}, {rough("bottom", inf, 0, 2)}, {pull("right", by, 0)}};
  };
  // 2 Pa on 4 m, but for the corner whose normal displacement is prescribed: a quarter of a metre.
  EXPECT_TRUE(pulled(7.49).check().by_contact_only);
  pulled(7.51).refuses({"friction holds at most 7.5 [N/m]"});
}

TEST(Support, OfARolledBodyIsTheFoundationUpToItsLimit)
{
  // 4 m that carry 25 N/m^2 each, at any size of the body.
  for (const double scale : {1., 1e-6, 1e6}) {
    const auto with = [&](const double y) {
      return Scene{plate(scale), {hold("left", {0})}, {on("bottom", 25)}, {pull("top", 0, y)}};
    };
    EXPECT_TRUE(with(-0.99 * 25).check().by_contact_only);
    EXPECT_TRUE(with(-1e-9).check().by_contact_only);
    const Scene too_much = with(-1.01 * 25);
    std::ostringstream pushed, carried;
    pushed << 101 * scale << " [N/m] along (0, -1)";
    carried << "carries at most " << 100 * scale << " [N/m]";
    too_much.refuses({"support: the load pushes the body against side \"bottom\"", pushed.str(), carried.str(),
                      "\"Contact->Sides->bottom->Yield Stress\""});
    with(-25).refuses({"all that the foundation carries", "translation along (0, -1)", "not determined"});
    with(1).refuses({"pulls the body away from the foundation", " [N/m] along (0, 1)", "\"Dirichlet\""});
    with(0).refuses({"nothing presses the body on the foundation against a translation along (0, 1)"});
  }
}

TEST(Support, ComesFromNodesThatFaceTheObstacleAlone)
{
  // Of the bottom's nodes, 0.5 m apart, three face the circle.
  const auto with = [](const double y) {
    Scene scene{plate(), {hold("left", {0})}, {on("bottom", 2)}, {pull("top", 0, y)}};
    scene.foundations[0].obstacle = {contact::Sphere{0.7}, {2, -3, 0}};
    return scene;
  };
  EXPECT_TRUE(with(-0.74).check().by_contact_only);
  with(-0.76).refuses({"the load pushes the body against side \"bottom\"", "carries at most 3 [N/m]"});
}

TEST(Support, OfARigidFoundationHasNoLimit)
{
  const auto with = [](const double y) {
    return Scene{plate(), {hold("left", {0})}, {on("bottom", inf)}, {pull("top", 0, y)}};
  };
  EXPECT_TRUE(with(-1e15).check().by_contact_only);
  EXPECT_TRUE(with(-1e-15).check().by_contact_only);
  with(1e-15).refuses({"pulls the body away from the foundation"});
  with(0).refuses({"nothing presses the body"});
}

/// A plate on a floor between two walls.
Scene tipping(const double yield, const double left, const double right) // [Pa] on the halves of its top
{
  Scene scene{plate(), {}, {on("bottom", yield)}, {}};
  scene.tractions = {{"top",
                      "top",
                      {ScalarField(0.), ScalarField("f", [=](const Point &x) { return x[0] < 2 ? -left : -right; }),
                       ScalarField(0.)}}};
  for (const char *wall : {"left", "right"}) scene.foundations.push_back(on(wall, inf));
  return scene;
}

TEST(Support, OfAFoundationThatHardensInPartsIsThatOfTheRestAtMost)
{
  // Its right half hardens: no load is too much there, but one on the left half is, which turns it about the right one.
  const auto with = [](const double left, const double right) {
    Scene scene = tipping(25, left, right);
    scene.foundations.resize(1);
    scene.held = {hold("bottom", {0})};
    scene.foundations[0].hardening = ScalarField("step", [](const Point &x) { return x[0] > 2.1 ? 3. : 0.; });
    return scene;
  };
  EXPECT_TRUE(with(1, 1e6).check().by_contact_only);
  with(1e6, 1).refuses({"support: the load turns the body about (", "counterclockwise"});
}

TEST(Support, OfABodyBetweenWallsIsJudgedInEveryDirection)
{
  // Walls keep it from moving sideways as far as they press: without a load they press on neither side, but both hold.
  EXPECT_TRUE(tipping(inf, 3, 3).check().by_contact_only);
  EXPECT_TRUE(tipping(10, 3, 3).check().by_contact_only);
  tipping(10, 12, 12).refuses({"against side \"bottom\"", "48 [N/m] along (0, -1)", "at most 40 [N/m]"});
  tipping(10, -3, -3).refuses({"pulls the body away", "12 [N/m] along (0, 1)"});
}

/// A plate with a floor under x < 2 alone, on which it cannot slide, with 10 N/m on 1 m of its top around x = at.
Scene overhanging(const double yield, const double at)
{
  Scene scene{test::distributed(test::drawn({"aabb"})), {hold("a bottom", {0})}, {on("a bottom", yield)}, {}};
  const auto share = [at](const Point &x) { return std::abs(x[0] - at) < 0.5 ? -10. : 0.; };
  for (const char *top : {"a top", "b top"})
    scene.tractions.push_back({top, top, {ScalarField(0.), ScalarField("f", share), ScalarField(0.)}});
  return scene;
}

TEST(Support, OfAnEccentricLoadIsAMatterOfItsMoment)
{
  EXPECT_TRUE(overhanging(inf, 0.5).check().by_contact_only);
  EXPECT_TRUE(overhanging(inf, 1.5).check().by_contact_only);
  overhanging(inf, 3.5).refuses(
      {"turns the body away from the foundation: about (2, 0), clockwise, its moment is 15 [N m/m]",
       "the resultant of the load, 10 [N/m] along (0, -1), passes through (3.5, 0.5). Move the load"});
  EXPECT_TRUE(overhanging(20, 0.5).check().by_contact_only);
  // 2.6 + 5.2 + 2.6 N at 0, 1, 2 m would carry 10 N, though not at 0.5 m
  overhanging(5.2, 0.5).refuses({"the load turns the body about (", "), counterclockwise, with a moment of", "[N m/m]",
                                 "the foundation of side \"a bottom\" carries at most",
                                 "The resultant of the load, 10 [N/m] along (0, -1), passes through (0.5, 0.5)"});
}

TEST(Support, OfABodyThatMaySlideIsNone)
{
  Scene{plate(), {}, {on("bottom", 5)}, {pull("top", 1, -1)}}.refuses(
      {"nothing holds the body against translation along (1, 0), along which the load is 4 [N/m]",
       "Prescribe a displacement"});
  Scene{plate(), {}, {}, {}}.refuses({"translation along (1, 0); translation along (0, 1); rotation about (2, 0.5)"});
  Scene{plate(), {hold("left", {0})}, {}, {pull("top", 0, 2)}}.refuses(
      {"translation along (0, 1), along which the load is 8 [N/m]"});
}

TEST(Support, OfABodyWithForgottenZIsNone)
{
  Scene{brick(), {hold("left", {0}), hold("bottom", {1})}, {on("top", 5)}, {pull("right", 0, 0, 3)}}.refuses(
      {"nothing holds the body against translation along (0, 0, 1), along which the load is 3 [N]."});
}

/// A brick on a floor, kept in the plane by one roller each way.
Scene brick_on_floor(const double yield, const std::function<double(const Point &)> &down)
{
  Scene scene{brick(), {hold("left", {0}), hold("back", {2})}, {on("bottom", yield)}, {}};
  scene.tractions = {{"top", "top", {ScalarField(0.), ScalarField("f", down), ScalarField(0.)}}};
  return scene;
}

TEST(Support, OfABrickOnAFloorCountsForces)
{
  const auto even = [](const double p) { return [p](const Point &) { return -p; }; };
  EXPECT_TRUE(brick_on_floor(3, even(2.97)).check().by_contact_only);
  brick_on_floor(3, even(3.03)).refuses({"6.06 [N] along (0, -1, 0)", "at most 6 [N]"});
}

TEST(Support, OfABrickThatMayTipOverAnEdgeCountsMoments)
{
  // 2 N down in the middle, 1 m from the edge x = 2, and a force in x at a height of 1 m; it cannot slide.
  const auto with = [](const double force) {
    return Scene{brick(), {hold("bottom", {0, 2})}, {on("bottom", inf)}, {pull("top", force / 2, -1)}};
  };
  EXPECT_TRUE(with(1.99).check().by_contact_only);
  with(2.01).refuses({"away from the foundation: about the axis through (2, 0, 0.5) along (0, 0, -1)", "0.01 [N m]"});
}

TEST(Support, OfABrickBetweenFloorAndWallsNeedsNoDirichletCondition)
{
  Scene scene{brick(), {}, {on("bottom", 3)}, {pull("top", 0, -1)}};
  for (const char *side : {"left", "right", "back", "front"}) scene.foundations.push_back(on(side, inf));
  EXPECT_TRUE(scene.check().by_contact_only);
  scene.tractions = {pull("top", 0, 1)};
  scene.refuses({"pulls the body away", "2 [N] along (0, 1, 0)"});
}

TEST(Support, OfEachPartIsItsOwn)
{
  // The left block is clamped, the right one stands on rollers.
  Scene scene{test::distributed(test::drawn({"aa.bb", "aa.bb"})),
              {hold("a left", {0, 1}), hold("b right", {0})},
              {on("a bottom", 5), on("b bottom", 7)},
              {pull("b top", 0, -6.93)}};
  const Support s = scene.check();
  EXPECT_TRUE(s.by_contact_only);
  EXPECT_EQ(s.num_parts, 2);
  scene.tractions = {pull("b top", 0, -7.07)};
  scene.refuses({"the part in block \"b\" (4 cells around (4, 1)) against side \"b bottom\"", "14.14 [N/m]", "14 [N/m]",
                 "\"Contact->Sides->b bottom->Yield Stress\""});
  scene.held.pop_back();
  scene.tractions = {pull("b top", 0, -1)};
  scene.refuses({"nothing holds the part in block \"b\"", "translation along (1, 0)."});
}

TEST(Support, OfAWedgeInAVShapedFoundationNeedsNoDirichletCondition)
{
  // Normals that meet in three different points hold all motions of a body that is pressed into them.
  auto left = on("left", inf), right = on("right", inf);
  left.normal = right.normal = Normal::fixed;
  left.direction = {-0.8, -0.6, 0};
  right.direction = {0.8, -0.6, 0};
  const Scene scene{plate(), {}, {left, right}, {pull("top", 0, -1)}};
  EXPECT_TRUE(scene.check().by_contact_only);
  Scene aside = scene;
  aside.tractions = {pull("top", 0.2, -1)};
  EXPECT_TRUE(aside.check().by_contact_only);
  aside.tractions = {pull("top", 2, -1)};
  aside.refuses({"away from the foundation"});
  aside.tractions = {};
  aside.refuses({"nothing presses the body on the foundation"});
}

TEST(Support, OfABallInABowlIsNotDetermined)
{
  auto floor = on("bottom", inf);
  floor.obstacle = {contact::Sphere{6, true}, {2, 5, 0}};
  floor.normal = Normal::foundation;
  Scene{plate(), {}, {floor}, {pull("top", 0, -1)}}.refuses({"nothing holds the body against rotation about (2, 5)"});
}

TEST(Support, SeesAWeakFloorBesideAStrongWall)
{
  // Half of the weight leans on a slope that is all but rigid.
  auto slope = on("left", 1e14), floor = on("bottom", 1);
  slope.normal = Normal::fixed;
  slope.direction = {-1, 0, 0};
  const Scene scene{plate(), {hold("right", {0})}, {slope, floor}, {pull("top", 0, -0.9)}};
  EXPECT_TRUE(scene.check().by_contact_only);
  Scene heavy = scene;
  heavy.tractions = {pull("top", 0, -1.1)};
  heavy.refuses({"side \"bottom\"", "4.4 [N/m]", "4 [N/m]"});
}

TEST(Support, OfAFoundationThatHardensHasNoLimit)
{
  const auto with = [](const double y, const double hardening, const double stiffness) {
    Scene scene{plate(), {hold("left", {0})}, {on("bottom", 25)}, {pull("top", 0, y)}};
    scene.foundations[0].hardening = ScalarField(hardening);
    scene.foundations[0].stiffness = ScalarField(stiffness);
    return scene;
  };
  EXPECT_TRUE(with(-1e9, 1e-3, inf).check().by_contact_only);
  EXPECT_TRUE(with(-1e9, 1e-3, 7).check().by_contact_only);
  with(1, 1e-3, inf).refuses({"pulls the body away from the foundation"});
  // An elastic foundation that yields without hardening carries what a rigid one does.
  EXPECT_TRUE(with(-0.99 * 25, 0, 7).check().by_contact_only);
  with(-1.01 * 25, 0, 7).refuses({"carries at most 100 [N/m]"});
}

} // namespace
} // namespace support_test
