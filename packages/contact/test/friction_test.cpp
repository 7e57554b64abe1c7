// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/law/friction.hpp"

#include "rpc/contact/law/response.hpp"
#include "rpc/contact/law/states.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace friction_test
{
namespace
{

using namespace rpc::contact;

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double r = 40, weight = 0.25;

/// A slanted normal of length 1.
struct Normal {
  double operator()(const int k) const { return std::array<double, 3>{0.48, -0.6, 0.64}[k]; }
};
/// That of contact: the second component of the displacement is prescribed.
struct Direction {
  double operator()(const int k) const { return k == 1 ? 0 : Normal{}(k); }
};
struct Free {
  bool operator()(const int k) const { return k != 1; }
};

/// u less its part along the normal.
Along along_side(const Along &u)
{
  double normal = 0;
  for (int k = 0; k < 3; ++k) normal += Normal{}(k)*u(k);
  return u.plus(-normal, {{Normal{}(0), Normal{}(1), Normal{}(2)}});
}

/// Where a displacement leads to.
Motion at(const Along &u)
{
  double v = -0.01;
  for (int k = 0; k < 3; ++k) v += Normal{}(k)*u(k);
  return {v, along_side(u)};
}

TEST(Friction, BoundFollowsThePressureUpToItsLimit)
{
  const Friction coulomb{0.3, 0, inf}, tresca{0, 2, inf}, both{0.5, 1, 3};
  EXPECT_EQ(friction_bound(10, coulomb), 3);
  EXPECT_EQ(friction_bound(0, coulomb), 0);
  EXPECT_EQ(friction_bound(10, tresca), 2);
  EXPECT_EQ(friction_bound(2, both), 2);
  EXPECT_EQ(friction_bound(10, both), 3);
  EXPECT_EQ(friction_slope(2, both), 0.5);
  EXPECT_EQ(friction_slope(10, both), 0);
}

TEST(Friction, NearestTractionIsTheTrialOrTheBoundAlongIt)
{
  const Along a{{3, 0, 4}};
  EXPECT_EQ(admissible_friction(a, 6)(2), 4);
  EXPECT_NEAR(admissible_friction(a, 2)(0), 1.2, 1e-15);
  EXPECT_NEAR(admissible_friction(a, 2)(2), 1.6, 1e-15);
  EXPECT_EQ(admissible_friction(a, 0).length(), 0);
  EXPECT_EQ(slip_state(a, 5), Slip::stick);
  EXPECT_EQ(slip_state(a, 4.9), Slip::slip);
}

TEST(Friction, LawHoldsWhereResidualAndGapAre0)
{
  const double s = 2;
  const Along along{{0.6, 0, 0.8}};
  EXPECT_LT(friction_residual(along.scaled(0.1), along.scaled(s), s, 7), 1e-15);
  EXPECT_LT(friction_gap(along.scaled(0.1), along.scaled(s), s), 1e-16);
  EXPECT_EQ(friction_residual({}, along, s, 7), 0);
  EXPECT_NEAR(friction_residual(along.scaled(0.1), along, s, 7), 0.7, 1e-15);            // slips below the bound
  EXPECT_NEAR(friction_residual(along.scaled(-0.1), along.scaled(s), s, 7), 0.7, 1e-15); // against the traction
  EXPECT_NEAR(friction_gap(along.scaled(-0.1), along.scaled(s), s), 0.4, 1e-15);
  EXPECT_NEAR(friction_residual({}, along.scaled(3), s, 7), 1, 1e-15); // above the bound
}

/// Error of central differences of the step h.
struct Errors {
  double force = 0, block = 0;
};
template <class Respond>
Errors errors_of_differences(const Respond &respond, const Along &u, const double h)
{
  Errors errors;
  const Response here = respond(u);
  for (int l = 0; l < 3; ++l) {
    if (!Free{}(l)) continue;
    Along step;
    step.x[l] = h;
    const Response up = respond(u.plus(1, step)), down = respond(u.plus(-1, step));
    errors.force = std::max(errors.force, std::abs((up.energy - down.energy) / (2 * h) - here.force[l]));
    for (int k = 0; k < 3; ++k)
      errors.block = std::max(
          errors.block, std::abs((up.force[k] - down.force[k]) / (2 * h) - here.block[k][l] - here.coupling[k][l]));
  }
  return errors;
}

const Multiplier lambda{1.5, along_side({{0.3, 0.1, -0.2}})};

/// Friction alone with a given bound.
Response of_bound(const Along &u, const double s)
{
  Response response;
  add_friction(at(u), lambda, r, s, Normal{}, Free{}, weight, 3, response);
  return response;
}

TEST(Friction, SmoothedForceAndBlockAreDerivativesOfSecondOrder)
{
  for (const double s : {0.5, 1e3}) {
    const auto respond = [s](const Along &u) { return of_bound(u, s); };
    const Along u{{0.05, 0, -0.08}};
    const Errors coarse = errors_of_differences(respond, u, 4e-3), fine = errors_of_differences(respond, u, 2e-3);
    if (s > 1) { // sticks: quadratic, differences are exact
      EXPECT_LT(coarse.force, 1e-13);
      EXPECT_LT(coarse.block, 1e-11);
    } else {
      EXPECT_NEAR(std::log2(coarse.force / fine.force), 2, 0.1);
      EXPECT_NEAR(std::log2(coarse.block / fine.block), 2, 0.1);
    }
    EXPECT_EQ(of_bound(u, s).force[1], 0); // where the displacement is prescribed
  }
}

TEST(Friction, EnergyIsConvexAndHasNoJumpWhereSlipBegins)
{
  const double s = 0.5;
  const auto energy = [s](const double t) { return of_bound(Along{{t, 0, -0.3 * t}}, s).energy; };
  for (double t = -0.1; t < 0.1; t += 1e-3) EXPECT_GE(energy(t - 1e-3) - 2 * energy(t) + energy(t + 1e-3), -1e-15) << t;
  EXPECT_NEAR(of_bound({}, s).energy, 0, 1e-17); // Theta(0) = 0
}

/// Contact and friction on branches.
Response on_branch(const Along &u, const State state, const SlipBranch &branch, const Foundation &f, const Friction &g)
{
  Response response = respond_on_branch(state, at(u), lambda, r, f, Direction{}, weight, 3);
  add_friction_on_branch(state, branch, at(u), lambda, r, f, g, Direction{}, Normal{}, Free{}, weight, 3, response);
  return response;
}

/// lambda_tau + r e at a displacement: a.
Along trial(const Along &u)
{
  return lambda.tangential.plus(r, at(u).slip);
}

TEST(Friction, CoupledBlockIsTheDerivativeOnEachBranch)
{
  const Foundation rigid{inf}, plastic{3}, hardening{3, 9, 1. / 80};
  const Friction coulomb{0.4, 0.1, inf}, limited{0.4, 0.1, 0.2};
  const Along u{{0.05, 0, -0.08}};
  for (const Foundation &f : {rigid, plastic, hardening})
    for (const Friction &g : {coulomb, limited})
      for (const State state : {State::closed, State::yielding}) {
        if (state == State::yielding && f.yield == inf) continue;
        for (const Slip slip : {Slip::stick, Slip::slip}) {
          const auto respond = [&](const Along &x) { return on_branch(x, state, {slip, trial(x).unit()}, f, g); };
          const double coarse = errors_of_differences(respond, u, 2e-3).block,
                       fine = errors_of_differences(respond, u, 1e-3).block;
          if (slip == Slip::stick)
            EXPECT_LT(coarse, 1e-11);
          else
            EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2) << f.yield << ' ' << g.limit;
        }
      }
}

TEST(Friction, TractionOfAClosedPointThatSlipsFollowsThePressureAlone)
{
  const Along u{{0.05, 0, -0.08}};
  const SlipBranch slips{Slip::slip, trial(u).unit()};
  const Response closed = on_branch(u, State::closed, slips, {inf}, {0.4, 0, inf});
  const Response yields = on_branch(u, State::yielding, slips, {3}, {0.4, 0, inf});
  double closed_coupling = 0, yielding_coupling = 0;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) {
      closed_coupling = std::max(closed_coupling, std::abs(closed.coupling[k][l]));
      yielding_coupling = std::max(yielding_coupling, std::abs(yields.coupling[k][l]));
      EXPECT_NEAR(closed.block[k][l], closed.block[l][k], 1e-14);
    }
  EXPECT_GT(closed_coupling, 0.1 * weight * r * 0.4);
  EXPECT_EQ(yielding_coupling, 0); // s = mu xi there
}

/// The stiffness that friction adds where a yielding point slips: the block without and with the coupling.
std::array<std::array<double, 3>, 3> stiffness_of_slip(const Along &u, const Along &g, const bool with_coupling)
{
  const Response response = on_branch(u, State::yielding, {Slip::slip, g}, {3}, {0.4, 0, inf});
  std::array<std::array<double, 3>, 3> sum;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) sum[k][l] = response.block[k][l] + (with_coupling ? response.coupling[k][l] : 0);
  return sum;
}

TEST(Friction, DirectionOfSlipObeysTheLinearizedLaw) // (12.13): K (now - u) = s (turned - h), as the solver sees them
{
  const Along u{{0.05, 0, -0.08}}, to{{0.02, 0, 0.01}}, g = along_side({{0.3, 0, 0.6}}), h = trial(u).unit();
  const double s = 0.4 * 3;
  const auto stiffness = stiffness_of_slip(u, g, true);
  const double longer = h.dot(trial(to).plus(-1, trial(u)));
  const Along unbounded = trial(to).plus(-longer, g).scaled(1 / trial(u).length());
  for (int k = 0; k < 3; ++k) {
    if (!Free{}(k)) continue;
    double change = 0;
    for (int l = 0; l < 3; ++l) change += stiffness[k][l] * (to(l) - u(l));
    EXPECT_NEAR(change, weight * s * (unbounded(k) - h(k)), 1e-12) << k;
  }
  ASSERT_LT(unbounded.length(), 1);
  EXPECT_LT(turned_direction(g, trial(u), trial(to)).plus(-1, unbounded).length(), 1e-15);
  EXPECT_NEAR(turned_direction(g, trial(u), trial(to.scaled(100))).length(), 1, 1e-15); // no longer than that
  const Along near = u.plus(1e-3, to);
  const double
      first = turned_direction(h, trial(u), trial(near)).plus(-1, trial(near).unit()).length(),
      half = turned_direction(h, trial(u), trial(u.plus(5e-4, to))).plus(-1, trial(u.plus(5e-4, to)).unit()).length();
  EXPECT_NEAR(std::log2(first / half), 2, 0.1); // from g = h on it is Newton's
}

TEST(Friction, PointThatCannotStickHasAnExactBlockBelowItsBound) // (12.13): r|e| = 0.4 < s = 1.2 here
{
  const Along u{{0.005, 0, -0.008}};
  const auto respond = [](const Along &x) {
    return on_branch(x, State::yielding, {Slip::slip, at(x).slip.unit(), true}, {3}, {0.4, 0, inf});
  };
  const Along e = at(u).slip;
  ASSERT_LT(r * e.length(), 1.2);
  const Response friction = respond(u),
                 contact = respond_on_branch(State::yielding, at(u), lambda, r, Foundation{3}, Direction{}, weight, 3);
  for (const int k : {0, 2}) // along the slip, whatever the multiplier is
    EXPECT_NEAR(friction.force[k] - contact.force[k], weight * 1.2 * e.unit()(k), 1e-15);
  const double coarse = errors_of_differences(respond, u, 2e-4).block,
               fine = errors_of_differences(respond, u, 1e-4).block;
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2);
}

TEST(Friction, SymmetricPartOfTheLaggingDirectionIsNotNegative)
{
  const Along u{{0.05, 0, -0.08}}, h = trial(u).unit();
  for (const double length : {0., 0.5, 1.})
    for (double angle = 0; angle < 6.3; angle += 0.3) {
      const Along g = along_side({{std::cos(angle), 0, std::sin(angle)}}).unit().scaled(length);
      const auto block = stiffness_of_slip(u, g, false);
      const double trace = block[0][0] + block[2][2],
                   determinant = block[0][0] * block[2][2] - block[0][2] * block[2][0];
      EXPECT_EQ(block[0][2], block[2][0]);
      EXPECT_GE(trace, 0) << length << ' ' << angle;
      EXPECT_GE(determinant, -1e-12 * trace * trace) << length << ' ' << angle;
    }
  EXPECT_EQ(turned_direction(h, {}, trial(u)).plus(-1, h).length(), 0);
}

TEST(Friction, PrescribedSlipIsWhatNoFreeMoveAlongTheSideChanges)
{
  const auto prescribed = [](const Along &e) { return prescribed_slip(e, Normal{}, Free{}, 3); };
  const Along e = along_side({{0.3, 0.2, -0.5}});
  const Along move = Along{{0.64, 0, -0.48}}.unit(); // of the free unknowns, along the side
  ASSERT_GT(prescribed(e).length(), 0.01);
  EXPECT_NEAR(prescribed(e).dot(move), 0, 1e-16);
  EXPECT_NEAR(prescribed(e.plus(0.7, move)).plus(-1, prescribed(e)).length(), 0, 1e-16);
  EXPECT_NEAR(prescribed(e).plus(e.dot(move), move).plus(-1, e).length(), 0, 1e-16);
  const auto all = [](const int) { return true; };
  EXPECT_EQ(prescribed_slip(e, Normal{}, all, 3).length(), 0);
}

/// (12.8a)
TEST(Friction, APointOnSpringsSticksByTheLeverOfItsNormal)
{
  const Foundation springs{inf, 0, 0.05};
  const auto of = [](const State next, const Foundation &f) { return lever(next, f, Normal{}, Free{}, 3); };
  const Along by = of(State::closed, springs), move = Along{{0.64, 0, -0.48}}.unit();
  const Along normal{{Normal{}(0), Normal{}(1), Normal{}(2)}};
  EXPECT_NEAR(by.length(), std::abs(normal(1)), 1e-15);
  EXPECT_NEAR(by.dot(normal), 0, 1e-15);
  EXPECT_NEAR(by.dot(move), 0, 1e-15);
  EXPECT_GT(of(State::yielding, Foundation{3}).length(), 0);
  EXPECT_EQ(of(State::closed, Foundation{inf}).length(), 0); // which holds its normal
  EXPECT_EQ(of(State::open, springs).length(), 0);
  EXPECT_EQ(lever(
                State::closed, springs, Normal{}, [](const int) { return true; }, 3)
                .length(),
            0);

  const SlipBranch sticks{Slip::stick, {}, false, by};
  const Along u{{0.05, 0, -0.08}}, up = Along{{normal(0), 0, normal(2)}}.unit(); // what is free of the normal
  const Friction coulomb{0.4, 0, inf};
  EXPECT_LT(errors_of_differences([&](const Along &x) { return on_branch(x, State::closed, sticks, springs, coulomb); },
                                  u, 1e-3)
                .block,
            1e-10);
  const Response all = on_branch(u, State::closed, sticks, springs, coulomb),
                 contact = respond_on_branch(State::closed, at(u), lambda, r, springs, Direction{}, weight, 3);
  double stiffness = 0;
  for (const int k : {0, 2})
    for (const int l : {0, 2}) stiffness += up(k) * (all.block[k][l] - contact.block[k][l]) * up(l);
  EXPECT_NEAR(stiffness, weight * r, 1e-12 * weight * r);
  EXPECT_GT(trial_traction(sticks, {}, r, by).length(), r * by.length());
  EXPECT_NEAR(trial_traction(sticks, {}, r, move).plus(-r, move).length(), 0,
              1e-12 * r); // without a part along the lever
}

TEST(Friction, StatesChangeByTheNeighbourRule)
{
  const Friction coulomb{0.5, 0, inf}, tresca{0, 1, inf};
  const Along x{{1, 0, 0}};
  const SlipBranch sticks{}, slips{Slip::slip, x};
  const auto next = [](const SlipBranch &now, const State before, const State then, const Along &e, const Along &q,
                       const double p, const Friction &f) {
    return next_slip(now, now.direction, before, then, e, q, 1e-3, p, 100, 1e-9, f);
  };
  using S = State;
  EXPECT_EQ(next(sticks, S::closed, S::closed, {}, x.scaled(0.9), 2, coulomb).state, Slip::stick);
  const SlipBranch begins = next(sticks, S::closed, S::closed, {}, x.scaled(-1.1), 2, coulomb);
  EXPECT_EQ(begins.state, Slip::slip);
  EXPECT_EQ(begins.direction(0), -1);
  EXPECT_EQ(next(slips, S::closed, S::closed, x.scaled(0.1), x, 2, coulomb).state, Slip::slip);
  EXPECT_EQ(next(slips, S::closed, S::closed, x.scaled(-0.1), x, 2, coulomb).state, Slip::stick);
  EXPECT_EQ(next(sticks, S::closed, S::open, x, x, 0, coulomb).state, Slip::slip); // nothing holds it
  EXPECT_EQ(next(sticks, S::closed, S::open, {}, x.scaled(0.9), 0, tresca).state, Slip::stick);
  EXPECT_EQ(next(slips, S::open, S::closed, x.scaled(1e-4), {}, 0, coulomb).state, Slip::stick); // 0.01 < 0.05
  EXPECT_EQ(next(slips, S::open, S::closed, x.scaled(1e-3), {}, 0, coulomb).state, Slip::slip);  // 0.1 > 0.05
}

} // namespace
} // namespace friction_test
