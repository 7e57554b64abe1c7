// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/optimality_residuals.hpp"

#include "dense.hpp"
#include "foundation_scene.hpp"
#include "judged.hpp"
#include "rpc/algebra/bounded_update.hpp"
#include "rpc/fem/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace optimality_residuals_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;
using contact::OptimalityResiduals;

/// The block with its stiffness kept as it is without contact, and residual energies by a direct solver.
struct Judged : Scene {
  CrsMatrix K;
  DenseInverse inverse;

  Judged(const std::vector<contact::ContactOptions> &foundations, const fem::DirichletCondition &condition)
      : Scene(foundations, condition), K(*iterate->hessian()->base().matrix(), Teuchos::Copy), inverse(K)
  {
  }
  explicit Judged(const std::vector<contact::ContactOptions> &foundations = {below(40)}, const Point &top = {})
      : Judged(foundations, held("top", top))
  {
  }
  OptimalityResiduals residuals(const Vector &u, const double least_energy = 0) const
  {
    return contact::optimality_residuals(
        d, material, elastic, iterate->points(), judged_at(*iterate, u), iterate->force_scale(),
        [&](const Vector &F) { return F.dot(inverse.times(F)); }, least_energy);
  }
  /// K u - b + B lambda: 0 where prescribed.
  Vector residual(const Vector &u) const
  {
    Vector F(u.getMap());
    K.apply(u, F);
    F.update(1., multiplier_forces(*iterate), -1., *elastic.load, 1.);
    return F;
  }
  /// Pi(u) [J]
  double elastic_energy(const Vector &u) const { return test::elastic_energy(K, elastic, u); }
  /// sum_i w_i energy(v_i, lambda_i, xi_i)
  template <class Energy>
  double over_contact(const Vector &u, const Energy &energy) const
  {
    const auto &c = iterate->points();
    const auto node = to_host(c.node);
    const auto m = to_host(c.direction);
    const auto w = to_host(c.weight), gap = to_host(c.free_gap), xi = to_host(c.law.yield),
               lambda = to_host(iterate->duals().multipliers().normal);
    const auto x = u.getLocalViewHost(Tpetra::Access::ReadOnly);
    double sum = 0;
    for (LO i = 0; i < c.size(); ++i)
      sum += w(i) * energy(m(i, 0) * x(2 * node(i), 0) + m(i, 1) * x(2 * node(i) + 1, 0) - gap(i), lambda(i), xi(i));
    return sum_all(*u.getMap()->getComm(), sum);
  }
  /// An admissible displacement.
  RCP<Vector> displacement(const double scale, const double phase) const
  {
    const auto u = vector(scale, phase);
    u->update(1., *elastic.dirichlet.value, 1.);
    return u;
  }
  /// The solution, with its multipliers: Newton with a line search, and many updates of a penalty that is easy on both.
  RCP<Vector> solution() const
  {
    const auto u = rcp(new Vector(*elastic.dirichlet.value, Teuchos::Copy));
    Vector F(u->getMap());
    for (int uzawa = 0; uzawa < 150; ++uzawa) {
      for (int newton = 0; newton < 30; ++newton) {
        iterate->update_hessian(*u);
        iterate->gradient(*u, F);
        const UpdatedOperator &H = *iterate->hessian();
        const auto A = H.base().copy();
        write_update(*A, H, H.update());
        Vector d = DenseInverse(*A).times(F);
        d.scale(-1.);
        u->update(step_along(iterate->along(*u, d, F)), d, 1.);
        if (d.normInf() < 1e-15) break;
      }
      if (iterate->duals().update(*u) < 1e-14) break;
    }
    return u;
  }

private:
  /// 1, or where the slope vanishes before.
  static double step_along(const std::unique_ptr<LineFunction> &line)
  {
    double low = 0, high = 1;
    if (!(line->at(high).slope > 1e-12 * std::abs(line->at(0).slope))) return high;
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = 0.5 * (low + high);
      (line->at(middle).slope < 0 ? low : high) = middle;
    }
    return high;
  }
};

RCP<Vector> plus(const Vector &u, const double t, const Vector &d)
{
  const auto sum = rcp(new Vector(u, Teuchos::Copy));
  sum->update(t, d, 1.);
  return sum;
}

void expect_residuals(const OptimalityResiduals &c, const OptimalityResiduals &expected, const double tolerance)
{
  EXPECT_NEAR(c.equilibrium_residual, expected.equilibrium_residual, tolerance);
  EXPECT_NEAR(c.kkt_residual, expected.kkt_residual, tolerance);
  EXPECT_NEAR(c.energy_balance, expected.energy_balance, tolerance);
  EXPECT_NEAR(c.duality_gap, expected.duality_gap, tolerance);
}

TEST(OptimalityResiduals, WorstIsTheLargestPartAndNaNIfOneIs)
{
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(OptimalityResiduals().worst(), 0);
  for (int k = 0; k < 4; ++k) {
    const auto with = [k](const double value) {
      double parts[4] = {0.1, 0.1, 0.1, 0.1};
      parts[k] = value;
      return OptimalityResiduals{parts[0], parts[1], parts[2], parts[3], {}};
    };
    EXPECT_EQ(with(0.3).worst(), 0.3);
    EXPECT_TRUE(with(0.3).holds(0.3));
    EXPECT_FALSE(with(0.3).holds(0.29));
    EXPECT_TRUE(std::isnan(with(nan).worst()));
    EXPECT_FALSE(with(nan).holds(inf));
    EXPECT_EQ(with(inf).worst(), inf);
  }
}

TEST(OptimalityResiduals, EquilibriumResidualIsThatOfTheMatrix)
{
  for (const Point top : {Point{}, Point{0.03, -0.02, 0}}) {
    const Judged scene({below(40), beside(25)}, top);
    const auto u = scene.displacement(0.05, 0.4);
    scene.iterate->duals().update(*u);
    const double scale = std::max({scene.iterate->force_scale(), multiplier_forces(*scene.iterate).norm2(),
                                   fem::internal_work(scene.d, scene.material, *u).force_norm});
    const double expected = scene.residual(*u).norm2() / scale;
    ASSERT_GT(expected, 0.01);
    EXPECT_NEAR(scene.residuals(*u).equilibrium_residual, expected, 1e-13 * expected);
  }
}

TEST(OptimalityResiduals, EnergyBalanceIsWhatTheResidualDoesAlongTheFreeUnknowns)
{
  for (const Point top : {Point{}, Point{0.03, -0.02, 0}}) {
    const Judged scene({below(40), beside(25)}, top);
    const auto u = scene.displacement(0.05, 0.4);
    scene.iterate->duals().update(*u);
    // Less the translation by the prescribed displacement, nothing is left of that.
    const auto translated = scene.vector([&](const Point &) { return top; }); // 0 where prescribed
    const Vector free = *plus(*plus(*u, -1, *scene.elastic.dirichlet.value), -1, *translated);
    Vector internal(u->getMap());
    fem::assemble_stiffness(scene.d, scene.material)->apply(*u, internal);
    const double at_work = std::max({u->dot(internal), std::abs(free.dot(*scene.elastic.applied_load)),
                                     std::abs(free.dot(multiplier_forces(*scene.iterate)))});
    const double expected = std::abs(free.dot(scene.residual(*u))) / at_work;
    ASSERT_GT(expected, 0.01);
    EXPECT_NEAR(scene.residuals(*u).energy_balance, expected, 1e-12 * expected);
  }
}

TEST(OptimalityResiduals, DualityGapIsThePrimalLessTheDualEnergy)
{
  for (const Point top : {Point{}, Point{0.03, -0.02, 0}}) {
    const Judged scene({below(40)}, top);
    const auto u = scene.displacement(0.05, 0.4);
    scene.iterate->duals().update(*u);
    const auto lambda = to_host(scene.iterate->duals().multipliers().normal);
    double largest = 0;
    for (std::size_t i = 0; i < lambda.extent(0); ++i) largest = std::max(largest, lambda(i));
    ASSERT_GE(2 * max_all(scene.d.mesh->comm(), largest), 3); // else the highest yield limit would be cut

    const double primal = scene.elastic_energy(*u) +
                          scene.over_contact(*u, [](double v, double, double xi) { return xi * std::max(v, 0.); });
    Vector load(*scene.elastic.load, Teuchos::Copy);
    load.update(-1., multiplier_forces(*scene.iterate), 1.);
    const Vector lowest = scene.inverse.times(load);
    const double dual =
        scene.elastic_energy(lowest) + scene.over_contact(lowest, [](double v, double p, double) { return p * v; });
    const double strain = fem::internal_work(scene.d, scene.material, *u).energy_norm_squared;
    const double dissipated = scene.over_contact(*u, [](double v, double p, double) { return p * std::max(v, 0.); });
    const double expected = (primal - dual) / std::max(0.5 * strain, dissipated);
    ASSERT_GT(expected, 0.01);
    EXPECT_NEAR(scene.residuals(*u).duality_gap, expected, 1e-12 * expected);
  }
}

TEST(OptimalityResiduals, ContactEnergyIsSummedOverThePointsWithTwiceTheLargestMultiplierForHigherLimits)
{
  auto rigid = below(40);
  rigid.yield_stress = ScalarField(std::numeric_limits<double>::infinity());
  const Judged scene({rigid});
  const auto u = scene.displacement(0.05, 0.4);
  scene.iterate->duals().update(*u);
  double largest = 0;
  const auto lambda = to_host(scene.iterate->duals().multipliers().normal);
  for (std::size_t i = 0; i < lambda.extent(0); ++i) largest = std::max(largest, lambda(i));
  largest = max_all(scene.d.mesh->comm(), largest);
  ASSERT_GT(largest, 0.1);
  const auto energy = contact_energy(*scene.iterate, *u);
  const double gap =
      scene.over_contact(*u, [&](double v, double p, double) { return 2 * largest * std::max(v, 0.) - p * v; });
  EXPECT_NEAR(energy.duality_gap, gap, 1e-13 * gap);
  const double dissipated = scene.over_contact(*u, [](double v, double p, double) { return p * std::max(v, 0.); });
  EXPECT_NEAR(energy.dissipated, dissipated, 1e-13 * dissipated);
}

TEST(OptimalityResiduals, OfTheSolutionIsZero)
{
  contact::StateCounts seen;
  for (const Point top : {Point{}, Point{0.3, -0.2, 0}, Point{-0.1, 0.1, 0}}) {
    const Judged scene({below(40), beside(25)}, top);
    const auto u = scene.solution();
    const auto states = scene.iterate->functional().count_states(*u);
    seen.open += states.open;
    seen.closed += states.closed;
    seen.yielding += states.yielding;
    expect_residuals(scene.residuals(*u), {}, 1e-12);
  }
  EXPECT_GT(seen.open, 0);
  EXPECT_GT(seen.closed, 0);
  EXPECT_GT(seen.yielding, 0);
}

/// log2 of how much each part falls where the disturbance is halved.
OptimalityResiduals orders(const OptimalityResiduals &whole, const OptimalityResiduals &half)
{
  return {std::log2(whole.equilibrium_residual / half.equilibrium_residual),
          std::log2(whole.kkt_residual / half.kkt_residual),
          std::log2(whole.energy_balance / half.energy_balance),
          std::log2(whole.duality_gap / half.duality_gap),
          {}};
}

TEST(OptimalityResiduals, GrowsLinearlyWithADisturbanceOfTheContactNodes)
{
  const Judged scene;
  const auto u = scene.solution(), d = scene.vector(1, 2);
  const auto order = orders(scene.residuals(*plus(*u, 1e-5, *d)), scene.residuals(*plus(*u, 5e-6, *d)));
  EXPECT_NEAR(order.equilibrium_residual, 1, 0.01);
  EXPECT_NEAR(order.kkt_residual, 1, 0.01);
  EXPECT_NEAR(order.energy_balance, 1, 0.01);
  EXPECT_NEAR(order.duality_gap, 1, 0.01); // (xi - lambda) v+ where a node is closed
}

TEST(OptimalityResiduals, GapGrowsQuadraticallyWhereOnlyEquilibriumIsDisturbed)
{
  const Judged scene;
  const auto u = scene.solution();
  const auto d = scene.vector([](const Point &x) {
    return Point{std::sin(5 * x[0] + 3 * x[1]), x[1] > 0 ? std::cos(4 * x[0]) : 0, 0};
  });
  const auto whole = scene.residuals(*plus(*u, 1e-6, *d)), half = scene.residuals(*plus(*u, 5e-7, *d));
  const auto order = orders(whole, half);
  EXPECT_NEAR(order.equilibrium_residual, 1, 0.01);
  EXPECT_LT(whole.kkt_residual, 1e-12);
  EXPECT_NEAR(order.energy_balance, 1, 0.01);
  EXPECT_NEAR(order.duality_gap, 2, 0.01);
  Vector Kd(d->getMap());
  scene.K.apply(*d, Kd);
  const double strain = fem::internal_work(scene.d, scene.material, *plus(*u, 1e-6, *d)).energy_norm_squared,
               dissipated = contact_energy(*scene.iterate, *u).dissipated;
  const double expected = 0.5e-12 * d->dot(Kd) / std::max(0.5 * strain, dissipated);
  EXPECT_NEAR(whole.duality_gap, expected, 1e-5 * expected);
}

TEST(OptimalityResiduals, GrowsWithADisturbanceOfTheMultipliers)
{
  // At closed nodes, where v = 0, any multiplier within the limits satisfies the contact law.
  const auto disturbed = [](const double t) {
    const Judged scene;
    const auto u = scene.solution();
    scene.iterate->duals().update(*plus(*u, t, *scene.vector(1, 2)));
    return scene.residuals(*u);
  };
  const auto whole = disturbed(1e-5);
  const auto order = orders(whole, disturbed(5e-6));
  EXPECT_NEAR(order.equilibrium_residual, 1, 0.01);
  EXPECT_LT(whole.kkt_residual, 1e-12);
  EXPECT_NEAR(order.energy_balance, 1, 0.01);
  EXPECT_NEAR(order.duality_gap, 2, 0.01);
}

TEST(OptimalityResiduals, IsNaNWhereADisplacementIsAndHoldsAtNoTolerance)
{
  for (const double height : {0., 1. / 3}) { // a contact node, a node inside
    const Judged scene;
    const auto u = scene.solution();
    const auto nan = scene.vector([&](const Point &x) {
      const bool there = std::abs(x[0] - 1) < 1e-9 && std::abs(x[1] - height) < 1e-9;
      return Point{0, there ? std::numeric_limits<double>::quiet_NaN() : 0, 0};
    });
    const auto c = scene.residuals(*plus(*u, 1, *nan));
    EXPECT_TRUE(std::isnan(c.worst()));
    EXPECT_FALSE(c.holds(std::numeric_limits<double>::infinity()));
  }
}

TEST(OptimalityResiduals, DoesNotSeeARigidMotionOfBodyAndFoundation)
{
  struct Motion {
    double x, y, turn;
  };
  const auto disturbed = [](const Motion &r, const double t) {
    const auto x_motion = field([r](const Point &x) { return r.x - r.turn * x[1]; });
    const auto y_motion = field([r](const Point &x) { return r.y + r.turn * x[0]; });
    auto foundation = below(40);
    foundation.gap = field([r](const Point &x) { return 0.02 * (1 - x[0]) - r.y - r.turn * x[0]; }); // normal (0, -1)
    const Judged scene({foundation}, {"top", "top", {x_motion, y_motion}});
    const auto u = scene.solution(), d = scene.vector(1, 2);
    scene.iterate->duals().update(*plus(*u, t, *d));
    return scene.residuals(*plus(*u, t, *scene.vector(1, 0.5)));
  };
  for (const Motion r : {Motion{0.5, -0.25, 0}, {-30, 20, 0}, {0, 0, 40}}) {
    const double rounding = 1e-14 * (1 + (std::hypot(r.x, r.y) + r.turn) / 0.02); // the body deforms by 0.02
    expect_residuals(disturbed(r, 0), {}, rounding);
    const auto at_rest = disturbed({}, 1e-3);
    ASSERT_GT(
        std::min({at_rest.equilibrium_residual, at_rest.kkt_residual, at_rest.energy_balance, at_rest.duality_gap}),
        1e-5);
    expect_residuals(disturbed(r, 1e-3), at_rest, rounding);
  }
}

TEST(OptimalityResiduals, OfABodyThatItsSupportsLiftOffAreRounding)
{
  const Judged scene({below(40)}, {0.3, 0.7, 0});
  fem::ElasticProblem weightless = scene.elastic; // nothing acts on it, so that all forces are rounding
  const auto load = rcp(new Vector(*weightless.load, Teuchos::Copy));
  load->update(-1., *weightless.applied_load, 1.);
  fem::clear_prescribed(weightless.dirichlet, *load);
  weightless.load = load;
  weightless.applied_load = rcp(new Vector(load->getMap()));
  const auto lifted = scene.vector([](const Point &) { return Point{0.3, 0.7, 0}; });
  lifted->update(1., *weightless.dirichlet.value, 1.);
  scene.iterate->duals().update(*lifted);
  const auto judged = [&](const double disturbance) {
    return contact::optimality_residuals(scene.d, scene.material, weightless, scene.iterate->points(),
                                         judged_at(*scene.iterate, *plus(*lifted, disturbance, *scene.vector(1, 0.5))),
                                         0, [&](const Vector &F) { return F.dot(scene.inverse.times(F)); });
  };
  EXPECT_GT(judged(1e-15).internal.force_norm, 0);
  EXPECT_TRUE(judged(1e-15).holds(1e-7)) << judged(1e-15).worst();
  EXPECT_GT(judged(1e-6).equilibrium_residual, 0.1); // no rounding
}

TEST(OptimalityResiduals, WhatRoundingLeavesOfTheDisplacementCounts)
{
  const Judged scene;
  const auto u = scene.displacement(0.05, 0.4), rest = scene.vector(1e-3, 0.7);
  scene.iterate->duals().update(*u);
  auto state = judged_at(*scene.iterate, *u);
  state.rest = rest;
  const auto judged = [&](const contact::ContactState &at) {
    return contact::optimality_residuals(scene.d, scene.material, scene.elastic, scene.iterate->points(), at,
                                         scene.iterate->force_scale(),
                                         [&](const Vector &F) { return F.dot(scene.inverse.times(F)); });
  };
  const auto with = judged(state);
  state.displacement = plus(*u, 1, *rest);
  state.rest = Teuchos::null;
  const auto sum = judged(state);
  EXPECT_NEAR(with.equilibrium_residual * with.force_size, sum.equilibrium_residual * sum.force_size,
              1e-13 * sum.force_size);
  Vector difference(*with.forces, Teuchos::Copy);
  difference.update(-1., *sum.internal.forces, 1.);
  EXPECT_LT(difference.norm2(), 1e-13 * sum.force_size);
}

TEST(OptimalityResiduals, AnIterateKnowsWhatRoundingLeavesOfItsDisplacement)
{
  const Judged scene;
  const auto u = scene.displacement(0.05, 0.4), origin = rcp(new Vector(*u, Teuchos::Copy));
  EXPECT_TRUE(scene.iterate->state(*u).rest.is_null());
  scene.iterate->move_origin(*u);
  const auto correction = scene.vector(1e-9, 0.3);
  const auto state = scene.iterate->state(*correction);
  ASSERT_FALSE(state.rest.is_null());
  const auto a = origin->getLocalViewHost(Tpetra::Access::ReadOnly),
             b = correction->getLocalViewHost(Tpetra::Access::ReadOnly),
             sum = state.displacement->getLocalViewHost(Tpetra::Access::ReadOnly),
             rest = state.rest->getLocalViewHost(Tpetra::Access::ReadOnly);
  bool any = false;
  for (std::size_t i = 0; i < a.extent(0); ++i) {
    const double of_b = sum(i, 0) - a(i, 0); // exact, since |b| is small
    EXPECT_EQ(b(i, 0) - of_b, rest(i, 0));
    any = any || rest(i, 0) != 0;
  }
  EXPECT_TRUE(any || a.extent(0) == 0);
}

TEST(OptimalityResiduals, RoundingMakesForcesInProportionToTheDisplacement)
{
  const Judged scene;
  const auto u = scene.displacement(0.05, 0.4), large = scene.displacement(0.05, 0.4);
  large->scale(1e3);
  const auto made = [&](const Vector &by) {
    return contact::residual_of_rounding(scene.d, scene.material, scene.elastic.dirichlet, by, 1);
  };
  EXPECT_GT(made(*u), 0);
  EXPECT_NEAR(made(*large), 1e3 * made(*u), 1e-10 * made(*large));
  EXPECT_LT(made(*u), 1e-14 * fem::internal_work(scene.d, scene.material, *u).force_norm * 100);
}

TEST(OptimalityResiduals, EnergiesThatAreRoundingAreNotComparedWithEachOther)
{
  const Judged block;
  const auto u = block.vector(0.1, 0.4);
  fem::ElasticProblem loaded = block.elastic;
  const double rounding = fem::rounding_energy(block.d, block.material, *u);
  const auto left = [&](const double share, const double along) { // of the energy's residuals
    OptimalityResiduals r{0.1, 0.1, 0.1, 0.1, {}};
    r.energy_at_work = share * rounding;
    loaded.applied_load = plus(*u, along - 1, *u);
    contact::forgive_energies_of_rounding(block.d, block.material, loaded, block.iterate->points(),
                                          judged_at(*block.iterate, *u), 1e-8, 0, r);
    EXPECT_EQ(std::min(r.kkt_residual, r.equilibrium_residual), 0.1);
    return r.energy_balance + r.duality_gap;
  };
  EXPECT_EQ(left(0.5, 0), 0);
  EXPECT_EQ(left(2, 0), 0.2);
  EXPECT_EQ(left(0.5, 1), 0);
  EXPECT_EQ(left(0.5, -1), 0.2); // moved against the load, J is above that of the start (5.5c)
  const OptimalityResiduals judged = block.residuals(*u);
  EXPECT_GE(judged.energy_at_work, judged.internal.energy_norm_squared);
  const OptimalityResiduals shares = block.residuals(*u, 1e6 * judged.energy_at_work); // (5.5b)
  EXPECT_NEAR(shares.energy_balance, 1e-6 * judged.energy_balance, 1e-15 * judged.energy_balance);
  EXPECT_GT(shares.duality_gap, 0);
  EXPECT_LE(shares.duality_gap, 1e-6 * judged.duality_gap);
  EXPECT_EQ(shares.equilibrium_residual, judged.equilibrium_residual);
}

} // namespace
} // namespace optimality_residuals_test
