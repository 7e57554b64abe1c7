// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/law/response.hpp"

#include "rpc/contact/law/interpolated.hpp"
#include "rpc/contact/law/judgement.hpp"
#include "rpc/contact/law/lent.hpp"
#include "rpc/contact/law/states.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace response_test
{
namespace
{

using namespace rpc::contact;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double r = 40, lambda = 1.5, weight = 0.25;
const std::vector<Foundation> laws = {{3, 0, 0}, {inf, 0, 0}, {3, 9, 0}, {3, 0, 1. / 80}, {3, 9, 1. / 80}};

/// A slanted direction, not of unit length: one of its components is prescribed.
struct Direction {
  double operator()(const int k) const { return std::array<double, 3>{0.36, -0.8, 0.3}[k]; }
};
Response at(const double v, const Foundation &f)
{
  return respond(Motion{v}, Multiplier{lambda}, r, f, Direction{}, weight, 3);
}

TEST(Response, IsPressureAndStiffnessAlongTheDirection)
{
  // lambda + r v = 2.3, closed; 3 where it yields
  const Foundation plastic{3, 0, 0};
  const Response closed = at(0.02, plastic), open = at(-0.1, plastic), yields = at(0.1, plastic);
  EXPECT_EQ(closed.state, State::closed);
  EXPECT_EQ(open.state, State::open);
  EXPECT_EQ(yields.state, State::yielding);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(closed.force[k], 0.25 * 2.3 * Direction{}(k), 1e-15);
    EXPECT_EQ(open.force[k], 0);
    EXPECT_NEAR(yields.force[k], 0.25 * 3 * Direction{}(k), 1e-15);
    for (int l = 0; l < 3; ++l) {
      EXPECT_NEAR(closed.block[k][l], 0.25 * 40 * Direction{}(k)*Direction{}(l), 1e-14);
      EXPECT_EQ(open.block[k][l], 0);
      EXPECT_EQ(yields.block[k][l], 0);
    }
  }
  EXPECT_NEAR(closed.energy, 0.25 * 0.02 * (1.5 + 0.5 * 40 * 0.02), 1e-16);
}

/// Largest error of a central difference with the step h, over moves u -> u + h e_l with v = m . u.
struct Errors {
  double force = 0, block = 0;
};
Errors errors_of_differences(const double v, const Foundation &f, const double h)
{
  Errors errors;
  const Response here = at(v, f);
  for (int l = 0; l < 3; ++l) {
    const double dv = h * Direction{}(l);
    const Response up = at(v + dv, f), down = at(v - dv, f);
    errors.force = std::max(errors.force, std::abs((up.energy - down.energy) / (2 * h) - here.force[l]));
    for (int k = 0; k < 3; ++k)
      errors.block = std::max(errors.block, std::abs((up.force[k] - down.force[k]) / (2 * h) - here.block[k][l]));
  }
  return errors;
}

TEST(Response, ForceIsTheDerivativeOfTheEnergyAndTheBlockThatOfTheForceInEachState)
{
  // Both are polynomials of degree 2 and 1 on a branch: central differences are exact, but for rounding, away from kinks.
  for (const Foundation &f : laws)
    for (const double v : {-0.2, 0.01, 0.5}) {
      const Errors errors = errors_of_differences(v, f, 1e-3);
      EXPECT_LT(errors.force, 1e-11) << v << ' ' << f.hardening;
      EXPECT_LT(errors.block, 1e-9) << v << ' ' << f.hardening;
    }
}

TEST(Response, OnABranchLeavesTheLawsRangeAndKeepsItsState)
{
  for (const Foundation &f : laws) {
    const Response pulled =
        respond_on_branch(State::closed, Motion{-0.2}, Multiplier{lambda}, r, f, Direction{}, weight, 2);
    EXPECT_EQ(pulled.state, State::closed);
    EXPECT_GT(pulled.force[1], 0) << "against the direction: a pull, which the law does not admit";
    EXPECT_EQ(pulled.force[2], 0) << "in the plane";
    const Response law = at(-0.2, f);
    EXPECT_EQ(law.state, State::open);
  }
}

TEST(States, MultipliersAndPlacesFollowTheState)
{
  const Foundation f{3, 9, 1. / 80};
  EXPECT_EQ(multiplier_of(State::open, 2, f), 0);
  EXPECT_EQ(multiplier_of(State::closed, -1, f), 0);
  EXPECT_EQ(multiplier_of(State::closed, 5, f), 3);
  EXPECT_EQ(multiplier_of(State::yielding, 2, f), 3);
  EXPECT_EQ(multiplier_of(State::yielding, 5, f), 5) << "hardening";
  EXPECT_EQ(multiplier_of(State::yielding, 5, {3, 0, 0}), 3);
  EXPECT_EQ(resting_penetration(2, f), 2. / 80);
  EXPECT_EQ(penalty_stretch(State::open, 1, lambda, r, f), 0);
  EXPECT_EQ(penalty_stretch(State::closed, 0.1, lambda, r, {3, 0, 0}), 0.1);
  EXPECT_NEAR(penalty_stretch(State::closed, 0.1, lambda, r, f), (0.1 - lambda / 80) / 1.5, 1e-16);
}

TEST(States, ChangeByWayOfClosedOnly)
{
  const Foundation f{3, 0, 0};
  constexpr double own = 10;
  EXPECT_EQ(next_state(State::closed, 0, -0.1, own, 0.01, f), State::open);
  EXPECT_EQ(next_state(State::closed, 0, 3.1, own, 0.01, f), State::yielding);
  EXPECT_EQ(next_state(State::closed, 0, 3.005, own, 0.01, f), State::closed);
  EXPECT_EQ(next_state(State::open, 1e3, 0, own, 0.01, f), State::closed);
  EXPECT_EQ(next_state(State::open, 0.0005, 0, own, 0.01, f), State::open);
  EXPECT_EQ(next_state(State::yielding, -1e3, 3, own, 0.01, f), State::closed);
  EXPECT_EQ(next_state(State::yielding, 0.1, 3, own, 0.01, f), State::yielding);
  EXPECT_EQ(next_state(State::yielding, 0.02, 3, own, 0.01, {3, 0, 1. / 80}), State::closed) << "v < c p";
}

TEST(Judgement, IsZeroWhereTheLawHoldsAndTellsHowFarItIsMissed)
{
  constexpr double scaling = 7;
  for (const Foundation &f : laws)
    for (const double v : {-0.3, -1e-3, 0.01, 0.4}) {
      if (v > 0 && !gives_way(f)) continue;
      const double p = pressure_at(v, f);
      EXPECT_NEAR(law_residual(v, p, scaling, f), 0, 1e-14);
      EXPECT_NEAR(duality_gap(v, p, 1e3, f), 0, 1e-14);
      EXPECT_GT(std::abs(law_residual(v, p + 0.5, scaling, f)), 1e-3);
      EXPECT_GT(duality_gap(v, p + 0.5, 1e3, f) + (f.hardening == 0 && v > 0 ? 1 : 0), 1e-4);
      EXPECT_NEAR(taken_up(v, p, f) + stored_energy(p, f), foundation_energy(v, f), 1e-14);
      EXPECT_NEAR(new_dent(v, p, f), p >= f.yield ? v - f.compliance * p : 0, 1e-15);
    }
}

TEST(Judgement, AnswersWhatALawCanBear)
{
  EXPECT_EQ(largest_bearable({3, 0, 0}), 3);
  EXPECT_EQ(largest_bearable({3, 9, 0}), inf);
  EXPECT_EQ(largest_bearable({inf, 0, 0}), inf);
  EXPECT_TRUE(gives_way({3, 0, 0}));
  EXPECT_FALSE(gives_way({inf, 0, 0}));
  EXPECT_TRUE(gives_way({inf, 0, 0.1}));
  EXPECT_EQ(state_of_pressure(0, {3, 0, 0}), State::open);
  EXPECT_EQ(state_of_pressure(1, {3, 0, 0}), State::closed);
  EXPECT_EQ(state_of_pressure(3, {3, 0, 0}), State::yielding);
}

TEST(Lent, DentsAreMadeAtTheYieldLimitAndBoundThePressure)
{
  const Foundation f{3, 9, 0};
  EXPECT_EQ(lent(2, 0.1, f).pressure, 2);
  EXPECT_EQ(lent(2, 0.1, f).dent, 0);
  EXPECT_EQ(lent(4, 0.2, f).pressure, 4);
  EXPECT_EQ(lent(4, 0.2, f).dent, 0.2);
  EXPECT_NEAR(lent(9, 0.2, f).pressure, 4.8, 1e-15);
  EXPECT_EQ(lent(9, -0.2, f).pressure, 3);
  EXPECT_EQ(lent(9, -0.2, f).dent, 0);
}

TEST(Interpolated, LawComesBackFromItsColumnsAndInterpolantsBelowZeroAreNone)
{
  std::array<double, law_columns> column{};
  to_columns({inf, 9, 0.1}, 50, [&](const int k) -> double & { return column[k]; });
  const Foundation f = from_columns(column.data());
  EXPECT_EQ(yield_limit(f), 50);
  EXPECT_EQ(f.hardening, 9);
  EXPECT_EQ(f.compliance, 0.1);
  const double below[law_columns] = {-1, -1, -1};
  EXPECT_EQ(from_columns(below).hardening, 0);
  EXPECT_EQ(yield_limit(from_columns(below)), 0);
}

} // namespace
} // namespace response_test
