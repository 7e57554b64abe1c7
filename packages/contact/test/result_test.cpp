#include "rpc/contact/result.hpp"

#include "foundation_scene.hpp"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <vector>

namespace
{

using namespace rpc;
using namespace rpc::test;
using contact::ContactResult;
using contact::ContactSums;

/// Two foundations that meet at a corner, at a displacement and with multipliers where all states occur.
struct Solved {
  Scene scene{std::vector{below(40), beside(25)}};
  RCP<Vector> u = scene.vector(0.08, 0.4);
  ContactResult result;

  Solved()
  {
    for (int k = 0; k < 20; ++k) scene.functional->update_multipliers(*u); // nodes go open or to their limit
    scene.functional->update_multipliers(*scene.vector(0.02, 2));          // and some of them come back
    const auto &mesh = *scene.d.mesh;
    result = contact::contact_result(scene.d, {&mesh.side("bottom", "test"), &mesh.side("right", "test")},
                                     *scene.functional, *u);
  }
  const contact::ContactNodes &nodes() const { return scene.functional->contact(); }
};

TEST(ContactResult, FieldsFollowFromDisplacementAndPressureAtEachPoint)
{
  const Solved solved;
  const auto &c = solved.nodes();
  const auto node = to_host(c.node);
  const auto gap = to_host(c.gap), yield = to_host(c.yield);
  const auto n = to_host(c.normal);
  const auto u_nu = to_host(solved.result.normal_displacement), v = to_host(solved.result.penetration);
  const auto p = to_host(solved.result.pressure), lambda = to_host(solved.scene.functional->multipliers());
  const auto fixed = to_host(c.fixed);
  const auto state = to_host(solved.result.state);
  const auto u = solved.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  GO count[3] = {0, 0, 0};
  for (LO i = 0; i < c.size(); ++i) {
    EXPECT_NEAR(u_nu(i), n(i, 0) * u(2 * node(i), 0) + n(i, 1) * u(2 * node(i) + 1, 0), 1e-16);
    EXPECT_NEAR(v(i), u_nu(i) - gap(i), 1e-16);
    if (!fixed(i)) {
      EXPECT_EQ(p(i), lambda(i));
    }
    const auto expected = p(i) == 0          ? contact::State::open
                          : p(i) == yield(i) ? contact::State::yielding
                                             : contact::State::closed;
    EXPECT_EQ(state(i), static_cast<int>(expected));
    ++count[state(i)];
  }
  for (const GO of_state : count) EXPECT_GT(sum_all(solved.scene.d.mesh->comm(), of_state), 0); // all of them occur
}

TEST(ContactResult, SumsOfEachSideAreThoseOfItsPoints)
{
  const Solved solved;
  const auto &c = solved.nodes();
  const Comm &comm = solved.scene.d.mesh->comm();
  const auto weight = to_host(c.weight), yield = to_host(c.yield), gap = to_host(c.gap);
  const auto normal = to_host(c.normal);
  const auto p = to_host(solved.result.pressure), v = to_host(solved.result.penetration);
  ASSERT_EQ(solved.result.sides.size(), 2u);
  for (int side = 0; side < 2; ++side) {
    double fx = 0, fy = 0, touched = 0, yielded = 0, pressure = 0, deepest = 0, initial = 0;
    for (LO i = c.first(side); i < c.first(side + 1); ++i) {
      fx -= weight(i) * p(i) * normal(i, 0);
      fy -= weight(i) * p(i) * normal(i, 1);
      touched += p(i) > 0 ? weight(i) : 0;
      yielded += p(i) >= yield(i) ? weight(i) : 0;
      pressure = std::max(pressure, p(i));
      deepest = std::max(deepest, v(i));
      initial = std::max(initial, -gap(i));
    }
    const ContactSums &sums = solved.result.sides[side];
    EXPECT_EQ(sums.num_nodes, side == 0 ? 7 : 4);
    EXPECT_NEAR(sums.force[0], sum_all(comm, fx), 1e-14);
    EXPECT_NEAR(sums.force[1], sum_all(comm, fy), 1e-14);
    EXPECT_EQ(sums.force[2], 0);
    EXPECT_NEAR(sums.contact_length, sum_all(comm, touched), 1e-15);
    EXPECT_NEAR(sums.yielded_length, sum_all(comm, yielded), 1e-15);
    EXPECT_EQ(sums.max_pressure, max_all(comm, pressure));
    EXPECT_EQ(sums.max_penetration, max_all(comm, deepest));
    EXPECT_EQ(sums.max_initial_penetration, max_all(comm, initial));
    EXPECT_GT(sums.contact_length, 0);
  }
  EXPECT_GT(solved.result.sides[0].force[1], 0); // the foundation pushes up
  EXPECT_LT(solved.result.sides[1].force[0], 0); // and to the left
}

TEST(ContactResult, TotalIsTheSumOverTheSides)
{
  const Solved solved;
  const ContactSums &a = solved.result.sides[0], &b = solved.result.sides[1], &total = solved.result.total;
  EXPECT_EQ(total.num_nodes, a.num_nodes + b.num_nodes);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(total.force[k], a.force[k] + b.force[k], 1e-15);
  EXPECT_NEAR(total.contact_length, a.contact_length + b.contact_length, 1e-15);
  EXPECT_NEAR(total.yielded_length, a.yielded_length + b.yielded_length, 1e-15);
  EXPECT_EQ(total.max_pressure, std::max(a.max_pressure, b.max_pressure));
  EXPECT_EQ(total.max_penetration, std::max(a.max_penetration, b.max_penetration));
  EXPECT_EQ(total.max_initial_penetration, std::max(a.max_initial_penetration, b.max_initial_penetration));
}

TEST(ContactResult, IsEmptyWithoutSides)
{
  const Scene scene(std::vector<contact::ContactOptions>{});
  const auto u = scene.vector(0.05, 0.4);
  const auto result = contact::contact_result(scene.d, {}, *scene.functional, *u);
  EXPECT_TRUE(result.sides.empty());
  EXPECT_EQ(result.total.num_nodes, 0);
  EXPECT_EQ(result.total.max_pressure, 0);
  EXPECT_EQ(contact::contact_forces(scene.d, scene.functional->contact(), result).norm2(), 0);
}

TEST(ContactResult, NodesThatMissTheObstacleLendNoPressureToHeldOnes)
{
  // A circle below the nodes at x = 1/3, 2/3 and 1. The bottom is held on it, at 2/3 in it.
  contact::ContactOptions options;
  options.side = "bottom";
  options.yield_stress = ScalarField(3.);
  options.obstacle = {contact::Obstacle::Kind::sphere, {2. / 3, -0.7, 0}, {}, 0.6, false};
  fem::DirichletCondition condition = held("bottom");
  condition.displacement[1] = field([](const Point &x) {
    const double across = std::abs(x[0] - 2. / 3);
    return across > 0.5 ? 0 : std::sqrt(0.36 - across * across) - 0.7 - (across < 0.1 ? 0.01 : 0);
  });
  const Scene scene({options}, condition);
  const auto &c = scene.functional->contact();
  EXPECT_EQ(c.num_total, 3);
  EXPECT_EQ(c.num_fixed, 3);
  const Vector u(*scene.functional->problem().dirichlet.value, Teuchos::Copy);
  const auto result = contact::contact_result(scene.d, {&scene.d.mesh->side("bottom", "test")}, *scene.functional, u);
  const auto coords = to_host(scene.d.mesh->coords);
  const auto node = to_host(c.node);
  const auto p = to_host(result.pressure);
  for (LO i = 0; i < c.size(); ++i) // the mean of 3 and nothing beside it
    EXPECT_NEAR(p(i), std::abs(coords(node(i), 0) - 2. / 3) < 0.1 ? 3 : 1.5, 1e-12);
  EXPECT_EQ(result.total.num_nodes, 3);
  EXPECT_NEAR(result.total.force[1], 2, 1e-12);
}

TEST(ContactForces, SumToTheTotalForce)
{
  const Solved solved;
  const Comm &comm = solved.scene.d.mesh->comm();
  const auto force = contact::contact_forces(solved.scene.d, solved.nodes(), solved.result);
  const auto values = force.getLocalViewHost(Tpetra::Access::ReadOnly);
  double sum[2] = {0, 0};
  for (std::size_t dof = 0; dof < values.extent(0); ++dof) sum[dof % 2] += values(dof, 0);
  for (int c = 0; c < 2; ++c) EXPECT_NEAR(sum_all(comm, sum[c]), solved.result.total.force[c], 1e-14);
}

TEST(ContactForces, AddUpAtANodeOfTwoSidesAndReachHeldNodes)
{
  const Solved solved;
  const auto &c = solved.nodes();
  const auto force = contact::contact_forces(solved.scene.d, c, solved.result);
  const auto values = force.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto node = to_host(c.node);
  const auto weight = to_host(c.weight), p = to_host(solved.result.pressure);
  const auto normal = to_host(c.normal);
  const auto fixed = to_host(c.fixed);
  std::vector<std::array<double, 2>> expected(solved.scene.d.mesh->num_owned_nodes(), {0, 0});
  std::vector<int> points(expected.size(), 0);
  GO shared = 0, held = 0;
  for (LO i = 0; i < c.size(); ++i) {
    for (int k = 0; k < 2; ++k) expected[node(i)][k] -= weight(i) * p(i) * normal(i, k);
    shared += ++points[node(i)] == 2 ? 1 : 0;
    held += fixed(i) && p(i) > 0 ? 1 : 0;
  }
  for (std::size_t n = 0; n < expected.size(); ++n)
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(values(2 * n + k, 0), expected[n][k], 1e-15);
  EXPECT_EQ(sum_all(solved.scene.d.mesh->comm(), shared), 1);
  EXPECT_EQ(sum_all(solved.scene.d.mesh->comm(), held), 1); // it is held in the foundation, which yields
}

} // namespace
