// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/contact_nodes.hpp"

#include "drawn_mesh.hpp"
#include "expect_error.hpp"
#include "touching_box.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace contact_nodes_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using contact::Normal;

TEST(ContactNodes, AreNoneWithoutSides)
{
  const auto c = nodes_of(body(), {});
  EXPECT_EQ(c.num_sides(), 0);
  EXPECT_EQ(c.size(), 0);
  EXPECT_EQ(c.num_total, 0);
}

TEST(ContactNodes, OfSeveralSidesComeSideBySideEachWithItsOwnLaw)
{
  const auto d = body();
  auto floor = touching("bottom"), wall = touching("left");
  floor.yield_stress = ScalarField("1+x", [](const Point &x) { return 1 + x[0]; });
  floor.gap = ScalarField(0.1);
  floor.penalty = 10;
  wall.yield_stress = ScalarField(7.);
  wall.gap = ScalarField("y-1", [](const Point &x) { return x[1] - 1; });
  wall.penalty = 20;
  const auto c = nodes_of(d, {floor, wall});
  const Comm &comm = d.mesh->comm();
  ASSERT_EQ(c.num_sides(), 2);
  EXPECT_EQ(c.first(0), 0);
  EXPECT_EQ(c.first(2), c.size());
  EXPECT_EQ(sum_all(comm, GO(c.first(1))), 5);
  EXPECT_EQ(sum_all(comm, GO(c.first(2) - c.first(1))), 3);
  EXPECT_EQ(c.num_total, 8);
  EXPECT_EQ(c.num_fixed, 0);
  const auto coords = to_host(d.mesh->coords);
  const auto node = to_host(c.node);
  const auto yield = to_host(c.law.yield), penalty = to_host(c.given_penalty), weight = to_host(c.weight);
  double length[2] = {0, 0};
  GO at_corner = 0;
  for (int side = 0; side < 2; ++side) {
    for (LO i = c.first(side); i < c.first(side + 1); ++i) {
      const double x = coords(node(i), 0), y = coords(node(i), 1);
      EXPECT_TRUE(i == c.first(side) || node(i - 1) < node(i)); // ascending
      EXPECT_EQ(side == 0 ? y : x, 0);
      EXPECT_NEAR(yield(i), side == 0 ? 1 + x : 7, 1e-15);
      EXPECT_EQ(penalty(i), side == 0 ? 10 : 20);
      length[side] += weight(i);
      if (x == 0 && y == 0) ++at_corner;
    }
  }
  EXPECT_EQ(sum_all(comm, at_corner), 2); // one node, two points
  EXPECT_NEAR(sum_all(comm, length[0]), 2, 1e-14);
  EXPECT_NEAR(sum_all(comm, length[1]), 1, 1e-14);
  expect_points(
      d, c,
      [](const Point &) {
        return Expected{{0, -1, 0}, 0.1};
      },
      0);
  expect_points(
      d, c,
      [](const Point &x) {
        return Expected{{-1, 0, 0}, x[1] - 1};
      },
      1);
}

TEST(ContactNodes, StiffnessIsYoungsModulusOverTheDiameterOfTheBody)
{
  const auto d = body();
  const auto scaling = to_host(
      contact::contact_nodes(d, {touching("bottom")}, fem::dirichlet_dofs(d, {}), fem::Material{70, 0.2}).scaling);
  for (std::size_t i = 0; i < scaling.extent(0); ++i) EXPECT_NEAR(scaling(i), 70 / std::sqrt(5.), 1e-13 * 70);
}

TEST(ContactNodes, StiffnessIsThatOfTheHardestCellAroundTheNode)
{
  const auto d = fem::discretize(rpc::test::distributed(rpc::test::drawn({"abb"})));
  for (const double of_b : {0.5, 200.}) {
    fem::Materials materials(fem::Material{20, 0.3});
    materials.block["b"] = fem::Material{of_b, 0.45};
    const auto c =
        contact::contact_nodes(d, {touching("a bottom"), touching("b bottom")}, fem::dirichlet_dofs(d, {}), materials);
    const auto coords = to_host(d.mesh->coords);
    const auto node = to_host(c.node);
    const auto scaling = to_host(c.scaling);
    for (LO i = 0; i < c.size(); ++i) {
      const double x = coords(node(i), 0);
      const double modulus = x < 0.5 ? 20 : x > 1.5 ? of_b : std::max(20., of_b);
      EXPECT_NEAR(scaling(i), modulus / std::sqrt(10.), 1e-13 * modulus) << x;
    }
  }
}

TEST(ContactNodes, FixedNormalTakesTheGapAlongItself)
{
  const auto d = body();
  auto options = touching("bottom");
  options.normal = Normal::fixed;
  options.direction = {0.6, -0.8, 0};
  options.gap = ScalarField("x/4", [](const Point &x) { return x[0] / 4; });
  expect_points(d, nodes_of(d, {options}), [](const Point &x) { return Expected{{0.6, -0.8, 0}, x[0] / 4}; });
}

TEST(ContactNodes, TailOfAnExponentialIsNoGap)
{
  const auto d = body();
  const auto coords = to_host(d.mesh->coords);
  for (const double sign : {1., -1.}) {
    auto options = touching("bottom");
    options.gap = ScalarField("tail", [sign](const Point &x) { return sign * std::exp(-60 * x[0]); });
    const auto c = nodes_of(d, {options});
    const auto gap = to_host(c.gap), free_gap = to_host(c.free_gap);
    const auto node = to_host(c.node);
    for (LO i = 0; i < c.size(); ++i) { // 1, 9e-14, 9e-27 and then below 1e-30 of the diameter
      const double x = coords(node(i), 0);
      EXPECT_EQ(gap(i), x < 1.2 ? sign * std::exp(-60 * x) : 0.) << x;
      EXPECT_EQ(free_gap(i), gap(i));
    }
  }
}

TEST(ContactNodes, RefuseBadValuesOfAFurtherSideByItsPath)
{
  const auto d = body();
  auto wall = touching("lft");
  wall.path = "Contact->Sides->wall";
  expect_error(ExitCode::bad_input, {"\"Contact->Sides->wall->Side\"", "\"lft\"", "left, right, bottom, top"}, [&] {
    nodes_of(d, {touching("bottom"), wall});
  });
  wall.side = "left";
  wall.yield_stress = ScalarField("y-0.5", [](const Point &x) { return x[1] - 0.5; });
  expect_error(ExitCode::bad_input, {"\"Contact->Sides->wall->Yield Stress\"", "\"y-0.5\"", "(0, 0)"}, [&] {
    nodes_of(d, {touching("bottom"), wall});
  });
  wall.yield_stress = ScalarField(inf);
  wall.gap = ScalarField("1/x", [](const Point &x) { return 1 / x[0]; });
  expect_error(ExitCode::bad_input, {"\"Contact->Sides->wall->Gap\"", "\"1/x\"", "inf"}, [&] {
    nodes_of(d, {touching("bottom"), wall});
  });
}

TEST(ContactNodes, PrescribedNormalDisplacementTakesANodeOutOfTheSolution)
{
  const auto d = body();
  const auto held = fem::dirichlet_dofs(d, {{"left", "left", {ScalarField(0.), ScalarField(-0.1)}}});
  auto options = touching("bottom");
  options.yield_stress = ScalarField(3.);
  const auto c = contact::contact_nodes(d, {options}, held);
  EXPECT_EQ(c.num_total, 5);
  EXPECT_EQ(c.num_fixed, 1);
  // Pressed by 0.1 into what cannot give way.
  expect_error(ExitCode::no_solution, {"(0, 0)", "0.1", "\"bottom\""},
               [&] { contact::contact_nodes(d, {touching("bottom")}, held); });
}

TEST(ContactNodes, OfOneSideMayBeHeldWhileThoseOfAnotherAreFree)
{
  // The left side is held in x: its points are fixed, and its corner moves along the bottom's normal alone.
  const auto d = body();
  auto floor = touching("bottom"), wall = touching("left");
  floor.normal = Normal::fixed;
  floor.direction = {0.6, -0.8, 0};
  floor.gap = ScalarField(0.1);
  wall.gap = ScalarField(0.3);
  fem::DirichletCondition held{"held", "left", {}};
  held.displacement[0] = ScalarField(-0.05);
  const auto c = contact::contact_nodes(d, {floor, wall}, fem::dirichlet_dofs(d, {held}));
  EXPECT_EQ(c.num_fixed, 3);
  const auto coords = to_host(d.mesh->coords);
  const auto node = to_host(c.node);
  const auto fixed = to_host(c.fixed);
  const auto free_gap = to_host(c.free_gap);
  const auto direction = to_host(c.direction), normal = to_host(c.normal);
  for (LO i = 0; i < c.size(); ++i) {
    const bool of_floor = i < c.first(1), corner = of_floor && coords(node(i), 0) == 0;
    EXPECT_EQ(fixed(i) != 0, !of_floor);
    // g - nu . u: the floor's corner goes 0.03 away from it, the wall's points 0.05 towards it
    EXPECT_NEAR(free_gap(i), corner ? 0.1 + 0.6 * 0.05 : of_floor ? 0.1 : 0.3 - 0.05, 1e-15);
    EXPECT_EQ(direction(i, 0), corner || !of_floor ? 0 : 0.6);
    EXPECT_EQ(direction(i, 1), of_floor ? -0.8 : 0);
    EXPECT_NEAR(normal(i, 0), of_floor ? 0.6 : -1, 1e-15);
  }
}

TEST(ContactNodes, PressedIntoARigidFoundationNameItsSide)
{
  const auto d = body();
  fem::DirichletCondition held{"held", "left", {}};
  held.displacement[0] = ScalarField(-0.05);
  expect_error(ExitCode::no_solution, {"(0, 0", "0.05", "\"left\"", "yield stress"}, [&] {
    contact::contact_nodes(d, {touching("bottom"), touching("left")}, fem::dirichlet_dofs(d, {held}));
  });
}

/// w(x, y) at all nodes, for one side each.
RCP<MultiVector> dents_of(const fem::Discretization &d, const std::vector<std::function<double(double, double)>> &sides)
{
  const auto dents = rcp(new MultiVector(d.mesh->owned_nodes, sides.size()));
  const auto to = dents->getLocalViewHost(Tpetra::Access::OverwriteAll);
  const auto coords = to_host(d.mesh->coords);
  for (LO n = 0; n < d.mesh->num_owned_nodes(); ++n)
    for (std::size_t k = 0; k < sides.size(); ++k) to(n, k) = sides[k](coords(n, 0), coords(n, 1));
  return dents;
}

TEST(ContactNodes, DentsMoveTheFoundationAwayAndHardenIt)
{
  const auto d = body();
  auto floor = touching("bottom"), wall = touching("left");
  floor.yield_stress = ScalarField("1+x", [](const Point &x) { return 1 + x[0]; });
  floor.hardening = ScalarField("5+x", [](const Point &x) { return 5 + x[0]; });
  floor.stiffness = ScalarField("2+x", [](const Point &x) { return 2 + x[0]; });
  floor.gap = ScalarField(0.1);
  wall.yield_stress = ScalarField(7.);
  wall.gap = ScalarField(-0.05);
  const auto of_floor = [](const double x, double) { return 0.02 * x; };
  const auto of_wall = [](double, const double y) { return 0.3 + y; };
  const auto dents = dents_of(d, {of_floor, of_wall});
  const auto none = fem::dirichlet_dofs(d, {});
  const auto c = contact::contact_nodes(d, {floor, wall}, none, {}, dents.get()),
             bare = contact::contact_nodes(d, {floor, wall}, none);
  const auto coords = to_host(d.mesh->coords);
  const auto node = to_host(c.node);
  const auto gap = to_host(c.gap), free_gap = to_host(c.free_gap), dent = to_host(c.dent), yield = to_host(c.law.yield),
             hardening = to_host(c.law.hardening), compliance = to_host(c.law.compliance);
  const auto bare_dent = to_host(bare.dent), bare_yield = to_host(bare.law.yield), bare_gap = to_host(bare.free_gap);
  ASSERT_EQ(c.num_total, 8);
  for (LO i = 0; i < c.size(); ++i) {
    const double x = coords(node(i), 0), y = coords(node(i), 1);
    const bool on_floor = i < c.first(1);
    EXPECT_EQ(dent(i), on_floor ? of_floor(x, y) : of_wall(x, y));
    EXPECT_EQ(gap(i), on_floor ? 0.1 : -0.05); // to the surface without dents
    EXPECT_NEAR(free_gap(i), gap(i) + dent(i), 1e-16);
    EXPECT_NEAR(yield(i), on_floor ? 1 + x + (5 + x) * 0.02 * x : 7, 1e-15);
    EXPECT_EQ(hardening(i), on_floor ? 5 + x : 0);
    EXPECT_NEAR(compliance(i), on_floor ? 1 / (2 + x) : 0, 1e-16);
    EXPECT_EQ(bare_dent(i), 0);
    EXPECT_EQ(bare_yield(i), on_floor ? 1 + x : 7);
    EXPECT_EQ(bare_gap(i), gap(i));
  }
}

TEST(ContactNodes, RefuseNumbersOfTheLawThatAreOutOfRangeSomewhere)
{
  const auto d = body();
  auto floor = touching("bottom");
  floor.hardening = ScalarField("1-x", [](const Point &x) { return 1 - x[0]; });
  expect_error(ExitCode::bad_input, {"\"Contact->Hardening\"", ">= 0 [Pa/m]", "got -", "\"1-x\"", ", 0)"},
               [&] { nodes_of(d, {floor}); });
  floor.hardening = ScalarField("1/x", [](const Point &x) { return 1 / x[0]; });
  expect_error(ExitCode::bad_input, {"\"Contact->Hardening\"", "finite", "inf", "\"1/x\"", "(0, 0)"},
               [&] { nodes_of(d, {floor}); });
  floor.hardening = ScalarField(0.);
  floor.stiffness = ScalarField("x", [](const Point &x) { return x[0]; });
  expect_error(ExitCode::bad_input, {"\"Contact->Stiffness\"", "> 0 [Pa/m]", "got 0", "\"x\"", "(0, 0)"},
               [&] { nodes_of(d, {floor}); });
  floor.stiffness = ScalarField("1/x", [](const Point &x) { return 1 / x[0]; }); // rigid at x = 0
  EXPECT_EQ(nodes_of(d, {floor}).num_total, 5);
}

TEST(ContactNodes, MayBePressedIntoAFoundationThatNeverYieldsButGivesWayElastically)
{
  const auto d = body();
  const auto held = fem::dirichlet_dofs(d, {{"left", "left", {ScalarField(0.), ScalarField(-0.1)}}});
  auto floor = touching("bottom");
  floor.stiffness = ScalarField(50.);
  EXPECT_EQ(contact::contact_nodes(d, {floor}, held).num_fixed, 1);
  // A dent as deep as that makes room in a rigid one too.
  const auto dents = dents_of(d, {[](double, double) { return 0.1; }});
  EXPECT_EQ(contact::contact_nodes(d, {touching("bottom")}, held, {}, dents.get()).num_fixed, 1);
}

} // namespace
} // namespace contact_nodes_test
