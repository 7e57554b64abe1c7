// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/result.hpp"

#include "foundation_scene.hpp"
#include "rpc/contact/highest_pressure.hpp"
#include "rpc/contact/law/judgement.hpp"
#include "rpc/contact/surface/sphere.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace result_test
{
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
    for (int k = 0; k < 20; ++k) scene.iterate->duals().update(*u); // nodes go open or to their limit
    scene.iterate->duals().update(*scene.vector(0.02, 2));          // and some of them come back
    const auto &mesh = *scene.d.mesh;
    result = contact::contact_result(scene.d, {&mesh.side("bottom", "test"), &mesh.side("right", "test")},
                                     scene.iterate->points(), judged_at(*scene.iterate, *u));
  }
  const contact::ContactNodes &nodes() const { return scene.iterate->points(); }
};

TEST(ContactResult, AMeanOfPressuresAtTheYieldLimitIsTheLimitButForRounding)
{
  const contact::Foundation f{13.545525787304639};
  EXPECT_EQ(contact::admissible_mean(13.545525787304637, f), f.yield);
  EXPECT_EQ(contact::admissible_mean(13.5455257, f), 13.5455257);
  EXPECT_EQ(contact::admissible_mean(14, f), f.yield);
  EXPECT_EQ(contact::admissible_mean(-1, f), 0);
  EXPECT_EQ(contact::admissible_mean(1e300, contact::Foundation{std::numeric_limits<double>::infinity()}), 1e300);
}

TEST(ContactResult, FieldsFollowFromDisplacementAndPressureAtEachPoint)
{
  const Solved solved;
  const auto &c = solved.nodes();
  const auto node = to_host(c.node);
  const auto gap = to_host(c.gap), yield = to_host(c.law.yield);
  const auto n = to_host(c.normal);
  const auto u_nu = to_host(solved.result.normal_displacement), v = to_host(solved.result.penetration);
  const auto p = to_host(solved.result.pressure), lambda = to_host(solved.scene.iterate->duals().multipliers().normal);
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
  const auto weight = to_host(c.weight), yield = to_host(c.law.yield), gap = to_host(c.gap);
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
  for (const auto &q : contact::contact_quantities) {
    const double x = a.*q.value, y = b.*q.value;
    EXPECT_NEAR(total.*q.value, q.combine == Combine::sum ? x + y : std::max(x, y), 1e-15) << q.key;
  }
  EXPECT_GT(total.yielded_length, 0);
  EXPECT_GT(total.max_pressure, 0);
}

TEST(HighestPressure, IsWhereTheLargestPressureIsOnAnyNumberOfRanks)
{
  Solved solved;
  const auto &c = solved.nodes();
  const auto x = fem::node_positions(*solved.scene.d.mesh, c.node);
  const auto p = to_host(solved.result.pressure);
  const auto highest = [&] { return contact::highest_pressure(solved.scene.d, c, solved.result); };
  const auto set = [&](const std::function<double(double, double)> &pressure) {
    double most = 0;
    for (LO i = 0; i < c.size(); ++i) most = std::max(most, p(i) = pressure(x(i, 0), x(i, 1)));
    Kokkos::deep_copy(solved.result.pressure, p);
    solved.result.total.max_pressure = max_all(solved.scene.d.mesh->comm(), most);
  };
  // The bottom is y = 0, the right side x = 2: their corner is one node.
  set([](const double at, const double height) { return height == 0 ? 1 + at : 0.5; });
  EXPECT_EQ(highest().num_places, 1);
  EXPECT_EQ(highest().place, (Point{2, 0, 0}));
  set([](const double at, const double) { return at == 2 ? 3 * (1 + 1e-8) : at > 0.6 ? 3. : 1.; });
  EXPECT_EQ(highest().side, 0);
  EXPECT_NEAR(highest().place[0], 2. / 3, 1e-12);
  EXPECT_EQ(highest().place[1], 0);
  EXPECT_GT(highest().num_places, 2);
  set([](double, double) { return 0.; });
  EXPECT_EQ(highest().num_places, 0);
}

TEST(ContactResult, IsEmptyWithoutSides)
{
  const Scene scene(std::vector<contact::ContactOptions>{});
  const auto u = scene.vector(0.05, 0.4);
  const auto result = contact::contact_result(scene.d, {}, scene.iterate->points(), judged_at(*scene.iterate, *u));
  EXPECT_TRUE(result.sides.empty());
  EXPECT_EQ(result.total.num_nodes, 0);
  EXPECT_EQ(result.total.max_pressure, 0);
  EXPECT_EQ(contact::contact_forces(scene.d, scene.iterate->points(), result).norm2(), 0);
}

TEST(ContactResult, NodesThatMissTheObstacleLendNoPressureToHeldOnes)
{
  // A circle below the nodes at x = 1/3, 2/3 and 1. The bottom is held on it, at 2/3 in it.
  contact::ContactOptions options;
  options.side = "bottom";
  options.yield_stress = ScalarField(3.);
  options.obstacle = {contact::Sphere{0.6}, {2. / 3, -0.7, 0}};
  fem::DirichletCondition condition = held("bottom");
  condition.displacement[1] = field([](const Point &x) {
    const double across = std::abs(x[0] - 2. / 3);
    return across > 0.5 ? 0 : std::sqrt(0.36 - across * across) - 0.7 - (across < 0.1 ? 0.01 : 0);
  });
  const Scene scene({options}, condition);
  const auto &c = scene.iterate->points();
  EXPECT_EQ(c.num_total, 3);
  EXPECT_EQ(c.num_fixed, 3);
  const Vector u(*scene.elastic.dirichlet.value, Teuchos::Copy);
  const auto result = contact::contact_result(scene.d, {&scene.d.mesh->side("bottom", "test")}, scene.iterate->points(),
                                              judged_at(*scene.iterate, u));
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

TEST(ContactResult, DisplacementAlongTheSideIsWhatTheNormalOneLeaves)
{
  const Solved solved;
  const auto &c = solved.nodes();
  const auto along = to_host(contact::tangential_displacements(c, *solved.u)), normal = to_host(c.normal);
  const auto u_nu = to_host(solved.result.normal_displacement);
  const auto u = solved.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto node = to_host(c.node);
  for (LO i = 0; i < c.size(); ++i)
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(along(i, k) + u_nu(i) * normal(i, k), u(2 * node(i) + k, 0), 1e-15);
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

/// The same with dents from before, on foundations that harden and are elastic.
struct SolvedOnDents {
  Scene scene;
  RCP<Vector> u;
  ContactResult result;

  SolvedOnDents() : scene(options())
  {
    const auto dents = rcp(new MultiVector(scene.d.mesh->owned_nodes, 2));
    const auto coords = to_host(scene.d.mesh->coords);
    const auto to = dents->getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (LO n = 0; n < scene.d.mesh->num_owned_nodes(); ++n) {
      to(n, 0) = 0.01 * coords(n, 0);
      to(n, 1) = 0.004 * (1 - coords(n, 1));
    }
    const auto &problem = scene.elastic;
    const auto nodes = contact::contact_nodes(scene.d, options(), problem.dirichlet, scene.material, dents.get());
    const auto K =
        fem::eliminate_dirichlet(scene.d, fem::assemble_stiffness(scene.d, scene.material), problem.dirichlet.fixed);
    scene.iterate = std::make_shared<contact::Iterate>(problem, nodes, test::updated(K.matrix, nodes));
    u = scene.vector(0.08, 3.1);
    for (int k = 0; k < 400; ++k) scene.iterate->duals().update(*u); // to the law, at this u
    const auto &mesh = *scene.d.mesh;
    result = contact::contact_result(scene.d, {&mesh.side("bottom", "test"), &mesh.side("right", "test")},
                                     scene.iterate->points(), judged_at(*scene.iterate, *u));
  }
  static std::vector<contact::ContactOptions> options()
  {
    std::vector options{below(40), beside(25)};
    options[0].hardening = ScalarField(9.);
    options[1].stiffness = ScalarField(80.);
    return options;
  }
};

TEST(ContactResult, DentsGrowByWhatTheFoundationGaveWayAndPenetrationIsMeasuredFromItsFirstSurface)
{
  const SolvedOnDents solved;
  const auto &c = solved.scene.iterate->points();
  const Comm &comm = solved.scene.d.mesh->comm();
  const auto before = to_host(c.dent), dent = to_host(solved.result.dent), p = to_host(solved.result.pressure),
             v = to_host(solved.result.penetration), u_nu = to_host(solved.result.normal_displacement),
             gap = to_host(c.gap), xi = to_host(c.law.yield), H = to_host(c.law.hardening),
             compliance = to_host(c.law.compliance), weight = to_host(c.weight);
  const auto fixed = to_host(c.fixed);
  GO grown = 0, kept = 0;
  for (int side = 0; side < 2; ++side) {
    double deepest = 0, volume = 0, dissipated = 0, stored = 0;
    for (LO i = c.first(side); i < c.first(side + 1); ++i) {
      EXPECT_NEAR(v(i), u_nu(i) - gap(i), 1e-16);
      EXPECT_GE(dent(i), before(i));
      if (p(i) < xi(i)) {
        EXPECT_EQ(dent(i), before(i));
        kept += before(i) > 0 && p(i) > 0;
      } else if (!fixed(i)) {
        EXPECT_NEAR(dent(i), v(i) - compliance(i) * p(i), 1e-15);
        EXPECT_NEAR(p(i), xi(i) + H(i) * (dent(i) - before(i)), 1e-12);
        grown += dent(i) > before(i);
      }
      const double more = dent(i) - before(i);
      deepest = std::max(deepest, dent(i));
      volume += weight(i) * dent(i);
      dissipated += weight(i) * (xi(i) * more + 0.5 * H(i) * more * more);
      stored += weight(i) * 0.5 * compliance(i) * p(i) * p(i);
    }
    const ContactSums &sums = solved.result.sides[side];
    EXPECT_EQ(sums.max_dent, max_all(comm, deepest));
    EXPECT_NEAR(sums.dent_volume, sum_all(comm, volume), 1e-16);
    EXPECT_NEAR(sums.dissipated, sum_all(comm, dissipated), 1e-13);
    EXPECT_NEAR(sums.foundation_energy, sum_all(comm, stored), 1e-14);
    EXPECT_GT(sums.dissipated, 0);
    EXPECT_EQ(sums.foundation_energy > 0, side == 1);
  }
  EXPECT_GT(sum_all(comm, grown), 0);
  EXPECT_GT(sum_all(comm, kept), 0);
  const ContactSums &a = solved.result.sides[0], &b = solved.result.sides[1], &total = solved.result.total;
  EXPECT_EQ(total.max_dent, std::max(a.max_dent, b.max_dent));
  EXPECT_NEAR(total.dent_volume, a.dent_volume + b.dent_volume, 1e-16);
  EXPECT_NEAR(total.dissipated, a.dissipated + b.dissipated, 1e-15);
  EXPECT_NEAR(total.foundation_energy, a.foundation_energy + b.foundation_energy, 1e-15);
}

TEST(ContactResult, NodesThatAreHeldHaveThePressureOfTheirLawAtTheirPenetration)
{
  // Held 0.1 deep: in the spring of an elastic foundation, or past its limit.
  for (const double yield : {3., 30.}) {
    auto floor = below(40);
    floor.gap = ScalarField(0.);
    floor.yield_stress = ScalarField(yield);
    floor.hardening = ScalarField(20.);
    floor.stiffness = ScalarField(80.);
    const Scene scene(std::vector{floor}, held("bottom", {0, -0.1, 0}));
    const auto result =
        contact::contact_result(scene.d, {&scene.d.mesh->side("bottom", "test")}, scene.iterate->points(),
                                judged_at(*scene.iterate, *scene.elastic.dirichlet.value));
    const auto p = to_host(result.pressure), dent = to_host(result.dent);
    const double beyond = 0.1 - yield / 80, expected = yield == 3 ? 3 + beyond * 80 * 20 / 100 : 8;
    for (std::size_t i = 0; i < p.extent(0); ++i) {
      EXPECT_NEAR(p(i), expected, 1e-12);
      EXPECT_NEAR(dent(i), yield == 3 ? 0.1 - expected / 80 : 0, 1e-14);
    }
    EXPECT_NEAR(result.total.force[1], 2 * expected, 1e-12);
  }
}

} // namespace
} // namespace result_test
