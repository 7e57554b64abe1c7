// SPDX-License-Identifier: BSD-3-Clause
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Guaranteed bounds in space on foundations that harden, are elastic, keep dents or rub, doc/bounds.md (13.11), (13.12).

namespace error_bound_laws_in_space_test
{
namespace
{

using namespace rpc;

const std::string decks = std::string(RPC_TEST_DECKS) + "/";

using Assignments = std::vector<std::string>;

Assignments joined(Assignments these, const Assignments &more)
{
  these.insert(these.end(), more.begin(), more.end());
  return these;
}

Solution bounded(const std::string &deck, const Assignments &assignments)
{
  Solution s = run_scene(decks + deck, joined(assignments, {"Adapt->Error Bound=guaranteed"}));
  EXPECT_TRUE(s.bound);
  EXPECT_EQ(s.bound->missing, "");
  return s;
}

TEST(ErrorBoundOfLawsInSpace, HoldsTheEnergyOfTheSameBodyInThePlane)
{
  // A slice between two sides that slide is the plane's body: J by length is known from a narrow interval of P2.
  const struct {
    const char *name;
    Assignments numbers;
  } laws[] = {{"rigid, then plastic", {}},
              {"hardening", {"Contact->Hardening=400"}},
              {"springs", {"Contact->Stiffness=3e3"}},
              {"springs that never yield", {"Contact->Stiffness=3e3", "Contact->Yield Stress=inf"}},
              {"all", {"Contact->Hardening=400", "Contact->Stiffness=3e3", "Contact->Friction Bound=0.5"}},
              {"friction", {"Contact->Friction Bound=0.5"}},
              {"rigid with friction", {"Contact->Friction Bound=1", "Contact->Yield Stress=inf"}},
              {"friction up to a limit", {"Contact->Friction Bound=2", "Contact->Friction Limit=0.7"}}};
  constexpr double thickness = 0.25;
  const Assignments slice = {"Mesh->Lower={0, 0, 0}", "Mesh->Upper={2, 1, 0.25}", "Mesh->Cells={8, 4, 1}",
                             "Dirichlet->front->Z=0", "Dirichlet->back->Z=0"};
  for (const auto &law : laws)
    for (const std::string element : {"P1", "P2"}) {
      SCOPED_TRACE(law.name + (", " + element));
      const bool quadratic = element == "P2";
      const Assignments numbers = joined({"Kinematics=plane strain"}, law.numbers);
      const Solution plane = bounded("heavy_block.xml",
                                     joined(numbers, {quadratic ? "Mesh->Cells={40, 30}" : "Mesh->Cells={16, 12}"})),
                     s = bounded("heavy_block.xml", joined(joined(numbers, slice), {"Mesh->Element=" + element}));
      const double low = thickness * plane.bound->lower, high = thickness * plane.bound->upper;
      EXPECT_GT(s.contact.total.force[1], 0);
      EXPECT_LE(s.bound->lower, high);
      EXPECT_GE(s.bound->upper, low);
      const double width = s.bound->upper - s.bound->lower,
                   most = quadratic ? 1.85 : 2.8; // one cell across is not much
      EXPECT_LT(width, most * most * (s.bound->upper - low));
      EXPECT_LT(high - low, (quadratic ? 0.4 : 0.1) * width); // narrow
    }
}

TEST(ErrorBoundOfLawsInSpace, IsZeroWhereTheElementsHaveTheSolution)
{
  // A block that is pressed evenly onto springs, or into a foundation that hardens, by steps too: constant stresses.
  const struct {
    const char *name;
    Assignments numbers;
  } even[] = {{"springs", {"Contact->Stiffness=5e3"}},
              {"hardening", {"Contact->Yield Stress=1", "Contact->Hardening=600"}},
              {"both", {"Contact->Yield Stress=1", "Contact->Hardening=600", "Contact->Stiffness=5e3"}},
              {"dents",
               {"Contact->Yield Stress=1", "Contact->Hardening=600", "Steps->Times={1, 2, 3}",
                "Dirichlet->front->Z=t < 1.5 ? -0.004 : (t < 2.5 ? -0.001 : -0.005)"}}};
  for (const auto &scene : even)
    for (const std::string element : {"P1", "P2"}) {
      SCOPED_TRACE(scene.name + (", " + element));
      const Solution s = bounded("even_block_in_space.xml", joined(scene.numbers, {"Mesh->Element=" + element}));
      EXPECT_GT(s.energy_norm_squared, 1e-6);
      EXPECT_GT(s.contact.total.max_pressure, 0.5);
      for (const double bound : s.bound->steps) EXPECT_LT(bound, 1e-11 * s.energy_norm_squared);
    }
}

TEST(ErrorBoundOfLawsInSpace, IsZeroOfABlockThatSlidesEvenly)
{
  for (const std::string element : {"P1", "P2"}) {
    SCOPED_TRACE(element);
    const Solution s = bounded("sliding_block_in_space.xml", {"Mesh->Element=" + element});
    EXPECT_EQ(s.bound->of, bound::EnergyBound::Of::energy_and_friction);
    EXPECT_GT(s.contact.total.max_slip, 0.04);
    for (const double bound : s.bound->steps) EXPECT_LT(bound, 1e-11 * s.energy_norm_squared);
  }
}

TEST(ErrorBoundOfLawsInSpace, OfAStepIsThatOfTheDentsThatTheStepBeforeHasLeft)
{
  // The first step leaves an even dent, the same on all meshes.
  const Assignments steps = {"Contact->Yield Stress=1",
                             "Contact->Hardening=600",
                             "Contact->Stiffness=5e3",
                             "Steps->Times={1, 2}",
                             "Dirichlet->front->Z=t < 1.5 ? -0.004 : -0.003",
                             "Traction->right->X=t < 1.5 ? 1.5 : 1.5 + 4*y*z"};
  const Solution s = bounded("even_block_in_space.xml", steps),
                 fine = bounded("even_block_in_space.xml", joined(steps, {"Mesh->Cells={9, 9, 6}"}));
  EXPECT_GT(s.contact.total.max_dent, 1e-4);
  EXPECT_GT(s.contact.total.max_pressure, 0);
  EXPECT_LE(s.bound->lower, fine.bound->upper);
  EXPECT_GE(s.bound->upper, fine.bound->lower);
  EXPECT_LT(s.bound->upper - s.bound->lower, 1.7 * 1.7 * (s.bound->upper - fine.bound->lower));
}

TEST(ErrorBoundOfLawsInSpace, OfCoulombsFrictionIsThatOfItsPresentLimits)
{
  const Solution coulomb =
      bounded("clamped_block.xml", {"Contact->Friction Coefficient=0.3", "Contact->Friction Bound=0.2"});
  EXPECT_EQ(coulomb.bound->of, bound::EnergyBound::Of::energy_and_fixed_friction);
  EXPECT_LT(coulomb.bound->upper - coulomb.bound->lower, 0.5 * std::abs(coulomb.bound->upper));
  const Solution limited =
      bounded("clamped_block.xml", {"Contact->Friction Coefficient=1e-12", "Contact->Friction Bound=0.5"});
  const Solution tresca = bounded("clamped_block.xml", {"Contact->Friction Bound=0.5"});
  EXPECT_EQ(tresca.bound->of, bound::EnergyBound::Of::energy_and_friction);
  EXPECT_NEAR(limited.bound->lower, tresca.bound->lower, 1e-7 * std::abs(tresca.bound->lower));
  EXPECT_NEAR(limited.bound->upper, tresca.bound->upper, 1e-7 * std::abs(tresca.bound->upper));
}

} // namespace
} // namespace error_bound_laws_in_space_test
