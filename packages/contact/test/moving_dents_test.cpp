// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/moving_dents.hpp"

#include "blocks.hpp"
#include "rpc/contact/surface/plane.hpp"
#include "rpc/contact/surface/sphere.hpp"
#include "rpc/fem/surface.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace moving_dents_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using contact::DentsMoveWith;

contact::ContactOptions on(const std::string &side)
{
  contact::ContactOptions options;
  options.side = side;
  options.dents_move_with = DentsMoveWith::foundation;
  return options;
}

/// What a foundation remembers of dents that a body has pressed in where it stood, by a function of the nodes' places in the mesh.
std::vector<contact::FoundationDents> pressed_in(const fem::Discretization &d, const contact::ContactOptions &side,
                                                 const Function &dents, const Vector &u,
                                                 std::vector<contact::FoundationDents> before = {})
{
  const auto added = at_nodes(d, dents);
  contact::press_in(d, {side}, *added, *added, u, before);
  return before;
}

RCP<const MultiVector> none_with_body(const fem::Discretization &d)
{
  return rcp(new MultiVector(d.mesh->owned_nodes, 1));
}

/// Values at a side's owned nodes are those of a function of their places.
void expect_at_side(const fem::Discretization &d, const std::string &side, const MultiVector &values, const Function &f,
                    const double tolerance)
{
  const auto node = to_host(fem::surface_nodes(d, d.mesh->side(side, "test")).node);
  const auto from = values.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t i = 0; i < node.extent(0); ++i) {
    const Point x = place_of(d, node(i));
    EXPECT_NEAR(from(node(i), 0), f(x), tolerance)
        << d.mesh->element.name() << " at " << x[0] << ", " << x[1] << ", " << x[2];
  }
}

/// A dent with a round bottom and edges, deep enough to be seen everywhere in its middle.
double dent(const Point &x)
{
  return std::max(0., 0.3 - std::pow(x[0] - 1.9, 2)) * (1 + 0.5 * x[2]);
}

TEST(MovingDents, AreMetWhereTheyLieAfterAMoveByWholeCells)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto d = block(element);
    const Vector none(d.owned_dofs);
    const Point move = {2 * cell, 0.01, element.dim == 3 ? -cell : 0};
    const auto u = displacement(d, [&](const Point &) { return move; });
    const Function expected = [&](const Point &x) {
      const Point y = {x[0] + move[0], 0, x[2] + move[2]};
      return y[0] > 3 + 1e-9 || y[2] < -1 - 1e-9 ? 0 : dent(y);
    };
    const auto dents = pressed_in(d, on("bottom"), dent, none);
    expect_at_side(d, "bottom", *contact::dents_met(d, {on("bottom")}, none_with_body(d), dents, *u), expected, 1e-14);

    auto beside = on("bottom"); // the obstacle moves instead
    beside.normal = contact::Normal::foundation;
    for (const bool plane : {true, false}) {
      if (plane)
        beside.obstacle.surface = contact::Plane{{0, 1, 0}};
      else
        beside.obstacle.surface = contact::Sphere{};
      beside.obstacle.origin = beside.obstacle.point = {1.7, -2, element.dim == 3 ? -0.4 : 0};
      const auto in_place = pressed_in(d, beside, dent, none);
      for (int c = 0; c < 3; ++c)
        beside.obstacle.point[c] = beside.obstacle.origin[c] - (c != 1 || plane ? move[c] : 0);
      expect_at_side(d, "bottom", *contact::dents_met(d, {beside}, none_with_body(d), in_place, none), expected, 1e-14);
    }

    auto with_body = on("bottom");
    with_body.dents_move_with = DentsMoveWith::body;
    const auto own = at_nodes(d, dent);
    EXPECT_EQ(contact::dents_met(d, {with_body}, own, {}, *u).get(), own.get());
  }
}

TEST(MovingDents, ThatAStepAddsGoWhereTheyLieAndOlderOnesStay)
{
  // Back over the older dents by three cells: the body stands on them in part, so that there are two sheets.
  const Function more = [](const Point &x) { return 0.1 * (4 - x[0]) + 0.02 * x[2]; };
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto d = block(element);
    const Vector none(d.owned_dofs);
    const Point move = {-3 * cell, -0.02, element.dim == 3 ? cell : 0};
    const auto u = displacement(d, [&](const Point &) { return move; });
    const auto first = pressed_in(d, on("bottom"), dent, none);
    const auto both = pressed_in(d, on("bottom"), more, *u, first);
    EXPECT_EQ(both[0].sheets.size(), 2u);
    EXPECT_EQ(both[0].sheets[0], first[0].sheets[0]);
    const auto at_first = contact::dents_met(d, {on("bottom")}, none_with_body(d), both, none);
    expect_at_side(
        d, "bottom", *at_first,
        [&](const Point &x) {
          const Point y = {x[0] - move[0], 0, x[2] - move[2]};
          const bool stood_on = y[0] < 3 + 1e-9 && y[2] > -1 - 1e-9;
          return dent(x) + (stood_on ? more(y) : 0);
        },
        1e-14);
    const auto at_second = contact::dents_met(d, {on("bottom")}, none_with_body(d), both, *u);
    expect_at_side(
        d, "bottom", *at_second,
        [&](const Point &x) {
          const Point y = {x[0] + move[0], 0, x[2] + move[2]};
          const bool stood_on = y[0] > 1 - 1e-9 && y[2] < 1e-9;
          return more(x) + (stood_on ? dent(y) : 0);
        },
        1e-14);
  }
}

TEST(MovingDents, FarBesideTheSideAreRemembered)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto d = block(element);
    const Vector none(d.owned_dofs);
    const Point far = {40 * cell, 0.3, element.dim == 3 ? -17 * cell : 0};
    const auto u = displacement(d, [&](const Point &) { return far; });
    const auto dents = pressed_in(d, on("bottom"), dent, none);
    expect_at_side(
        d, "bottom", *contact::dents_met(d, {on("bottom")}, none_with_body(d), dents, *u),
        [](const Point &) { return 0; }, 0);
    const auto both = pressed_in(
        d, on("bottom"), [](const Point &x) { return 2 * dent(x); }, *u, dents);
    EXPECT_EQ(both[0].sheets.size(), 2u);
    EXPECT_NEAR(both[0].deepest, 2 * dents[0].deepest, 1e-15);
    EXPECT_NEAR(both[0].volume, 3 * dents[0].volume, 1e-14);
    expect_at_side(d, "bottom", *contact::dents_met(d, {on("bottom")}, none_with_body(d), both, none), dent, 1e-14);
    expect_at_side(
        d, "bottom", *contact::dents_met(d, {on("bottom")}, none_with_body(d), both, *u),
        [](const Point &x) { return 2 * dent(x); }, 1e-13);
  }
}

TEST(MovingDents, OfManyStepsInOnePlaceBecomeOneSheet)
{
  const Function linear = [](const Point &x) { return 0.01 * (4 - x[0]) + 0.002 * x[2]; };
  constexpr int steps = 150;
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto d = block(element);
    std::vector<contact::FoundationDents> dents;
    const Vector none(d.owned_dofs);
    for (int k = 0; k < steps; ++k) dents = pressed_in(d, on("bottom"), linear, none, dents);
    EXPECT_LE(dents[0].sheets.size(), 64u);
    expect_at_side(
        d, "bottom", *contact::dents_met(d, {on("bottom")}, none_with_body(d), dents, none),
        [&](const Point &x) { return steps * linear(x); }, 1e-11);
  }
}

TEST(MovingDents, OfAShaftThatMovesAlongItsAxisLieInTheBore)
{
  const mesh::Element element{2, 2, mesh::Shape::tensor};
  const auto d = block(element, {}, 1, fem::Kinematics::axisymmetric);
  const Function along = [](const Point &x) { return 0.1 + x[1] * x[1]; };
  const auto u = displacement(d, [](const Point &) { return Point{0.001, cell, 0}; });
  const auto dents = pressed_in(d, on("right"), along, Vector(d.owned_dofs));
  expect_at_side(
      d, "right", *contact::dents_met(d, {on("right")}, none_with_body(d), dents, *u),
      [&](const Point &x) {
        return x[1] + cell > 0.5 + 1e-9 ? 0 : along({3, x[1] + cell, 0});
      },
      1e-14);
}

TEST(MovingDents, AreMetAtTheEdgeOfABodyThatSpreads)
{
  // By four half cells: what a body does under load is no way off the foundation that it stands on.
  const auto d = block({2, 1, mesh::Shape::tensor});
  const auto u = displacement(d, [](const Point &x) { return Point{0.5 * (x[0] - 2), 0, 0}; });
  const Function two = [](const Point &) { return 2; };
  const auto dents = pressed_in(d, on("bottom"), two, Vector(d.owned_dofs));
  expect_at_side(d, "bottom", *contact::dents_met(d, {on("bottom")}, none_with_body(d), dents, *u), two, 1e-15);
}

TEST(MovingDents, MakeTheVolumeThatOfTheFoundation)
{
  const auto d = block({3, 1, mesh::Shape::tensor});
  const Function depth = [](const Point &x) { return 3 - x[0]; };
  auto with_body = on("top");
  with_body.dents_move_with = DentsMoveWith::body;
  auto foundations = pressed_in(d, on("bottom"), depth, Vector(d.owned_dofs));
  foundations.push_back(pressed_in(
                            d, with_body, [](const Point &x) { return 0.5 * (x[0] - 1); }, Vector(d.owned_dofs))
                            .at(0));
  EXPECT_TRUE(foundations[1].sheets.empty());
  contact::ContactResult result;
  result.sides.resize(2);
  result.sides[1].dent_volume = 7; // of contact points alone
  contact::take_all_dents({on("bottom"), with_body}, foundations, result);
  EXPECT_NEAR(result.sides[0].max_dent, 2, 1e-14);
  EXPECT_NEAR(result.sides[0].dent_volume, 2, 1e-13);
  EXPECT_NEAR(result.sides[1].max_dent, 1, 1e-14);
  EXPECT_NEAR(result.sides[1].dent_volume, 1, 1e-13);
  EXPECT_NEAR(result.total.max_dent, 2, 1e-14);
  EXPECT_NEAR(result.total.dent_volume, 3, 1e-13);
}

} // namespace
} // namespace moving_dents_test
