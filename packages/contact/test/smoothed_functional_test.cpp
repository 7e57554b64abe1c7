// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/iterate.hpp"

#include "functional_checks.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace smoothed_functional_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

TEST(SmoothedFunctional, GradientIsTheDerivativeOfTheValue)
{
  const Scene scene;
  const auto u = scene.vector(0.05, 0.4), d = scene.vector(1, 2);
  const auto states = scene.iterate->functional().count_states(*u);
  ASSERT_GT(states.open, 0); // all three pieces take part
  ASSERT_GT(states.closed, 0);
  ASSERT_GT(states.yielding, 0);
  Vector F(u->getMap());
  scene.iterate->gradient(*u, F);
  const double exact = F.dot(*d), scale = F.norm2() * d->norm2();
  const double h = 1e-5; // keeps each node on its piece, where differences of a quadratic are exact
  const double difference =
      (scene.iterate->value(*plus(*u, h, *d)) - scene.iterate->value(*plus(*u, -h, *d))) / (2 * h);
  EXPECT_NEAR(difference, exact, 1e-9 * scale);
}

TEST(SmoothedFunctional, HessianIsTheDerivativeOfTheGradientOnEachPiece)
{
  const Scene scene;
  auto &iterate = *scene.iterate;
  const auto u = scene.vector(0.05, 0.4), d = scene.vector(1, 2);
  EXPECT_GT(iterate.update_hessian(*u), 0);
  EXPECT_EQ(iterate.update_hessian(*u), 0); // nothing changes twice
  Vector Hd(u->getMap()), up(u->getMap()), down(u->getMap());
  iterate.hessian()->apply(*d, Hd);
  const double h = 1e-5;
  iterate.gradient(*plus(*u, h, *d), up);
  iterate.gradient(*plus(*u, -h, *d), down);
  up.update(-1., down, 1.);
  up.scale(1 / (2 * h));
  up.update(-1., Hd, 1.);
  EXPECT_LT(up.norm2(), 1e-9 * Hd.norm2());
}

TEST(SmoothedFunctional, GradientIsTheDerivativeOfTheValueWhereSidesMeet)
{
  const Scene scene(std::vector{below(40), beside(25)});
  const auto u = scene.vector(0.05, 0.4), d = scene.vector(1, 2);
  Vector F(u->getMap());
  scene.iterate->gradient(*u, F);
  const double h = 1e-5;
  const double difference =
      (scene.iterate->value(*plus(*u, h, *d)) - scene.iterate->value(*plus(*u, -h, *d))) / (2 * h);
  EXPECT_NEAR(difference, F.dot(*d), 1e-9 * F.norm2() * d->norm2());
}

TEST(SmoothedFunctional, HessianOfANodeOfTwoSidesIsTheDerivativeInEachOfItsStates)
{
  const Scene scene(std::vector{below(40), beside(25)});
  auto &iterate = *scene.iterate;
  // The corner (2, 0) along the normals (0, -1) and (0.8, -0.6) of its two points, the other nodes anyhow. Multipliers
  // are 1.5 and 1.5: the first point is closed for v in (-0.0375, 0.0375), the second for v in (-0.06, 0.06).
  struct Case {
    const char *name;
    double below, beside; // u along the normals
  };
  const Case cases[] = {{"both closed", 0, 0},      {"open below", -0.2, 0},    {"both open", -0.2, -0.2},
                        {"open beside", 0, -1},     {"yielding below", 0.3, 0}, {"both yielding", 0.3, 0.3},
                        {"both closed again", 0, 0}};
  const bool closed[][2] = {{true, true},  {false, true},  {false, false}, {true, false},
                            {false, true}, {false, false}, {true, true}};
  const Scene alone(std::vector<contact::ContactOptions>{});
  const auto at_corner = [&](const Point &x, const Point &value, const Point &elsewhere) {
    return x[0] == 2 && x[1] == 0 ? value : elsewhere;
  };
  for (std::size_t k = 0; k < std::size(cases); ++k) {
    SCOPED_TRACE(cases[k].name);
    const Point corner{(cases[k].beside - 0.6 * cases[k].below) / 0.8, -cases[k].below, 0};
    const auto u = scene.vector([&](const Point &x) {
      return at_corner(x, corner, {0.05 * std::sin(5 * x[0] + x[1]), 0.05 * std::sin(0.4 + 5 * x[0] - k), 0});
    });
    iterate.update_hessian(*u);
    EXPECT_EQ(iterate.update_hessian(*u), 0);
    // The corner's block of H along both of its unknowns, against K's alone, and everything at once.
    double along[2];
    for (int c = 0; c < 2; ++c) {
      const auto d = scene.vector([&](const Point &x) {
        return at_corner(x, {c == 0 ? 1. : 0., c == 1 ? 1. : 0., 0}, {});
      });
      EXPECT_LT(hessian_error(iterate, *u, *d), 1e-9) << c;
      Vector Hd(u->getMap());
      iterate.hessian()->apply(*d, Hd);
      along[c] = Hd.dot(*d);
    }
    EXPECT_LT(hessian_error(iterate, *u, *scene.vector(1, 2)), 1e-9);
    // r w m m^T with weights 1/6 below and beside; K of the corner's cell by the diagonal of a cell of 1/3 x 1/3
    for (int c = 0; c < 2; ++c) {
      const auto d = alone.vector([&](const Point &x) {
        return at_corner(x, {c == 0 ? 1. : 0., c == 1 ? 1. : 0., 0}, {});
      });
      Vector Kd(u->getMap());
      alone.iterate->hessian()->apply(*d, Kd);
      const double of_below = closed[k][0] && c == 1 ? 40. / 6 : 0,
                   of_beside = closed[k][1] ? 25. / 6 * (c == 0 ? 0.64 : 0.36) : 0;
      EXPECT_NEAR(along[c], Kd.dot(*d) + of_below + of_beside, 1e-13 * 40);
    }
  }
}

TEST(SmoothedFunctional, StatesCountThePointsOfBothSides)
{
  const Scene scene(std::vector{below(40), beside(25)});
  const auto states = scene.iterate->functional().count_states(*scene.vector(0.05, 0.4));
  EXPECT_EQ(states.open + states.closed + states.yielding, 7 + 3); // the held point at (2, 1) is in none
  EXPECT_EQ(scene.iterate->points().num_total, 7 + 4);
  EXPECT_EQ(scene.iterate->points().num_fixed, 1);
}

TEST(SmoothedFunctional, AcrossAKinkTheGradientIsContinuousAndATaylorStepMissesAtFirstOrder)
{
  // The node at (1, 0) is closed and has the multiplier 1, half its yield limit: it opens at v = -1/40 and yields at v = 1/40. It is
  // short of that, and d leads it across; the other contact nodes stay where they are.
  constexpr double penalty = 40, weight = 1. / 3, distance = 1e-9;
  for (const double upwards : {1., -1.}) { // opens, yields
    SCOPED_TRACE(upwards);
    const Scene scene(penalty);
    auto &iterate = *scene.iterate;
    const auto at_node = [](const Point &x, const double value, const double elsewhere) {
      return Point{0, std::abs(x[0] - 1) < 1e-12 && x[1] == 0 ? value : elsewhere, 0};
    };
    const auto u = scene.vector([&](const Point &x) {
      return at_node(x, upwards * (1 / penalty - distance), 0.05 * std::sin(2.4 + 5 * x[0] + 3 * x[1]));
    });
    const auto d = scene.vector([&](const Point &x) { return at_node(x, upwards, 0); });
    iterate.update_hessian(*u);
    Vector F(u->getMap()), Hd(u->getMap());
    iterate.gradient(*u, F);
    iterate.hessian()->apply(*d, Hd);
    const auto change = [&](const double h) {
      Vector G(u->getMap());
      iterate.gradient(*plus(*u, h, *d), G);
      G.update(-1., F, 1.);
      return G;
    };
    const auto missed = [&](const double h) { // F(u + h d) - F(u) - h H d
      Vector G = change(h);
      G.update(-h, Hd, 1.);
      return G.norm2();
    };
    EXPECT_LT(change(2 * distance).norm2(), 2.1 * distance * Hd.norm2()); // no jump
    const auto before = iterate.functional().count_states(*u);
    for (const double h : {0.02, 0.01, 0.005}) {
      const auto after = iterate.functional().count_states(*plus(*u, h, *d));
      EXPECT_EQ(after.closed, before.closed - 1) << h;
      EXPECT_EQ(after.open, before.open + (upwards > 0 ? 1 : 0)) << h;
      EXPECT_EQ(after.yielding, before.yielding + (upwards > 0 ? 0 : 1)) << h;
      EXPECT_NEAR(missed(h) / h, penalty * weight, 1e-6 * penalty * weight) << h;
      EXPECT_LT(missed(-h) / h, 1e-10 * penalty * weight)
          << h; // back into the piece: the functional is quadratic there
    }
  }
}

TEST(SmoothedFunctional, ValueDoesNotSeeWhichContactBlocksAreInTheMatrix)
{
  const Scene scene(1e8);
  auto &iterate = *scene.iterate;
  const auto u = scene.vector(1e-9, 0.4);
  const double before = iterate.value(*u);
  ASSERT_GT(iterate.update_hessian(*scene.vector(0, 0)), 0);
  EXPECT_NEAR(iterate.value(*u), before, 1e-9 * std::abs(before));
  EXPECT_GT(iterate.update_hessian(*scene.vector(1, 0.4)), 0);
}

TEST(SmoothedFunctional, LineModelGivesTheSlopeOfTheFunctional)
{
  const Scene scene;
  auto &iterate = *scene.iterate;
  const auto u = scene.vector(0.05, 0.4), d = scene.vector(0.1, 2);
  expect_line_model(iterate, *u, *d);
}

TEST(SmoothedFunctional, SubspaceModelGivesTheGradientOfTheFunctional)
{
  const Scene scene;
  auto &iterate = *scene.iterate;
  const auto u = scene.vector(0.05, 0.4);
  const std::vector<RCP<const Vector>> directions{scene.vector(0.1, 2), scene.vector(0.3, 0.7), scene.vector(0.02, 5)};
  const std::size_t n = directions.size();
  Vector F(u->getMap());
  iterate.gradient(*u, F);
  const auto model = iterate.within(*u, directions, F);
  const std::vector<double> cases[] = {{0, 0, 0}, {0.3, 0, 0}, {0.77, -0.4, 0.1}, {-0.6, 1.9, -2}};
  for (const auto &a : cases) {
    SCOPED_TRACE(a[0]);
    const auto gradient = [&](const std::vector<double> &at) {
      Vector there(*u, Teuchos::Copy), G(u->getMap());
      for (std::size_t k = 0; k < n; ++k) there.update(at[k], *directions[k], 1.);
      iterate.gradient(there, G);
      std::vector<double> values(n);
      for (std::size_t k = 0; k < n; ++k) values[k] = G.dot(*directions[k]);
      return values;
    };
    const auto value = model->at(a);
    const auto expected = gradient(a);
    const double size = *std::max_element(expected.begin(), expected.end(),
                                          [](const double x, const double y) { return std::abs(x) < std::abs(y); });
    for (std::size_t k = 0; k < n; ++k) {
      EXPECT_NEAR(value.gradient[k], expected[k], 1e-11 * std::abs(size)) << k;
      constexpr double h = 1e-6;
      auto above = a, below = a;
      above[k] += h;
      below[k] -= h;
      const auto up = gradient(above), down = gradient(below);
      for (std::size_t l = 0; l < n; ++l)
        EXPECT_NEAR(value.curvature[n * k + l], (up[l] - down[l]) / (2 * h),
                    1e-6 * std::abs(value.curvature[n * k + k]) + 1e-6 * std::abs(value.curvature[n * l + l]))
            << k << l;
    }
  }
}

TEST(SmoothedFunctional, LinesWithinASubspaceHaveTheSlopeOfTheFunctional)
{
  auto rubbing = below(40);
  rubbing.friction_bound = ScalarField(0.1);
  for (const auto &foundation : {below(40), rubbing}) {
    const Scene scene(std::vector{foundation});
    expect_lines_within(*scene.iterate, *scene.vector(0.05, 0.4),
                        {scene.vector(0.1, 2), scene.vector(0.3, 0.7), scene.vector(0.02, 5)});
  }
}

TEST(SmoothedFunctional, PieceGradientIsTheGradientOnThePieceOfTheHessian)
{
  const Scene scene;
  auto &iterate = *scene.iterate;
  const auto u = scene.vector(0.05, 0.4), far = scene.vector(0.08, 1.1);
  iterate.update_hessian(*u);
  Vector F(u->getMap()), G(u->getMap()), step(u->getMap());
  iterate.gradient(*u, F);
  active_set_gradient(iterate, *u, G);
  G.update(-1., F, 1.);
  EXPECT_LT(G.norm2(), 1e-13 * F.norm2()); // the piece at u is the Hessian's own
  active_set_gradient(iterate, *far, G);
  iterate.gradient(*far, F);
  G.update(-1., F, 1.);
  EXPECT_GT(G.norm2(), 1e-3 * F.norm2()); // elsewhere it is another one
}

TEST(SmoothedFunctional, MultiplierUpdateIsTheSmoothedPressureAndStaysWithinLimits)
{
  const Scene scene;
  auto &iterate = *scene.iterate;
  const auto u = scene.vector(0.05, 0.4);
  const auto before = to_host(iterate.duals().multipliers().normal);
  HostView<double *> old("old", before.extent(0));
  Kokkos::deep_copy(old, before);
  const double change = iterate.duals().update(*u);
  EXPECT_GT(change, 0);
  EXPECT_LE(change, 1);
  const auto now = to_host(iterate.duals().multipliers().normal);
  const auto &c = iterate.points();
  const auto yield = to_host(c.law.yield), gap = to_host(c.gap);
  const auto node = to_host(c.node);
  const auto x = u->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO i = 0; i < c.size(); ++i) {
    const double v = -x(2 * node(i) + 1, 0) - gap(i);
    EXPECT_NEAR(now(i), std::min(std::max(old(i) + 40 * v, 0.), yield(i)), 1e-14);
  }
}

TEST(SmoothedFunctional, EnergiesAndResidualsDoNotDependOnTheNumberOfRanks)
{
  const Scene scene;
  auto &iterate = *scene.iterate;
  const auto u = scene.vector(0.05, 0.4);
  iterate.duals().update(*u);
  // Values of one rank, to be met by all.
  EXPECT_NEAR(iterate.value(*u), 0.41911329126094887, 1e-13);
  EXPECT_NEAR(energy(iterate, scene.elastic, *u), 0.41226150411482143, 1e-13);
  Vector residual(u->getMap());
  iterate.hessian()->apply(*u, residual); // K: no states were chosen
  const Vector contact = multiplier_forces(iterate);
  residual.update(1., contact, -1., *scene.elastic.load, 1.);
  EXPECT_NEAR(residual.norm2() / std::max(iterate.force_scale(), contact.norm2()), 3.4491199932704339, 1e-12);
  const auto states = iterate.functional().count_states(*u);
  EXPECT_EQ(states.open + states.closed + states.yielding, 7);
}

TEST(SmoothedFunctional, ContactLawResidualVanishesExactlyForPairsThatObeyTheLaw)
{
  const Scene scene;
  auto &iterate = *scene.iterate;
  const auto u = scene.vector(0.05, 0.4);
  for (int k = 0; k < 200; ++k) iterate.duals().update(*u); // at a fixed u: lambda goes to 0 or xi, where v says so
  EXPECT_LT(contact_law_residual(iterate, *u), 1e-14);
  iterate.duals().update(*scene.vector(0.05, 3.4));
  EXPECT_GT(contact_law_residual(iterate, *u), 1e-3);
}

TEST(SmoothedFunctional, FallsInEachSweepUntilContactForcesBalance)
{
  const Scene scene;
  expect_sweeps_to_balance(scene, 200, 1e-9);
}

TEST(SmoothedFunctional, SweepsWhereOneNodeAloneMayTouch)
{
  auto foundation = below(40);
  foundation.gap = field([](const Point &x) { return x[0] == 0 ? 0 : 1; });
  const Scene scene(std::vector{foundation});
  const auto u = scene.vector(0.02, 0.3);
  const double before = scene.iterate->value(*u);
  for (int sweep = 0; sweep < 3; ++sweep) scene.iterate->sweep(*u); // ranks that have no contact node take part
  EXPECT_LT(scene.iterate->value(*u), before);
}

TEST(SmoothedFunctional, WithFrictionSweepsLeaveTheCornerOfTwoSidesWhereItIs)
{
  auto bottom = below(1e4), right = beside(1e4);
  right.normal = contact::Normal::surface; // a move along one normal slips along the other side
  bottom.friction_bound = right.friction_bound = ScalarField(1.);
  const Scene scene(std::vector{bottom, right});
  const auto u = scene.vector(0.02, 0.3);
  double before = scene.iterate->value(*u);
  for (int sweep = 0; sweep < 20; ++sweep) {
    const Vector last(*u, Teuchos::Copy);
    scene.iterate->sweep(*u);
    const double now = scene.iterate->value(*u);
    EXPECT_LE(now, before + 1e-13 * std::abs(before)) << sweep;
    if (sweep == 0) {
      EXPECT_LT(now, before);
    }
    before = now;
    const auto is = u->getLocalViewHost(Tpetra::Access::ReadOnly),
               was = last.getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto at = to_host(scene.d.mesh->coords);
    for (LO n = 0; n < scene.d.mesh->num_owned_nodes(); ++n)
      for (int k = 0; at(n, 0) == 2 && at(n, 1) == 0 && k < 2; ++k) EXPECT_EQ(is(2 * n + k, 0), was(2 * n + k, 0));
  }
}

TEST(SmoothedFunctional, PiecesOfFrictionDifferByWhatSticks)
{
  auto foundation = below(40);
  foundation.friction_bound = ScalarField(0.1);
  const Scene scene(std::vector{foundation});
  const auto still = scene.vector([](const Point &) { return Point{}; }), moved = scene.vector([](const Point &x) {
    return Point{x[1] == 0 && x[0] > 1 ? 1. : 0., 0, 0};
  });
  EXPECT_EQ(scene.iterate->functional().count_sticking(*still), scene.iterate->points().num_total);
  EXPECT_LT(scene.iterate->functional().count_sticking(*moved), scene.iterate->points().num_total);
  EXPECT_GT(scene.iterate->functional().count_sticking(*moved), 0);
  EXPECT_EQ(scene.iterate->functional().count_states(*still).open,
            scene.iterate->functional().count_states(*moved).open);
  EXPECT_NE(scene.iterate->piece(*still), scene.iterate->piece(*moved));
}

} // namespace
} // namespace smoothed_functional_test
