#include "rpc/contact/moving_dents.hpp"

#include "blocks.hpp"
#include "rpc/fem/surface.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

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
    const Point move = {2 * cell, 0.01, element.dim == 3 ? -cell : 0};
    const auto dents = at_nodes(d, dent);
    const auto u = displacement(d, [&](const Point &) { return move; });
    const Function expected = [&](const Point &x) {
      const Point y = {x[0] + move[0], 0, x[2] + move[2]};
      return y[0] > 3 + 1e-9 || y[2] < -1 - 1e-9 ? 0 : dent(y);
    };
    const auto met = contact::dents_met(d, {on("bottom")}, dents, *u);
    expect_at_side(d, "bottom", *met, expected, 1e-14);

    auto beside = on("bottom"); // the obstacle moves instead
    beside.normal = contact::Normal::foundation;
    const Vector none(d.owned_dofs);
    for (const bool plane : {true, false}) {
      if (plane)
        beside.obstacle.surface = contact::Plane{{0, 1, 0}};
      else
        beside.obstacle.surface = contact::Sphere{};
      beside.obstacle.origin = {1.7, -2, element.dim == 3 ? -0.4 : 0};
      for (int c = 0; c < 3; ++c)
        beside.obstacle.point[c] = beside.obstacle.origin[c] - (c != 1 || plane ? move[c] : 0);
      expect_at_side(d, "bottom", *contact::dents_met(d, {beside}, dents, none), expected, 1e-14);
      const auto added = rcp(new MultiVector(d.mesh->owned_nodes, 1));
      contact::add_where_they_lie(d, {beside}, *met, none, *added);
      expect_at_side(
          d, "bottom", *added,
          [&](const Point &y) {
            const bool under_the_body = y[0] > 1 + move[0] - 1e-9 && y[2] < move[2] + 1e-9;
            return under_the_body ? dent(y) : 0;
          },
          1e-14);
    }

    auto with_body = on("bottom");
    with_body.dents_move_with = DentsMoveWith::body;
    EXPECT_EQ(contact::dents_met(d, {with_body}, dents, *u).get(), dents.get());
  }
}

TEST(MovingDents, ThatAStepAddsGoWhereTheyLieAndOlderOnesStay)
{
  for (const mesh::Element &element : mesh::all_elements()) {
    const auto d = block(element);
    const Point move = {-3 * cell, -0.02, element.dim == 3 ? cell : 0};
    const auto dents = at_nodes(d, dent);
    const auto u = displacement(d, [&](const Point &) { return move; });
    const Function more = [](const Point &x) { return 0.1 * (4 - x[0]) + 0.02 * x[2]; };
    contact::add_where_they_lie(d, {on("bottom")}, *at_nodes(d, more), *u, *dents);
    expect_at_side(
        d, "bottom", *dents,
        [&](const Point &x) {
          const Point y = {x[0] - move[0], 0, x[2] - move[2]};
          const bool stands_on_it = y[0] < 3 + 1e-9 && y[2] > -1 - 1e-9;
          return dent(x) + (stands_on_it ? more(y) : 0);
        },
        1e-14);
    // Back at the first place all of them are met.
    const Vector none(d.owned_dofs);
    const auto met = contact::dents_met(d, {on("bottom")}, dents, none);
    const auto a = met->getLocalViewHost(Tpetra::Access::ReadOnly),
               b = dents->getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto node = to_host(fem::surface_nodes(d, d.mesh->side("bottom", "test")).node);
    for (std::size_t i = 0; i < node.extent(0); ++i) EXPECT_NEAR(a(node(i), 0), b(node(i), 0), 1e-15);
  }
}

TEST(MovingDents, OfAShaftThatMovesAlongItsAxisLieInTheBore)
{
  const mesh::Element element{2, 2, mesh::Shape::tensor};
  const auto d = block(element, {}, 1, fem::Kinematics::axisymmetric);
  const Function along = [](const Point &x) { return 0.1 + x[1] * x[1]; };
  const auto u = displacement(d, [](const Point &) { return Point{0.001, cell, 0}; });
  const auto met = contact::dents_met(d, {on("right")}, at_nodes(d, along), *u);
  expect_at_side(
      d, "right", *met,
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
  const auto met = contact::dents_met(d, {on("bottom")}, at_nodes(d, [](const Point &) { return 2.; }), *u);
  expect_at_side(
      d, "bottom", *met, [](const Point &) { return 2; }, 1e-15);
}

TEST(MovingDents, MakeTheVolumeThatOfTheFoundation)
{
  const auto d = block({3, 1, mesh::Shape::tensor});
  const auto dents = at_nodes(d, [](const Point &x) { return 3 - x[0]; });
  auto with_body = on("top");
  with_body.dents_move_with = DentsMoveWith::body;
  const auto both = rcp(new MultiVector(d.mesh->owned_nodes, 2));
  both->getVectorNonConst(0)->update(1., *dents->getVector(0), 0.);
  contact::ContactResult result;
  result.sides.resize(2);
  result.sides[1].max_dent = 0.5;
  result.sides[1].dent_volume = 7;
  contact::take_dents_of_foundation(d, {on("bottom"), with_body}, *both, result);
  EXPECT_NEAR(result.sides[0].max_dent, 2, 1e-14);
  EXPECT_NEAR(result.sides[0].dent_volume, 2, 1e-13);
  EXPECT_NEAR(result.total.max_dent, 2, 1e-14);
  EXPECT_NEAR(result.total.dent_volume, 9, 1e-13);
}

} // namespace
