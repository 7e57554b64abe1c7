// SPDX-License-Identifier: BSD-3-Clause
#include "cycles.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Error bars from the meshes of a run. doc/theory.md (10.7), (10.8)

namespace cycle_test
{
namespace
{

using namespace rpc;
using adapt::Cycle;
using adapt::observed_errors;
using test::mesh;
using test::open_mesh;

TEST(ErrorBars, OfOneMeshAreNone)
{
  const auto errors = observed_errors({mesh(0.1, 10, 30)});
  EXPECT_TRUE(std::isnan(errors.contact_force));
  EXPECT_EQ(errors.unknown.size(), adapt::error_bars.size());
}

TEST(ErrorBars, AreNoLessThanWhatTheLastMeshLeavesOpen)
{
  // Meshes that agree by chance.
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  auto errors = observed_errors(cycles);
  EXPECT_NEAR(errors.energy, 2 * 0.02 * 0.02 * 2 / 2, 1e-15);
  EXPECT_NEAR(errors.contact_force, 2 * 0.02 * 0.02 * 10, 1e-15);
  EXPECT_EQ(errors.max_pressure, 0); // nothing but its change and the recovered stress tells of it
  cycles.back().ends_force = 0.04;   // of the ends of contact
  errors = observed_errors(cycles);
  EXPECT_NEAR(errors.contact_force, 0.04, 1e-15);
  cycles.back().ends_force = 0.001;
  // Data that jump: 0.3 N at a load that has moved by 2 J / 10 N, and an edge that may release 0.01 J.
  cycles.back().jumped_force = 0.3;
  errors = observed_errors(cycles);
  EXPECT_NEAR(errors.contact_force, 2 * 0.02 * 0.02 * 10 + 0.3, 1e-15);
  EXPECT_NEAR(errors.energy, 0.02 * 0.02 * 2 + 0.3 * 0.2, 1e-15);
  cycles.back().jumped_force = 0;
  cycles.back().jumped_energy = 0.01;
  errors = observed_errors(cycles);
  EXPECT_NEAR(errors.contact_force, 2 * 0.02 * 0.02 * 10 + 2 * 0.01 / 0.2, 1e-15);
  EXPECT_NEAR(errors.energy, 0.02 * 0.02 * 2 + 0.01, 1e-15);
}

TEST(ErrorBars, CountWhatReadingTheGapAtNodesLeavesOpen)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  for (Cycle &cycle : cycles) cycle.contact.max_penetration = cycle.contact.max_dent = 0.1;
  const auto before = observed_errors(cycles);
  cycles.back().misread_force = 0.03;
  cycles.back().misread_energy = 0.01; // of which the load, moved by 2 J / 10 N, makes 0.1 N
  cycles.back().misread_penetration = 0.15;
  auto errors = observed_errors(cycles);
  EXPECT_NEAR(errors.contact_force, before.contact_force + 0.03, 1e-15);
  cycles.back().misread_force = 0.3;
  errors = observed_errors(cycles);
  EXPECT_NEAR(errors.contact_force, before.contact_force + 0.1, 1e-15);
  EXPECT_NEAR(errors.energy, before.energy + 0.01, 1e-15);
  EXPECT_NEAR(before.max_penetration, 0.02 * 0.1, 1e-15);
  EXPECT_NEAR(errors.max_penetration, 0.05, 1e-15); // samples between the nodes lie so much deeper
}

TEST(ErrorBars, OfThePenetrationOfAFoundationThatDoesNotGiveWayAreRounding)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  cycles.back().contact.max_penetration = 1e-17;
  cycles.back().misread_penetration = 0.15; // the side lies there between the nodes
  EXPECT_EQ(observed_errors(cycles).max_penetration, 1e-17);
}

TEST(ErrorBars, CountTheInterpolantOfASmoothGap)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  const auto before = observed_errors(cycles);
  cycles.back().interpolated = 0.01; // of which the load, moved by 2 J / 10 N, makes 0.1 N
  const auto errors = observed_errors(cycles);
  EXPECT_NEAR(errors.energy, before.energy + 0.01, 1e-15);
  EXPECT_NEAR(errors.contact_force, before.contact_force + 0.1, 1e-15);
}

TEST(ErrorBars, CountWhatFacetsLeaveOfAKinkThatTheFoundationRounds)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  for (Cycle &cycle : cycles) cycle.contact.max_penetration = cycle.contact.max_dent = 0.1;
  cycles.back().peak.rounded = 2;
  cycles.back().peak.rounded_depth = 0.03;
  const auto errors = observed_errors(cycles);
  EXPECT_EQ(errors.max_pressure, 2);
  EXPECT_EQ(errors.max_penetration, 0.03);
}

TEST(ErrorBars, OfForcesThatDoLittleOfTheWorkGoByHowFarTheBodyMoves)
{
  // 2 J of strain energy, of which 10 N over at most 0.01 m can have done little: others cancel in their sum.
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  for (Cycle &cycle : cycles) cycle.max_displacement = 0.01;
  EXPECT_NEAR(observed_errors(cycles).contact_force, 2 * 0.02 * 0.02 * 2 / 0.01, 1e-12);
}

TEST(ErrorBars, OfAMeshThatMissesContactAreNone)
{
  std::vector<Cycle> cycles = {mesh(0.9, 1, 3), mesh(0.8, 1, 3)};
  cycles.back().misses_contact = true;
  const auto errors = observed_errors(cycles);
  for (const auto &q : adapt::error_bars) {
    EXPECT_TRUE(std::isnan(errors.*q.value)) << q.key;
    EXPECT_EQ(errors.unknown.at(q.key), adapt::unseen_by_mesh);
  }
}

TEST(ErrorBars, OfAContactForceThatTheLoadFixesAreWhatItChanges)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10 + 1e-9, 30)};
  const adapt::FixedByLoad free = {true, true, true}, held_across = {false, true, true}, held = {true, false, true};
  constexpr double tolerance = 1e-8;
  EXPECT_EQ(observed_errors(cycles, free, tolerance).contact_force, 0);
  EXPECT_EQ(observed_errors(cycles, held_across, tolerance).contact_force, 0); // no force that way
  EXPECT_NEAR(observed_errors(cycles, held, tolerance).contact_force, 2 * 0.02 * 0.02 * 10, 1e-8);
  cycles[1].contact.force[1] = 10.4; // of a load on a curved side, which the meshes take as longer and longer
  EXPECT_NEAR(observed_errors(cycles, free, tolerance).contact_force, 0.4 / (0.1 / 0.02 - 1), 1e-12);
  cycles[0].contact.force[0] = 1;
  EXPECT_GT(observed_errors(cycles, held_across, tolerance).contact_force, 1. / 4);
  const std::vector<Cycle> open = {mesh(0.1, 0, 0), mesh(0.02, 0, 0)};
  EXPECT_EQ(observed_errors(open, free, tolerance).contact_force, 0);
}

TEST(ErrorBars, OfAComponentOfTheContactForceIsWhatTheLoadOrASpringLeaves)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10 + 1e-9, 30)};
  cycles[0].contact.force[0] = 1.2;
  cycles[1].contact.force[0] = 1;
  constexpr double tolerance = 1e-8, spring = 3;
  const adapt::FixedByLoad pressed = {{false, true, false}};
  auto errors = observed_errors(cycles, pressed, tolerance);
  using Bars = std::vector<double>;
  EXPECT_EQ(adapt::contact_force_bars(cycles, errors, pressed, tolerance),
            (Bars{errors.contact_force, 0, errors.contact_force}));
  cycles[0].contact.force[1] = 10.1; // the load on a curved side
  EXPECT_NEAR(adapt::contact_force_bars(cycles, errors, pressed, tolerance)[1],
              std::min(0.1 / (0.1 / 0.02 - 1), errors.contact_force), 1e-9);
  adapt::FixedByLoad on_spring = {{false, false, false}};
  on_spring.springs = {0, spring, 0};
  errors.motions.obstacle = 1e-3;
  EXPECT_EQ(adapt::contact_force_bars(cycles, errors, on_spring, tolerance),
            (Bars{errors.contact_force, spring * 1e-3, errors.contact_force}));
  errors.motions.obstacle = 1; // no more than that of the vector
  EXPECT_EQ(adapt::contact_force_bars(cycles, errors, on_spring, tolerance)[1], errors.contact_force);
  EXPECT_TRUE(adapt::contact_force_bars({cycles[1]}, errors, on_spring, tolerance).empty());
  errors.contact_force = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(adapt::contact_force_bars(cycles, errors, on_spring, tolerance).empty());
}

TEST(ErrorBars, OfReactionsAreThoseOfForces)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  cycles[0].reactions = {{3, -4, 0}, {0, 1, 0}};
  cycles[1].reactions = {{3, -4, 0}, {0.3, 1.4, 0}};
  auto errors = observed_errors(cycles);
  ASSERT_EQ(errors.reactions.size(), 2U);
  EXPECT_NEAR(errors.reactions[0], 2 * 0.02 * 0.02 * 10, 1e-15); // by the largest force at work, that of contact
  EXPECT_NEAR(errors.reactions[1], 0.5 / (0.1 / 0.02 - 1), 1e-12);
  cycles[1].jumped_force = cycles[0].jumped_force = 0.3;
  cycles[1].reactions[0] = cycles[0].reactions[0] = {0, 50, 0};
  cycles[1].reactions[1] = cycles[0].reactions[1] = {0, -60, 0};
  errors = observed_errors(cycles);
  EXPECT_NEAR(errors.reactions[0], 2 * 0.02 * 0.02 * 60 + 0.3, 1e-12);
  EXPECT_NEAR(errors.contact_force, 2 * 0.02 * 0.02 * 10 + 0.3,
              1e-12); // the reactions balance it: nothing else loads the body
}

/// 10 N along Y, which move a side, an obstacle and a rigid side with an arm of 0.5 m.
Cycle pressed(const double estimate, const double moved)
{
  Cycle c = mesh(estimate, 10, 30);
  c.reactions = {{0, -10, 0}};
  c.motions.displacements = {{0, moved, 0}};
  c.motions.rotations = {{0, 0, 0.01 * moved}};
  c.motions.moments = {{0, 0, 0}};
  c.motions.arms = {0.5};
  c.motions.obstacle = {0, moved, 0};
  c.motions.softness = {{0.5}, {3}, 0.01};
  return c;
}

TEST(ErrorBars, OfWhatForcesMoveAreThoseOfForcesTimesHowSoftItIs)
{
  const std::vector<Cycle> agree = {pressed(0.1, 1), pressed(0.02, 1)};
  const auto errors = observed_errors(agree).motions;
  const double force = 2 * 0.02 * 0.02 * 10;
  ASSERT_EQ(errors.displacements.size(), 1U);
  EXPECT_NEAR(errors.displacements[0], 0.5 * force, 1e-15);
  EXPECT_NEAR(errors.rotations[0], 3 * force, 1e-15);
  EXPECT_NEAR(errors.moments[0], 0.5 * force, 1e-15);
  EXPECT_NEAR(errors.obstacle, 2. / 100 * force, 1e-15); // stiffer than in the mean, a(u, u) / F^2
  const auto change = observed_errors({pressed(0.1, 1), pressed(0.02, 1.4)}).motions;
  EXPECT_NEAR(change.displacements[0], 0.4 / (0.1 / 0.02 - 1), 1e-12);
  EXPECT_NEAR(change.obstacle, 0.4 / (0.1 / 0.02 - 1), 1e-12);
  EXPECT_NEAR(change.rotations[0], 3 * force, 1e-15);
  auto unknown = agree; // no solve has shown how soft it is
  unknown.back().motions.softness = {{INFINITY}, {INFINITY}, INFINITY};
  const auto none = observed_errors(unknown).motions;
  EXPECT_FALSE(std::isfinite(none.displacements[0]) || std::isfinite(none.rotations[0]) ||
               std::isfinite(none.obstacle));
  EXPECT_NEAR(none.moments[0], 0.5 * force, 1e-15);
}

TEST(ErrorBars, OfAMomentDoNotDependOnTheOrderOfRigidSides)
{
  std::vector<Cycle> cycles = {pressed(0.1, 1), pressed(0.02, 1)};
  for (Cycle &c : cycles) { // the first side is turned, the second one pressed
    c.motions.moments = {{0, 0, 1000}, {0, 0, 0}};
    c.motions.arms = {0.5, 0.5};
    c.motions.rotations.push_back({});
    c.motions.softness.rotation = {3, 3};
  }
  const auto errors = observed_errors(cycles).motions;
  const double share = 2 * 0.02 * 0.02;
  EXPECT_NEAR(errors.moments[0], share * 1000, 1e-12);
  EXPECT_NEAR(errors.moments[1], share * 10 * 0.5, 1e-12);
  EXPECT_NEAR(errors.rotations[1], 3 * share * 1000 / 0.5, 1e-12); // by a force that has the moment at the arm
}

TEST(ErrorBars, OfForcesAndMomentsThatTheLoadFixesAreWhatMeshesShow)
{
  const adapt::FixedByLoad fixed = {{false, false, false}, {true}, {true}};
  const std::vector<Cycle> cycles = {pressed(0.1, 1), pressed(0.02, 1)};
  const auto errors = observed_errors(cycles, fixed, 1e-8);
  EXPECT_EQ(errors.reactions[0], 0);
  EXPECT_EQ(errors.motions.moments[0], 0);
  EXPECT_GT(errors.motions.displacements[0], 0);
  EXPECT_GT(errors.contact_force, 0);
}

TEST(ErrorBars, OfLoadStepsCountHowFarEarlierOnesHaveMoved)
{
  adapt::CoarserHistory coarser;
  coarser.last = pressed(0.2, 1.3);
  coarser.largest_estimate = 0.2 * std::sqrt(2.);
  adapt::EarlierSteps earlier;
  earlier.matter = true;
  earlier.largest_estimate = 0.02 * std::sqrt(2.);
  earlier.moved_by = 0.2;
  const std::vector<Cycle> cycles = {pressed(0.1, 1), pressed(0.02, 1)};
  const auto alone = observed_errors(cycles).motions, all = observed_errors(cycles, coarser, earlier).motions;
  EXPECT_NEAR(all.obstacle - alone.obstacle, 0.3 / 9, 1e-12);
  EXPECT_GT(all.displacements[0], alone.displacements[0]);
  EXPECT_GT(all.rotations[0], alone.rotations[0]);
}

TEST(ErrorBars, OfAContactForceThatIsASmallPartOfTheLoadAreThoseOfReactions)
{
  // A load of 200 N that the support bears but for 10 N; it moves by 0.01 m in the mean.
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  for (Cycle &cycle : cycles) cycle.reactions = {{0, 190, 0}};
  auto errors = observed_errors(cycles);
  EXPECT_NEAR(errors.contact_force, 2 * 0.02 * 0.02 * 200, 1e-12);
  cycles.back().misread_force = 0.3;
  cycles.back().misread_energy = 0.001; // of which the load makes 0.2 N
  EXPECT_NEAR(observed_errors(cycles).contact_force, errors.contact_force + 0.2, 1e-12);
}

TEST(ErrorBars, OfPressuresAndPenetrationsOnSpringsAreTheSameShare)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 34), mesh(0.02, 10, 30)};
  for (Cycle &cycle : cycles) {
    cycle.contact.max_penetration = 0.3;
    cycle.contact.foundation_energy = 1;
  }
  const double wide = 4 / (0.1 / 0.02 - 1);
  EXPECT_NEAR(observed_errors(cycles).max_penetration, wide / 100, 1e-12);
  cycles.back().misread_penetration = 0.4; // a tip between the nodes
  EXPECT_NEAR(observed_errors(cycles).max_pressure, 0.1 * 100, 1e-12);
  cycles.back().peak.friction_edge = true;
  auto errors = observed_errors(cycles);
  EXPECT_TRUE(std::isnan(errors.max_penetration));
  EXPECT_NE(errors.unknown.at("max_penetration").find("friction"), std::string::npos);
  cycles.back().contact.max_dent = 0.1; // penetrations are those of dents, too
  EXPECT_NEAR(observed_errors(cycles).max_penetration, 0.1, 1e-12);
}

TEST(ErrorBars, OfPenetrationsAreThoseOfDents)
{
  // The body has drawn back: what is left of the penetration is the difference of large numbers.
  std::vector<Cycle> cycles = {mesh(0.1, 0, 0), mesh(0.02, 0, 0)};
  for (Cycle &cycle : cycles) {
    cycle.contact.max_dent = 0.5;
    cycle.contact.max_penetration = 1e-3;
  }
  EXPECT_NEAR(observed_errors(cycles).max_penetration, 0.02 * 0.5, 1e-12);
}

TEST(ErrorBars, OfMeshesThatAreHardlyFinerAreWide)
{
  const auto errors = observed_errors({mesh(0.1, 10, 30), mesh(0.08, 10.01, 30.1)});
  EXPECT_NEAR(errors.max_pressure, 0.08 * 30.1, 1e-12);
}

TEST(ErrorBars, AreTheLastChangeWhereChangesDoNotFall)
{
  // The estimate falls by three twice, the changes grow: (10.7) alone would be half of the last one.
  const auto errors = observed_errors({mesh(0.18, 10, 30), mesh(0.06, 10.1, 30.5), mesh(0.02, 9.8, 30.4)});
  EXPECT_NEAR(errors.contact_force, 0.3, 1e-12);
}

TEST(ErrorBars, OfALargestPressureThatGrowsWithoutLimitAreNone)
{
  const auto growing = observed_errors({mesh(0.5, 10, 30), mesh(0.1, 10, 46), mesh(0.02, 10, 62)});
  EXPECT_TRUE(std::isnan(growing.max_pressure));
  EXPECT_NE(growing.unknown.at("max_pressure").find("does not settle"), std::string::npos);
  const auto settling = observed_errors({mesh(0.5, 10, 30), mesh(0.1, 10, 46), mesh(0.02, 10, 49)});
  EXPECT_NEAR(settling.max_pressure, std::max(3. / 4, 16. / 4 / 5), 1e-12);
  auto kinked = mesh(0.1, 10, 46);
  kinked.peak.kink = 0.1;
  EXPECT_TRUE(std::isnan(observed_errors({mesh(0.5, 10, 30), kinked}).max_pressure));
}

TEST(ErrorBars, OfNoPenetrationAreNoneWhereThePressureMayReachTheYieldStress)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  EXPECT_EQ(observed_errors(cycles).max_penetration, 0); // nothing can yield
  cycles.back().peak.lowest_bound = 31;
  EXPECT_EQ(observed_errors(cycles).max_penetration, 0);
  cycles.back().recovered_max_pressure = 2;
  const auto errors = observed_errors(cycles);
  EXPECT_TRUE(std::isnan(errors.max_penetration));
  EXPECT_NE(errors.unknown.at("max_penetration").find("yield stress"), std::string::npos);
  cycles.back().recovered_max_pressure = 0;
  cycles.back().peak.friction_edge = true; // the largest pressure has no bar
  EXPECT_TRUE(std::isnan(observed_errors(cycles).max_penetration));
  cycles.back().contact.max_dent = 0.1; // the foundation gives way
  EXPECT_FALSE(std::isnan(observed_errors(cycles).max_penetration));
}

TEST(ErrorBars, OfABodyThatDoesNotTouchAreZeroWhereItsGapIsKnownBetterThanThat)
{
  const std::vector<Cycle> open = {open_mesh(0.1, 0.031), open_mesh(0.02, 0.03)};
  const auto errors = observed_errors(open);
  EXPECT_EQ(errors.contact_force, 0);
  EXPECT_EQ(errors.max_pressure, 0);
  EXPECT_EQ(errors.contact_pressure, 0);
  EXPECT_EQ(errors.contact_length, 0);
  EXPECT_EQ(errors.max_penetration, 0);
  EXPECT_GT(errors.reactions[0], 0);
  // By the share of the largest displacement that may be an error, or by what the meshes show.
  for (const auto &cycles : {std::vector<Cycle>{open_mesh(0.1, 0.0195), open_mesh(0.02, 0.0195)},
                             std::vector<Cycle>{open_mesh(0.1, 0.16), open_mesh(0.02, 0.03)},
                             std::vector<Cycle>{open_mesh(0.1, 0.031), open_mesh(0.02, -1e-9)}}) {
    const auto close = observed_errors(cycles);
    EXPECT_GT(close.contact_force, 0);
    EXPECT_TRUE(std::isnan(close.max_pressure) && std::isnan(close.contact_pressure) &&
                std::isnan(close.contact_length));
    EXPECT_EQ(close.unknown.at("max_pressure"), adapt::may_touch);
    EXPECT_EQ(close.max_penetration, 0); // the foundation never gives way
  }
}

TEST(ErrorBars, OfPressuresThatAreAllWithinTheErrorOfTheContactForceAreUnknown)
{
  // 30 Pa over 1e-3 m are 0.03 N at most; the force has changed by 1 N, and falls with the estimate: 0.25 N are left.
  std::vector<Cycle> cycles = {mesh(0.1, 1.02, 30), mesh(0.02, 0.02, 30)};
  cycles.back().contact.contact_length = 1e-3;
  const auto errors = observed_errors(cycles);
  EXPECT_NEAR(errors.contact_force, 0.25, 0.01);
  EXPECT_TRUE(std::isnan(errors.max_pressure) && std::isnan(errors.contact_length));
  EXPECT_EQ(errors.unknown.at("max_pressure"), adapt::may_be_open);
  cycles.back().contact.contact_length = 1e-2; // 0.3 N
  EXPECT_FALSE(std::isnan(observed_errors(cycles).max_pressure));
}

TEST(ErrorBars, OfAPenetrationThatHasJustBegunGoWithThoseOfThePressure)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.05, 10, 30)};
  for (auto &cycle : cycles) {
    cycle.peak.lowest_bound = 30;
    cycle.peak.friction_edge = true;
  }
  cycles.front().contact.max_penetration = 1e-6;
  cycles.back().contact.max_dent = cycles.back().contact.max_penetration = 4e-6;
  ASSERT_EQ(observed_errors(cycles).unknown.count("max_pressure"), 1);
  EXPECT_EQ(observed_errors(cycles).unknown.count("max_penetration"), 0); // its bar is smaller than itself
  cycles.front().contact.max_penetration = 9e-6;
  EXPECT_TRUE(std::isnan(observed_errors(cycles).max_penetration));
  EXPECT_EQ(observed_errors(cycles).unknown.count("max_penetration"), 1);
  for (auto &cycle : cycles) cycle.peak.friction_edge = false;
  EXPECT_FALSE(std::isnan(observed_errors(cycles).max_penetration));
}

TEST(ErrorBars, OfNoPenetrationAreNoneWhereABodyMayTouchWhatGivesWay)
{
  std::vector<Cycle> cycles = {open_mesh(0.1, 0.0195), open_mesh(0.02, 0.0195)};
  for (const double from : {0., 30.}) { // springs, or a yield stress
    cycles.back().peak.lowest_bound = from;
    EXPECT_TRUE(std::isnan(observed_errors(cycles).max_penetration)) << from;
    cycles.back().smallest_gap = cycles.front().smallest_gap = 0.03;
    EXPECT_EQ(observed_errors(cycles).max_penetration, 0) << from;
    cycles.back().smallest_gap = cycles.front().smallest_gap = 0.0195;
  }
}

} // namespace
} // namespace cycle_test
