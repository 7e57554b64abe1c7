// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/clearance.hpp"

#include "foundation_scene.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace clearance_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using contact::Overlap;

/// A block of 2 m by 1 m.
fem::Discretization block()
{
  const mesh::BoxOptions box{{0, 0}, {2, 1}, {6, 3}, {2, 1}};
  return fem::discretize(std::make_shared<mesh::Mesh>(mesh::make_box(box, Tpetra::getDefaultComm())));
}

contact::ContactOptions at(const std::string &side, const ScalarField &gap)
{
  contact::ContactOptions options;
  options.side = side;
  options.yield_stress = ScalarField(1.);
  options.gap = gap;
  return options;
}

Overlap overlap(const contact::ContactOptions &options, const std::vector<fem::DirichletCondition> &conditions)
{
  const auto d = block();
  const auto dirichlet = fem::dirichlet_dofs(d, conditions);
  return contact::overlap(d, contact::contact_nodes(d, {options}, dirichlet), 0, dirichlet);
}

TEST(Overlap, IsThatOfTheDeepestPointAndTheBodysThicknessAlongItsNormal)
{
  const auto slanted = field([](const Point &x) { return 0.5 - x[0]; });
  const Overlap below = overlap(at("bottom", slanted), {held("top")});
  EXPECT_DOUBLE_EQ(below.depth, 1.5);
  EXPECT_DOUBLE_EQ(below.thickness, 1);
  EXPECT_TRUE(below.held);
  EXPECT_DOUBLE_EQ(overlap(at("right", ScalarField(-0.25)), {held("top")}).thickness, 2);
  auto diagonal = at("right", ScalarField(-0.25));
  diagonal.normal = contact::Normal::fixed;
  diagonal.direction = {0.6, -0.8, 0};
  EXPECT_DOUBLE_EQ(overlap(diagonal, {held("top")}).thickness, 0.6 * 2 + 0.8 * 1);
  EXPECT_EQ(overlap(at("bottom", ScalarField(0.25)), {held("top")}).depth, 0);
}

TEST(Overlap, IsLessByWhatMovesTheBodyOutOfTheFoundation)
{
  const auto through = at("bottom", ScalarField(-3.));
  EXPECT_DOUBLE_EQ(overlap(through, {held("top", {0, 2.5, 0})}).depth, 0.5);
  EXPECT_DOUBLE_EQ(overlap(through, {held("top", {0, -2.5, 0})}).depth, 3);
  EXPECT_DOUBLE_EQ(overlap(through, {held("top", {2.5, 0, 0})}).depth, 3);
}

TEST(Overlap, TellsWhetherAnythingHoldsTheBodyAlongTheNormal)
{
  fem::DirichletCondition sliding = held("left");
  sliding.displacement[1] = std::nullopt;
  EXPECT_FALSE(overlap(at("bottom", ScalarField(-3.)), {sliding}).held);
  EXPECT_TRUE(overlap(at("right", ScalarField(-3.)), {sliding}).held);
}

bool loaded(const contact::ContactOptions &options, const double traction, const double displacement)
{
  const auto d = block();
  const auto dirichlet = fem::dirichlet_dofs(d, {held("top", {0, displacement, 0})});
  fem::ElasticProblem elastic;
  elastic.applied_load = rcp(new Vector(d.owned_dofs));
  fem::add_traction(d, d.mesh->side("left", "test"), {ScalarField(traction), ScalarField(0.), ScalarField(0.)}, "test",
                    *elastic.applied_load);
  elastic.dirichlet = dirichlet;
  return contact::is_loaded(d.mesh->comm(), elastic, contact::contact_nodes(d, {options}, dirichlet));
}

TEST(LoadedBody, IsUnderForcesDisplacementsOrFoundationsThatReachIntoIt)
{
  const auto apart = at("bottom", ScalarField(0.1));
  EXPECT_FALSE(loaded(apart, 0, 0));
  EXPECT_FALSE(loaded(at("bottom", ScalarField(0.)), 0, 0));
  EXPECT_TRUE(loaded(apart, 1e-9, 0));
  EXPECT_TRUE(loaded(apart, 0, -1e-9));
  EXPECT_TRUE(loaded(at("bottom", field([](const Point &x) { return 1.9 - x[0]; })), 0, 0)); // at one point
}

TEST(LoadedBody, IsDraggedAlongByFoundations)
{
  const auto d = block();
  const auto dirichlet = fem::dirichlet_dofs(d, {held("top")});
  auto rough = at("bottom", ScalarField(0.));
  rough.friction_bound = ScalarField(1.);
  fem::ElasticProblem elastic;
  elastic.applied_load = rcp(new Vector(d.owned_dofs));
  elastic.dirichlet = dirichlet;
  const Vector rest(d.owned_dofs);
  const auto points = [&](const double motion) {
    const contact::SlipStart start{rest, {Point{motion, 0, 0}}};
    return contact::contact_nodes(d, {rough}, dirichlet, {}, nullptr, &start);
  };
  EXPECT_FALSE(contact::is_loaded(d.mesh->comm(), elastic, points(0)));
  EXPECT_TRUE(contact::is_loaded(d.mesh->comm(), elastic, points(0.01)));
}

TEST(SmallestGap, IsLeftOfTheGapByTheDisplacement)
{
  const auto d = block();
  const auto &comm = d.mesh->comm();
  const auto gap = [&](const std::vector<contact::ContactOptions> &options) {
    const auto points = contact::contact_nodes(d, options, fem::dirichlet_dofs(d, {held("top")}));
    const auto u = rcp(new Vector(d.owned_dofs));
    u->putScalar(-0.01);
    const contact::ContactState state{u, DeviceView<double *>("pressure", points.size()), {}};
    return contact::smallest_gap(comm, points,
                                 contact::contact_result(d, contact::contact_sides(*d.mesh, options), points, state));
  };
  EXPECT_NEAR(gap({at("bottom", field([](const Point &x) { return 0.1 + 0.1 * x[0]; }))}), 0.09, 1e-15);
  EXPECT_NEAR(gap({at("bottom", ScalarField(0.2)), at("right", ScalarField(0.15))}), 0.16, 1e-15);
  EXPECT_EQ(gap({}), std::numeric_limits<double>::infinity());
}

} // namespace
} // namespace clearance_test
