// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/error.hpp"
#include "rpc/core/tpetra.hpp"
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Several ranks find the guaranteed bounds that one rank finds.

namespace error_bound_ranks_test
{
namespace
{

using namespace rpc;

const std::string decks = std::string(RPC_TEST_DECKS) + "/", input = decks + "../../../input/";

void expect_same(const std::vector<bound::GoalBound> &a, const std::vector<bound::GoalBound> &b)
{
  ASSERT_EQ(a.size(), 2u);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].missing, "");
    EXPECT_EQ(b[k].missing, "");
    const double size = std::abs(b[k].lower) + std::abs(b[k].upper);
    EXPECT_NEAR(a[k].value, b[k].value, 1e-9 * size);
    EXPECT_NEAR(a[k].lower, b[k].lower, 1e-3 * size); // w is solved to 1e-4
    EXPECT_NEAR(a[k].upper, b[k].upper, 1e-3 * size);
  }
}

TEST(ErrorBoundOnRanks, OfGoalsIsThatOfOneRank)
{
  const RCP<const Comm> world = Tpetra::getDefaultComm(), alone = world->split(world->getRank(), 0);
  struct {
    std::string deck;
    std::vector<std::string> numbers;
  } const scenes[] = {{input + "beam.xml",
                       {"Mesh->Cells={20, 4}", "Mesh->Element=P2", "Goals->top->Component=Y",
                        "Goals->bottom->Type=mean pressure", "Goals->bottom->Box={1.1, 0, 3, 0}"}},
                      {decks + "clamped_block.xml",
                       {"Mesh->Element=P1", "Goals->front->Component=Z", "Goals->back->Type=contact force",
                        "Goals->back->Box={0.3, 0.2, -1, 1.5, 0.8, 1}"}},
                      {decks + "clamped_block.xml",
                       {"Mesh->Element=Q1", "Goals->back->Component=X", "Goals->part->Type=mean pressure",
                        "Goals->part->Side=back", "Goals->part->Box={0.3, 0.2, -1, 1.5, 0.8, 1}"}}};
  for (const auto &scene : scenes) {
    SCOPED_TRACE(scene.numbers[1] + " of " + scene.deck);
    auto numbers = scene.numbers;
    numbers.insert(numbers.end(), {"Contact->Yield Stress=6", "Adapt->Error Bound=guaranteed", "Uzawa->Tolerance=1e-12",
                                   "NOX->Residual Tolerance=1e-13"});
    const Solution several = run_scene(scene.deck, numbers, world), own = run_scene(scene.deck, numbers, alone);
    ASSERT_TRUE(several.bound && own.bound);
    expect_same(several.bound->goals, own.bound->goals);
  }
}

TEST(ErrorBoundOnRanks, IsThatOfOneRank)
{
  const RCP<const Comm> world = Tpetra::getDefaultComm(), alone = world->split(world->getRank(), 0);
  struct {
    std::string deck;
    std::vector<std::string> law;
  } const scenes[] = {
      {input + "beam.xml", {"Contact->Yield Stress=16", "Mesh->Cells={20, 4}"}},
      {input + "beam.xml", {"Contact->Yield Stress=inf", "Mesh->Cells={20, 4}"}},
      {decks + "heavy_block.xml", {"Contact->Hardening=400", "Contact->Stiffness=3e3", "Contact->Friction Bound=0.5"}},
      {decks + "barrel.xml", {"Contact->Gap=0.004*x", "Body Force->Y=-4", "Contact->Friction Bound=0.5"}}};
  for (const auto &scene : scenes)
    for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
      SCOPED_TRACE(scene.law[0] + ", " + element);
      auto deck = scene.law;
      deck.insert(deck.end(), {"Mesh->Element=" + element, "Adapt->Error Bound=guaranteed", "Uzawa->Tolerance=1e-12",
                               "NOX->Residual Tolerance=1e-13"});
      const Solution several = run_scene(scene.deck, deck, world), own = run_scene(scene.deck, deck, alone);
      ASSERT_TRUE(several.bound && own.bound);
      const bound::EnergyBound &a = *several.bound, &b = *own.bound;
      EXPECT_EQ(a.missing, "");
      ASSERT_EQ(a.missing, b.missing);
      const double size = std::abs(b.upper) + std::abs(b.lower);
      EXPECT_NEAR(a.lower, b.lower, 1e-10 * size);
      EXPECT_NEAR(a.upper, b.upper, 1e-10 * size);
      for (std::size_t k = 0; k < b.steps.size(); ++k) EXPECT_NEAR(a.steps[k], b.steps[k], 1e-8 * size) << k;
      EXPECT_NEAR(a.moved, b.moved, 1e-10 * b.energy_norm);
      for (std::size_t k = 0; k < b.contact_force.size(); ++k) {
        EXPECT_EQ(a.contact_force[k].missing, b.contact_force[k].missing);
        EXPECT_NEAR(a.contact_force[k].upper, b.contact_force[k].upper, 1e-4 * (1 + b.contact_force[k].upper));
      }
    }
}

TEST(ErrorBoundOnRanks, OfABodyInSpaceIsThatOfOneRank)
{
  // Of a box, whose cells are alike, and of cells that were refined, of which few are.
  const RCP<const Comm> world = Tpetra::getDefaultComm(), alone = world->split(world->getRank(), 0);
  const std::vector<std::string> scenes[] = {
      {"Contact->Yield Stress=6", "Traction->front->Z=-6*sin(1 + 0.2*x*y)", "Body Force->X=2"},
      {"Contact->Yield Stress=inf", "Mesh->Cells={3, 2, 2}"},
      {"Contact->Yield Stress=2", "Contact->Hardening=300", "Contact->Stiffness=3e3", "Contact->Friction Bound=0.3"},
      {"Contact->Yield Stress=inf", "Adapt->Meshes=nested", "Adapt->Target Relative Error=0.55"},
      {"Contact->Yield Stress=6", "Body Force->X=2", "Mesh->Cells={5, 3, 3}", "Mesh->Element=Q1"},
      {"Contact->Yield Stress=2", "Body Force->X=2", "Mesh->Cells={3, 2, 2}", "Contact->Friction Bound=0.3",
       "Mesh->Element=P2"}};
  for (const auto &scene : scenes) {
    SCOPED_TRACE(scene.back());
    auto deck = scene;
    deck.insert(deck.end(),
                {"Adapt->Error Bound=guaranteed", "Uzawa->Tolerance=1e-12", "NOX->Residual Tolerance=1e-13"});
    const Solution several = run_scene(decks + "clamped_block.xml", deck, world),
                   own = run_scene(decks + "clamped_block.xml", deck, alone);
    ASSERT_TRUE(several.bound && own.bound);
    const bound::EnergyBound &a = *several.bound, &b = *own.bound;
    EXPECT_EQ(a.missing, "");
    ASSERT_EQ(b.missing, "");
    const double size = std::abs(b.upper) + std::abs(b.lower);
    EXPECT_NEAR(a.lower, b.lower, 1e-10 * size);
    EXPECT_NEAR(a.upper, b.upper, 1e-10 * size);
    ASSERT_EQ(a.steps.size(), b.steps.size());
    for (std::size_t k = 0; k < b.steps.size(); ++k) EXPECT_NEAR(a.steps[k], b.steps[k], 1e-8 * size) << k;
    EXPECT_NEAR(a.moved, b.moved, 1e-10 * b.energy_norm);
    for (std::size_t k = 0; k < b.contact_force.size(); ++k) { // w is solved to 1e-4
      EXPECT_EQ(a.contact_force[k].missing, b.contact_force[k].missing);
      EXPECT_NEAR(a.contact_force[k].lower, b.contact_force[k].lower, 1e-3 * (1 + b.contact_force[k].upper));
      EXPECT_NEAR(a.contact_force[k].upper, b.contact_force[k].upper, 1e-3 * (1 + b.contact_force[k].upper));
    }
    double sum = 0;
    const auto parts = to_host(a.squared);
    for (std::size_t c = 0; c < parts.extent(0); ++c) sum += parts(c);
    EXPECT_EQ(static_cast<LO>(parts.extent(0)), several.discretization.mesh->num_owned_cells);
    EXPECT_NEAR(sum_all(*world, sum), a.energy_norm * a.energy_norm, 1e-10 * sum_all(*world, sum));
  }
}

TEST(ErrorBoundOnRanks, IsRefusedOnAllOfThem)
{
  const struct {
    std::string deck, cells, wrong;
  } scenes[] = {{input + "beam.xml", "{10, 2}", "Traction->top->Y=x > 1.1 ? -10 : 0"},
                {input + "beam.xml", "{10, 2}", "Dirichlet->left->Y=1e-3*y^3"},
                {input + "beam.xml", "{10, 2}", "Contact->Gap=1e-3*x^4"},
                {decks + "clamped_block.xml", "{4, 2, 2}", "Traction->front->Z=x > 1.1 ? -10 : 0"},
                {decks + "clamped_block.xml", "{4, 2, 2}", "Contact->Gap=1e-3*x^4"}};
  for (const auto &scene : scenes) {
    SCOPED_TRACE(scene.wrong);
    try {
      run_scene(scene.deck, {"Mesh->Cells=" + scene.cells, scene.wrong, "Adapt->Error Bound=guaranteed"});
      ADD_FAILURE() << "not refused";
    } catch (const Error &error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input) << error.what();
    }
  }
}

} // namespace
} // namespace error_bound_ranks_test
