// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/elasticity.hpp"

#include "bodies.hpp"
#include "rpc/core/parameters.hpp"

#include <limits>

namespace loads_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using Teuchos::ParameterList;

/// int of x_i^p over the box along direction i.
double moment(const mesh::BoxOptions &box, const int i, const int p)
{
  return (std::pow(box.upper[i], p + 1) - std::pow(box.lower[i], p + 1)) / (p + 1);
}

TEST(BodyForce, ResultantIsTheIntegral)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, world());
    Vector load(d.owned_dofs);
    // The points in P1 triangles are exact to degree 2, in P2 to 4; in quadrilaterals to 3 in each direction.
    const int p = element.shape == mesh::Shape::simplex && element.order == 1 ? 1 : 2;
    const fem::VectorField force{field([p](const Point &x) { return std::pow(x[0] * x[1], p); }), ScalarField(-9.81),
                                 field([](const Point &x) { return x[2] * x[0]; })};
    fem::add_body_force(d, force, "Body Force", load);
    const double depth = element.dim == 3 ? moment(box, 2, 0) : 1;
    const Point sum = resultant(d, load);
    const Point expected{moment(box, 0, p) * moment(box, 1, p) * depth,
                         -9.81 * moment(box, 0, 0) * moment(box, 1, 0) * depth,
                         element.dim == 3 ? moment(box, 0, 1) * moment(box, 1, 0) * moment(box, 2, 1) : 0};
    for (int c = 0; c < d.dim(); ++c) EXPECT_NEAR(sum[c], expected[c], 1e-13 * std::abs(expected[1]));
  }
}

TEST(BodyForce, ResultantOnBulgedCellsIsForceTimesVolume)
{
  for (const auto &element : elements()) {
    const auto box = small_box(element);
    const auto d = bulged_body(element, world());
    Vector load(d.owned_dofs);
    fem::add_body_force(d, {ScalarField(1), ScalarField(2), ScalarField(0)}, "Body Force", load);
    const double depth = element.dim == 3 ? moment(box, 2, 0) : 1;
    const double volume = moment(box, 0, 0) * moment(box, 1, 0) * depth;
    const Point sum = resultant(d, load);
    EXPECT_NEAR(sum[0], volume, 1e-13 * volume) << text_of(element);
    EXPECT_NEAR(sum[1], 2 * volume, 1e-13 * volume) << text_of(element);
  }
}

TEST(Traction, ResultantAndMomentAreTheIntegrals)
{
  for (const auto &element : elements()) {
    SCOPED_TRACE(text_of(element));
    const auto box = small_box(element);
    const auto d = body(box, world());
    Vector load(d.owned_dofs);
    const fem::VectorField traction{field([](const Point &x) { return x[0] * x[0] * x[0] + x[1]; }), ScalarField(-20),
                                    field([](const Point &x) { return x[0] * x[2] * x[2]; })};
    fem::add_traction(d, d.mesh->side("top", "test"), traction, "Traction->top", load);
    const double depth = element.dim == 3 ? moment(box, 2, 0) : 1, scale = 20 * moment(box, 0, 0);
    const Point sum = resultant(d, load);
    EXPECT_NEAR(sum[0], (moment(box, 0, 3) + box.upper[1] * moment(box, 0, 0)) * depth, 1e-13 * scale);
    EXPECT_NEAR(sum[1], -20 * moment(box, 0, 0) * depth, 1e-13 * scale);
    if (element.dim == 3) {
      EXPECT_NEAR(sum[2], moment(box, 0, 1) * moment(box, 2, 2), 1e-13 * scale);
    }
    const auto lever = interpolate(d, [](const Point &x) { return Point{0, x[0], 0}; });
    EXPECT_NEAR(lever->dot(load), -20 * moment(box, 0, 1) * depth, 1e-13 * scale);
  }
}

TEST(Traction, LoadsOnlyTheNodesOfItsSide)
{
  const mesh::BoxOptions box = small_box({2, 1});
  const auto d = body(box, world());
  Vector load(d.owned_dofs);
  fem::add_traction(d, d.mesh->side("right", "test"), {ScalarField(3), ScalarField(0), ScalarField(0)}, "T", load);
  const auto loads = by_node_id(d, load);
  const double h = (box.upper[1] - box.lower[1]) / box.cells[1];
  for (int y = 0; y <= box.cells[1]; ++y) {
    for (int x = 0; x <= box.cells[0]; ++x) {
      const double share = x < box.cells[0] ? 0 : y == 0 || y == box.cells[1] ? 0.5 : 1;
      EXPECT_NEAR(loads[2 * (x + (box.cells[0] + 1) * y)], 3 * h * share, 1e-14);
      EXPECT_EQ(loads[2 * (x + (box.cells[0] + 1) * y) + 1], 0);
    }
  }
}

/// Nodal forces of a load on a side.
RCP<Vector> nodal_forces(const fem::Discretization &d, const fem::TractionLoad &load)
{
  const auto forces = rcp(new Vector(d.owned_dofs));
  const mesh::Side &side = d.mesh->side(load.side, "test");
  fem::add_traction(d, side, fem::force_per_area(d, side, load), "T", *forces);
  return forces;
}

const fem::VectorField none;

TEST(TotalForce, IsSpreadEvenlyOverTheSide)
{
  const mesh::BoxOptions box = small_box({2, 1}); // the right side is of length 1, in 3 cells
  const auto d = body(box, world());
  const auto forces =
      by_node_id(d, *nodal_forces(d, {"push", "right", none, {ScalarField(-12.), ScalarField(6.), ScalarField(0.)}}));
  for (int y = 0; y <= 3; ++y) {
    const double share = y == 0 || y == 3 ? 1. / 6 : 1. / 3;
    EXPECT_NEAR(forces[2 * (4 + 5 * y)], -12 * share, 1e-14);
    EXPECT_NEAR(forces[2 * (4 + 5 * y) + 1], 6 * share, 1e-14);
  }
}

TEST(TotalForce, IsTheSumOfNodalForcesOnFlatAndCurvedSides)
{
  const Point force{3, -20, 7};
  for (const auto &element : elements())
    for (const bool curved : {false, true}) {
      SCOPED_TRACE(text_of(element) + (curved ? ", curved" : ""));
      const auto arch = [](const Point &x) { return Point{x[0], x[1] + 0.2 * x[0] * x[0], x[2]}; };
      const auto d = body(small_box(element), world(), curved ? Deformation(arch) : Deformation());
      const Point sum =
          resultant(d, *nodal_forces(d, {"press", "top", none, {ScalarField(3.), ScalarField(-20.), ScalarField(7.)}}));
      for (int c = 0; c < d.dim(); ++c) EXPECT_NEAR(sum[c], force[c], 2e-14 * 20);
    }
}

TEST(TotalForce, OfABodyOfRevolutionIsThatOfTheWholeCircumference)
{
  for (const auto &element : elements()) {
    if (element.dim == 3) continue;
    SCOPED_TRACE(text_of(element));
    const auto d = body({{1, 0}, {3, 2}, {4, 4}, element}, world(), {}, fem::Kinematics::axisymmetric);
    const auto top = nodal_forces(d, {"press", "top", none, {ScalarField(0.), ScalarField(-2.), ScalarField(0.)}});
    EXPECT_NEAR(resultant(d, *top)[1], -2, 1e-14);
    Vector pressed(d.owned_dofs); // by the same force over the area of the ring
    fem::add_traction(d, d.mesh->side("top", "test"),
                      {ScalarField(0.), ScalarField(-2 / (M_PI * (9 - 1))), ScalarField(0.)}, "T", pressed);
    pressed.update(-1., *top, 1.);
    EXPECT_LT(pressed.normInf(), 1e-14);
    // Radial: what acts towards the axis from all around.
    const auto shrunk =
        nodal_forces(d, {"shrink", "right", none, {ScalarField(-5.), ScalarField(0.), ScalarField(0.)}});
    EXPECT_NEAR(resultant(d, *shrunk)[0], -5, 1e-13);
  }
}

TEST(TotalForce, FollowsTimeAndAddsToAForcePerArea)
{
  const auto d = body(small_box({2, 1}), world());
  fem::TractionLoad load{
      "press", "right", {ScalarField(4.), field([](const Point &x) { return x[1]; }), ScalarField(0.)}};
  load.force = {ScalarField("8*t", [](const Point &, const double t) { return 8 * t; }), ScalarField(3.),
                ScalarField(0.)};
  load.force[0] = load.force[0].seen_at(0.25);
  const Point sum = resultant(d, *nodal_forces(d, load));
  EXPECT_NEAR(sum[0], 4 + 2, 1e-13);
  EXPECT_NEAR(sum[1], 2.5 + 3, 1e-13);
  const auto on_side = fem::tractions_on(d, d.mesh->side("right", "test"), {load});
  if (on_side.extent(0) > 0) {
    double first = 0;
    Kokkos::deep_copy(first, Kokkos::subview(on_side, 0, 0, 0));
    EXPECT_NEAR(first, 6, 1e-13);
  }
}

TEST(TotalForce, ThatIsNotFiniteOrHasNoAreaIsRefusedOnEveryRank)
{
  const auto d = body(small_box({2, 1}), world());
  const fem::VectorField bad{ScalarField(0.), ScalarField("1/t", [](const Point &, double) { return INFINITY; }),
                             ScalarField(0.)};
  expect_error(ExitCode::bad_input, {"\"Traction->push->Force Y\" must be finite, got inf from 1/t"}, [&] {
    nodal_forces(d, {"push", "right", none, bad});
  });
  const auto ring = body({{0, 0}, {1, 1}, {4, 4}, {2, 1}}, world(), {}, fem::Kinematics::axisymmetric);
  expect_error(ExitCode::bad_input, {"\"Traction->push\" acts nowhere", "\"left\" lies on the axis"}, [&] {
    nodal_forces(ring, {"push", "left", none, {ScalarField(0.), ScalarField(1.), ScalarField(0.)}});
  });
}

TEST(Loads, AddUpAndAreTheSameOnAnyNumberOfRanks)
{
  for (const auto &element : elements()) {
    const fem::VectorField f{field([](const Point &x) { return wild(x)[0]; }),
                             field([](const Point &x) { return wild(x)[1]; }),
                             field([](const Point &x) { return wild(x)[2]; })};
    const auto loads = [&](const RCP<const Comm> &comm) {
      const auto d = bulged_body(element, comm);
      Vector load(d.owned_dofs), traction(d.owned_dofs), volume(d.owned_dofs);
      fem::add_body_force(d, f, "B", load);
      fem::add_traction(d, d.mesh->side("top", "test"), f, "T", load);
      fem::add_body_force(d, f, "B", volume);
      fem::add_traction(d, d.mesh->side("top", "test"), f, "T", traction);
      const double scale = load.normInf();
      load.update(-1., volume, -1., traction, 1.);
      EXPECT_LT(load.norm2(), 1e-14 * scale) << text_of(element);
      volume.update(1., traction, 1.);
      return by_node_id(d, volume);
    };
    EXPECT_LT(difference(loads(world()), loads(alone())), 1e-13) << text_of(element);
  }
}

TEST(Loads, NanNamesTheParameterOnEveryRank)
{
  const auto d = body(small_box({2, 1}), world());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Vector load(d.owned_dofs);
  const fem::VectorField bad{ScalarField(0), field([&](const Point &x) { return x[0] > 1 ? nan : 1; }, "1/0"),
                             ScalarField(0)};
  expect_error(ExitCode::bad_input, {"\"Body Force->Y\"", "\"1/0\"", "nan at"},
               [&] { fem::add_body_force(d, bad, "Body Force", load); });
  expect_error(ExitCode::bad_input, {"\"Traction->a->Y\"", "nan at"},
               [&] { fem::add_traction(d, d.mesh->side("right", "test"), bad, "Traction->a", load); });
}

/// A deck's sublist with its defaults.
ParameterList completed(ParameterList list, const ParameterList &valid)
{
  validate(list, valid);
  return list;
}

TEST(TractionOptions, SideIsTheNameUnlessGiven)
{
  ParameterList list;
  list.sublist("top").set("Y", -2.5);
  list.sublist("push").set("Side", "left").set("X", "4");
  const auto loads = fem::traction_options(completed(list, fem::valid_traction_parameters()), 2, parse_constant);
  ASSERT_EQ(loads.size(), 2u);
  EXPECT_EQ(loads[0].side, "top");
  EXPECT_EQ(loads[0].traction[1].constant, -2.5);
  EXPECT_TRUE(loads[0].traction[0].is_zero());
  EXPECT_EQ(loads[1].name, "push");
  EXPECT_EQ(loads[1].side, "left");
  EXPECT_EQ(loads[1].traction[0].constant, 4);
}

TEST(TractionOptions, EntryWithoutAForceIsRefused)
{
  ParameterList list, zero;
  list.sublist("top").set("Side", "left");
  expect_error(ExitCode::bad_input, {"\"Traction->top\" has no force", "Give X, Y or Z [Pa]", "Force X"},
               [&] { fem::traction_options(completed(list, fem::valid_traction_parameters()), 2, parse_constant); });
  zero.sublist("top").set("Y", 0);
  EXPECT_EQ(fem::traction_options(completed(zero, fem::valid_traction_parameters()), 2, parse_constant).size(), 1u);
}

TEST(TractionOptions, ForceOnTheWholeSideIsOfTimeAloneAndStandsByItself)
{
  const auto options = [](const ParameterList &list, const FieldParser &parse = parse_constant) {
    return fem::traction_options(completed(list, fem::valid_traction_parameters()), 2, parse);
  };
  ParameterList good, mixed, third, of_place;
  good.sublist("top").set("Force Y", -500);
  EXPECT_EQ(options(good)[0].force[1].constant, -500);
  EXPECT_TRUE(options(good)[0].traction[1].is_zero());
  mixed.sublist("top").set("Force Y", -500).set("X", 1);
  expect_error(ExitCode::bad_input, {"\"Traction->top\" must have X, Y, Z [Pa] or Force X", "they add up"},
               [&] { options(mixed); });
  third.sublist("top").set("Force Z", 1);
  expect_error(ExitCode::bad_input, {"\"Traction->top->Force Z\" must be 0 in 2D"}, [&] { options(third); });
  of_place.sublist("top").set("Force Y", "x");
  const auto parse_x = [](const std::string &text, const std::string &parameter) {
    return text == "x" ? ScalarField("x", [](const Point &x) { return x[0]; }) : parse_constant(text, parameter);
  };
  expect_error(ExitCode::bad_input,
               {"\"Traction->top->Force Y\" must not depend on x, y or z", "got x", "force per area as Y"},
               [&] { options(of_place, parse_x); });
}

TEST(LoadOptions, ThirdComponentIn2dIsRefusedByName)
{
  ParameterList traction, volume;
  traction.sublist("top").set("Z", 1);
  volume.set("Z", 1);
  const auto tractions = completed(traction, fem::valid_traction_parameters());
  const auto volumes = completed(volume, fem::valid_body_force_parameters());
  expect_error(ExitCode::bad_input, {"\"Traction->top->Z\"", "2D"},
               [&] { fem::traction_options(tractions, 2, parse_constant); });
  expect_error(ExitCode::bad_input, {"\"Body Force->Z\"", "2D"},
               [&] { fem::body_force_options(volumes, 2, parse_constant); });
  EXPECT_EQ(fem::traction_options(tractions, 3, parse_constant)[0].traction[2].constant, 1);
  EXPECT_EQ(fem::body_force_options(volumes, 3, parse_constant)[2].constant, 1);
}

} // namespace
} // namespace loads_test
