// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/iterate.hpp"

#include "foundation_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace move_origin_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// |a - b|_2 / |b|_2
double difference(const Vector &a, const Vector &b)
{
  Vector c(a, Teuchos::Copy);
  c.update(-1., b, 1.);
  return c.norm2() / b.norm2();
}

/// Two equal scenes; the origin of one has gone, in two moves, to where the other's u starts from.
struct Pair {
  Scene moved{std::vector{below(40), beside(25)}}, still{std::vector{below(40), beside(25)}};
  RCP<Vector> start = still.vector(0.06, 0.9);

  Pair()
  {
    auto first = still.vector(0.2, 1.7);
    Vector rest(*start, Teuchos::Copy);
    rest.update(-1., *first, 1.);
    moved.iterate->move_origin(*first);
    EXPECT_EQ(first->norm2(), 0);
    moved.iterate->move_origin(rest);
    EXPECT_EQ(rest.norm2(), 0);
  }
  /// start + u, as the other sees it.
  Vector from_0(const Vector &u) const
  {
    Vector sum(*start, Teuchos::Copy);
    sum.update(1., u, 1.);
    return sum;
  }
  void expect_equal_multipliers() const
  {
    const auto a = to_host(moved.iterate->duals().multipliers().normal),
               b = to_host(still.iterate->duals().multipliers().normal);
    for (std::size_t i = 0; i < a.extent(0); ++i) EXPECT_NEAR(a(i), b(i), 1e-13);
  }
};

TEST(MoveOrigin, DisplacementIsSeenFromZero)
{
  const Pair pair;
  const auto u = pair.still.vector(0.05, 0.4);
  EXPECT_LT(difference(*pair.moved.iterate->state(*u).displacement, pair.from_0(*u)), 1e-15);
  EXPECT_EQ(difference(*pair.still.iterate->state(*u).displacement, *u), 0);
}

TEST(MoveOrigin, ChangesNothingInGradientsAndStates)
{
  const Pair pair;
  for (const double phase : {0.4, 2.1, 3.9}) {
    const auto u = pair.still.vector(0.05, phase), further = pair.still.vector(0.07, phase + 1);
    const Vector from_0 = pair.from_0(*u), further_from_0 = pair.from_0(*further);
    auto &moved = *pair.moved.iterate, &still = *pair.still.iterate;
    EXPECT_EQ(moved.update_hessian(*u), still.update_hessian(from_0));
    const auto a = moved.functional().count_states(*u), b = still.functional().count_states(from_0);
    EXPECT_EQ(a.open, b.open);
    EXPECT_EQ(a.closed, b.closed);
    EXPECT_EQ(a.yielding, b.yielding);
    EXPECT_GT(b.closed, 0);
    Vector F(u->getMap()), G(u->getMap());
    moved.gradient(*u, F);
    still.gradient(from_0, G);
    EXPECT_LT(difference(F, G), 1e-13);
    active_set_gradient(moved, *further, F);
    active_set_gradient(still, further_from_0, G);
    EXPECT_LT(difference(F, G), 1e-13);
  }
}

TEST(MoveOrigin, ChangesNothingInTheLineModelAndInDifferencesOfTheValue)
{
  const Pair pair;
  const auto u = pair.still.vector(0.05, 0.4), d = pair.still.vector(0.1, 2);
  const Vector from_0 = pair.from_0(*u);
  auto &moved = *pair.moved.iterate, &still = *pair.still.iterate;
  Vector F(u->getMap()), G(u->getMap());
  moved.gradient(*u, F);
  still.gradient(from_0, G);
  const auto a = moved.along(*u, *d, F), b = still.along(from_0, *d, G);
  for (const double t : {0., 0.3, 0.77, 1.9, -0.6}) {
    EXPECT_NEAR(a->at(t).slope, b->at(t).slope, 1e-13 * G.norm2() * d->norm2()) << t;
    EXPECT_NEAR(a->at(t).curvature, b->at(t).curvature, 1e-12 * b->at(t).curvature) << t;
  }
  Vector there(*u, Teuchos::Copy);
  there.update(1., *d, 1.);
  const double change = still.value(pair.from_0(there)) - still.value(from_0);
  EXPECT_NEAR(moved.value(there) - moved.value(*u), change, 1e-12 * std::abs(change));
}

TEST(MoveOrigin, ChangesNothingInMultiplierUpdates)
{
  const Pair pair;
  for (const double phase : {0.4, 2.1}) {
    const auto u = pair.still.vector(0.05, phase);
    const double change = pair.still.iterate->duals().update(pair.from_0(*u));
    EXPECT_NEAR(pair.moved.iterate->duals().update(*u), change, 1e-13);
    pair.expect_equal_multipliers();
    // energies and the contact law take displacements from 0 in both
    const Vector from_0 = pair.from_0(*u);
    EXPECT_EQ(contact_law_residual(*pair.moved.iterate, from_0), contact_law_residual(*pair.still.iterate, from_0));
    const double expected = energy(*pair.still.iterate, pair.still.elastic, from_0);
    EXPECT_NEAR(energy(*pair.moved.iterate, pair.moved.elastic, from_0), expected, 1e-12 * std::abs(expected));
  }
}

TEST(MoveOrigin, ChangesNothingInChoicesOfStates)
{
  const Pair pair;
  for (const double phase : {0.4, 2.1, 3.9, 0.8}) {
    const auto u = pair.still.vector(0.02, phase);
    const auto a = choose(*pair.moved.iterate, *u, 10), b = choose(*pair.still.iterate, pair.from_0(*u), 10);
    EXPECT_EQ(a.changes, b.changes);
    EXPECT_EQ(a.fingerprint, b.fingerprint);
    pair.expect_equal_multipliers();
  }
}

TEST(MoveOrigin, PenetrationsKeepDigitsOfTheirOwn)
{
  constexpr double far = 1000 + 1. / 3, penalty = 1e6, change = 1e-14; // eps far = 2e-13
  auto foundation = below(penalty);
  foundation.yield_stress = ScalarField(1e3);
  foundation.gap = field([](const Point &x) { return far + 0.1 * x[0] - 1e-6; });
  const Scene scene(std::vector{foundation}, held("top", {0, -far, 0}));
  auto &iterate = *scene.iterate;
  const auto u = scene.vector([](const Point &x) { return Point{0, -far - 0.1 * x[0], 0}; });
  u->update(1., *scene.elastic.dirichlet.value, 1.);
  iterate.move_origin(*u); // leaves v = 1e-6 and the rounding of far
  const auto copy = [&] {
    HostView<double *> lambda("lambda", iterate.points().size());
    Kokkos::deep_copy(lambda, to_host(iterate.duals().multipliers().normal));
    return lambda;
  };
  const auto zero = scene.vector(0, 0);
  iterate.duals().update(*zero);
  const auto before = copy();
  iterate.duals().update(*zero);
  const auto once = copy();
  iterate.duals().update(*scene.vector([](const Point &) { return Point{0, -change, 0}; }));
  const auto twice = copy();
  for (LO i = 0; i < iterate.points().size(); ++i) {
    EXPECT_NEAR(once(i) - before(i), penalty * 1e-6, penalty * 1e-12);
    EXPECT_NEAR((twice(i) - once(i)) - (once(i) - before(i)), penalty * change, 1e-6 * penalty * change);
  }
}

TEST(MoveOrigin, GradientKeepsTheDigitsOfSmallSteps)
{
  // Far from 0, a step of 1e-12 changes the forces by what the matrix makes of it.
  const Scene scene(std::vector{below(1e4)}, held("top", {700, -300, 0}));
  auto &iterate = *scene.iterate;
  Vector u(*scene.elastic.dirichlet.value, Teuchos::Copy);
  const auto all = scene.vector([](const Point &) { return Point{700, -300, 0}; });
  u.update(1., *all, 1.);
  iterate.update_hessian(u);
  iterate.move_origin(u);
  Vector F(u.getMap()), G(u.getMap()), Hd(u.getMap());
  iterate.gradient(u, F);
  const auto d = scene.vector([](const Point &x) { return Point{0, x[1] > 0 ? 1e-9 * std::sin(4 * x[0]) : 0, 0}; });
  iterate.gradient(*d, G);
  G.update(-1., F, 1.);
  iterate.hessian()->apply(*d, Hd);
  EXPECT_LT(difference(G, Hd), 1e-6);
}

} // namespace
} // namespace move_origin_test
