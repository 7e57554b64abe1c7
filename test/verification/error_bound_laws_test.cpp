// SPDX-License-Identifier: BSD-3-Clause
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Guaranteed bounds of foundations that harden, are elastic, keep dents or rub, doc/bounds.md (13.11), (13.12).

namespace error_bound_laws_test
{
namespace
{

using namespace rpc;

const std::string decks = std::string(RPC_TEST_DECKS) + "/";

Solution bounded(const std::string &deck, std::vector<std::string> assignments)
{
  assignments.push_back("Adapt->Error Bound=guaranteed");
  Solution s = run_scene(decks + deck, assignments);
  EXPECT_TRUE(s.bound);
  EXPECT_EQ(s.bound->missing, "");
  return s;
}

struct Law {
  const char *name;
  std::vector<std::string> numbers;
};
const Law laws[] = {
    {"hardening", {"Contact->Hardening=400"}},
    {"springs", {"Contact->Stiffness=3e3"}},
    {"springs that never yield", {"Contact->Stiffness=3e3", "Contact->Yield Stress=inf"}},
    {"all", {"Contact->Hardening=400", "Contact->Stiffness=3e3", "Contact->Friction Bound=0.5"}},
    {"friction", {"Contact->Friction Bound=0.5"}},
    {"rigid with friction", {"Contact->Friction Bound=1", "Contact->Yield Stress=inf"}},
    {"friction up to a limit", {"Contact->Friction Bound=2", "Contact->Friction Limit=0.7"}},
};

std::vector<std::string> with(std::vector<std::string> these, const std::vector<std::string> &more)
{
  these.insert(these.end(), more.begin(), more.end());
  return these;
}

TEST(ErrorBoundOfLaws, HoldsTheEnergyAndIsNear)
{
  // The reference: cells of P2 a quarter as long, whose bracket is narrow.
  for (const Law &law : laws) {
    SCOPED_TRACE(law.name);
    const Solution fine = bounded("heavy_block.xml", with({"Mesh->Cells={32, 24}"}, law.numbers));
    ASSERT_GT(fine.contact.total.force[1], 0);
    for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
      SCOPED_TRACE(element);
      const Solution s =
          bounded("heavy_block.xml", with({"Mesh->Element=" + element, "Mesh->Cells={8, 6}"}, law.numbers));
      EXPECT_LE(s.bound->lower, fine.bound->upper);
      EXPECT_GE(s.bound->upper, fine.bound->lower);
      EXPECT_LT(s.bound->upper - s.bound->lower, 1.35 * 1.35 * (s.bound->upper - fine.bound->lower));
    }
  }
}

TEST(ErrorBoundOfLaws, IsZeroWhereTheElementsHaveTheSolution)
{
  // A block that is pressed evenly onto springs, or into a foundation that hardens, by steps too: constant stresses.
  struct {
    const char *name;
    std::vector<std::string> numbers;
  } const even[] = {
      {"springs", {"Contact->Stiffness=5e3"}},
      {"hardening", {"Contact->Yield Stress=1", "Contact->Hardening=600"}},
      {"both", {"Contact->Yield Stress=1", "Contact->Hardening=600", "Contact->Stiffness=5e3"}},
      {"dents",
       {"Contact->Yield Stress=1", "Contact->Hardening=600", "Steps->Times={1, 2, 3}",
        "Dirichlet->top->Y=t < 1.5 ? -0.004 : (t < 2.5 ? -0.001 : -0.005)"}},
  };
  for (const auto &scene : even)
    for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
      SCOPED_TRACE(scene.name + (", " + element));
      const Solution s = bounded("even_block.xml", with({"Mesh->Element=" + element}, scene.numbers));
      const double size = s.energy_norm_squared;
      EXPECT_GT(size, 1e-6);
      EXPECT_GT(s.contact.total.max_pressure, 0.5);
      for (const double bound : s.bound->steps) EXPECT_LT(bound, 1e-11 * size);
    }
}

TEST(ErrorBoundOfLaws, OfAStepIsThatOfTheDentsThatTheStepBeforeHasLeft)
{
  // The second step is solved on nested meshes of P1, on which the dents of the first one are the same function.
  const Solution s =
      bounded("heavy_block.xml", {"Mesh->Element=P1", "Contact->Hardening=400", "Contact->Stiffness=2e4",
                                  "Steps->Times={1, 2}", "Traction->top->Y=t < 1.5 ? -3*x*(2 - x) : -1.5*x*(2 - x)",
                                  "Adapt->Meshes=nested", "Adapt->Target Relative Error=0.1"});
  EXPECT_GT(s.contact.total.max_dent, 0);
  ASSERT_TRUE(s.adaptation);
  const bound::EnergyBound &last = *s.adaptation->cycles.back().bound;
  for (const auto &cycle : s.adaptation->cycles) {
    EXPECT_LE(cycle.bound->lower, last.upper);
    EXPECT_GE(cycle.bound->upper, last.lower);
  }
}

TEST(ErrorBoundOfLaws, OfCoulombsFrictionIsThatOfItsPresentLimits)
{
  // A limit far below the friction that the pressure would allow: Tresca's law but where the pressure is nearly 0.
  const Solution coulomb =
      bounded("heavy_block.xml", {"Contact->Friction Coefficient=0.3", "Contact->Friction Bound=0.2"});
  EXPECT_EQ(coulomb.bound->of, bound::EnergyBound::Of::energy_and_fixed_friction);
  EXPECT_LT(coulomb.bound->upper - coulomb.bound->lower, 0.1 * std::abs(coulomb.bound->upper));
  const Solution limited =
      bounded("heavy_block.xml", {"Contact->Friction Coefficient=1e-12", "Contact->Friction Bound=0.5"});
  const Solution tresca = bounded("heavy_block.xml", {"Contact->Friction Bound=0.5"});
  EXPECT_EQ(tresca.bound->of, bound::EnergyBound::Of::energy_and_friction);
  EXPECT_NEAR(limited.bound->lower, tresca.bound->lower, 1e-8 * std::abs(tresca.bound->lower));
  EXPECT_NEAR(limited.bound->upper, tresca.bound->upper, 1e-8 * std::abs(tresca.bound->upper));
}

} // namespace
} // namespace error_bound_laws_test
