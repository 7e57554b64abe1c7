// SPDX-License-Identifier: BSD-3-Clause
#include "cycles.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Error bars of load histories from the meshes of a run. doc/theory.md (10.7), (10.8)

namespace cycle_of_history_test
{
namespace
{

using namespace rpc;
using adapt::Cycle;
using adapt::observed_errors;
using test::mesh;
using test::open_mesh;

adapt::CoarserHistory coarser_history(const double largest_estimate, const Cycle &last)
{
  adapt::CoarserHistory coarser;
  coarser.last = last;
  coarser.largest_estimate = largest_estimate;
  return coarser;
}

TEST(ErrorBarsOfHistories, CountWhatMeshesOfEarlierStepsHaveLeft)
{
  // The meshes of the last step agree: all of them start from the same dents.
  const std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  const auto own = observed_errors(cycles);
  const auto coarser = mesh(0.08, 9, 28);
  const adapt::EarlierSteps earlier{true, 0.2, 2};
  auto errors = observed_errors(cycles, coarser_history(0.6, coarser), earlier);
  EXPECT_NEAR(errors.contact_force, own.contact_force + 1 / (0.6 / 0.2 - 1), 1e-12);
  EXPECT_NEAR(errors.max_pressure, own.max_pressure + 2 / (0.6 / 0.2 - 1), 1e-12);
  EXPECT_NEAR(errors.energy, own.energy + 0.2 * 0.2, 1e-12); // where the two histories agree by chance
  EXPECT_TRUE(std::isnan(errors.contact_pressure));
  // Earlier steps of the run itself may have had the coarser meshes.
  errors = observed_errors(cycles, coarser_history(0.1, coarser), earlier);
  EXPECT_NEAR(errors.contact_force, own.contact_force + 1 / 0.5, 1e-12);
  // Errors as large in both tell little; forces that agree by chance have what the load, moved by 2 m, makes of the energy.
  errors = observed_errors(cycles, coarser_history(0.2, coarser), earlier);
  EXPECT_NEAR(errors.contact_force, own.contact_force + 1 / 0.1, 1e-12);
  errors = observed_errors(cycles, coarser_history(0.6, cycles.front()), earlier);
  EXPECT_NEAR(errors.contact_force, own.contact_force + 2 * 0.2 * 0.2 / 2, 1e-12);
  // A jump of the gap within a facet that an earlier step has dented, and that bears nothing any more.
  errors = observed_errors(cycles, coarser_history(0.6, cycles.front()), {true, 0.2, 2, {0.7, 0.3}});
  EXPECT_NEAR(errors.contact_force, own.contact_force + 0.7, 1e-12);
  EXPECT_NEAR(errors.energy, own.energy + 0.3, 1e-12);
}

TEST(ErrorBarsOfHistories, OfThePenetrationAreNoLessThanWhatAJumpHasLeftOfTheDentsOfAnEarlierStep)
{
  std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  for (Cycle &cycle : cycles) cycle.contact.max_penetration = cycle.contact.max_dent = 0.5;
  cycles.back().misread_penetration = 0.6;
  EXPECT_NEAR(adapt::left_by_misreading(cycles.back()).penetration, 0.1, 1e-12);
  const auto bar = [&](const double of_earlier_step) {
    return observed_errors(cycles, coarser_history(0.6, cycles.back()), {true, 0.2, 2, {0, 0, of_earlier_step}})
        .max_penetration;
  };
  EXPECT_NEAR(bar(0.05), 0.1, 1e-12);
  EXPECT_NEAR(bar(0.2), 0.2, 1e-12);
  cycles.back().contact.max_dent = 0; // springs have no memory
  cycles.back().contact.foundation_energy = 1;
  EXPECT_LT(bar(0.2), 0.2);
}

TEST(ErrorBarsOfHistories, OfABodyThatDoesNotTouchCountWhatEarlierStepsLeaveOfItsGap)
{
  const std::vector<Cycle> cycles = {open_mesh(0.1, 0.03), open_mesh(0.02, 0.03)};
  const adapt::EarlierSteps earlier{true, 0.2, 2};
  auto errors = observed_errors(cycles, coarser_history(0.6, open_mesh(0.08, 0.029)), earlier);
  EXPECT_EQ(errors.contact_force, 0);
  EXPECT_EQ(errors.max_pressure, 0);
  EXPECT_EQ(errors.contact_length, 0);
  errors = observed_errors(cycles, coarser_history(0.6, open_mesh(0.08, 0.06)), earlier); // 0.03 / (0.6 / 0.2 - 1) more
  EXPECT_GT(errors.contact_force, 0);
  EXPECT_EQ(errors.unknown.at("max_pressure"), adapt::may_touch);
  EXPECT_TRUE(std::isnan(errors.contact_length));
}

TEST(ErrorBarsOfHistories, AreThoseOfTheLastStepWhereNothingIsLeft)
{
  const std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10.1, 30)};
  const adapt::EarlierSteps earlier{false, 0.2, 2};
  const auto errors = observed_errors(cycles, coarser_history(0.6, mesh(0.08, 5, 28)), earlier);
  EXPECT_EQ(errors.contact_force, observed_errors(cycles).contact_force);
  // One mesh in the last step: a coarser one shows the change.
  const auto alone = observed_errors({cycles.back()}, coarser_history(0.6, mesh(0.1, 10, 28)), earlier);
  EXPECT_NEAR(alone.contact_force, 0.1 / (0.1 / 0.02 - 1), 1e-12);
}

TEST(ErrorBarsOfHistories, AreNoneWithoutACoarserMesh)
{
  adapt::CoarserHistory none;
  none.missing = "there is no coarser mesh";
  const std::vector<Cycle> cycles = {mesh(0.1, 10, 30), mesh(0.02, 10, 30)};
  const auto errors = observed_errors(cycles, none, {true, 0.2, 2});
  EXPECT_TRUE(std::isnan(errors.energy) && std::isnan(errors.contact_force));
  EXPECT_NE(errors.unknown.at("energy_J").find("earlier steps"), std::string::npos);
  EXPECT_EQ(observed_errors({cycles.back()}, none, {false, 0.2, 2}).unknown.at("energy_J"), adapt::one_mesh);
}

} // namespace
} // namespace cycle_of_history_test
