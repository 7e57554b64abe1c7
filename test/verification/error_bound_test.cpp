// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/error.hpp"
#include "rpc/mesh/has_gmsh.hpp"
#include "run_scene.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

// Guaranteed bounds of energy and error, doc/bounds.md. The table of the beam comes from independent code; its energies from
// brackets by adapted meshes.

namespace error_bound_test
{
namespace
{

using namespace rpc;

const std::string input = std::string(RPC_TEST_DECKS) + "/../../../input/";

Solution bounded(const std::string &deck, std::vector<std::string> assignments)
{
  assignments.push_back("Adapt->Error Bound=guaranteed");
  Solution s = run_scene(deck, assignments);
  EXPECT_TRUE(s.bound);
  EXPECT_EQ(s.bound->missing, "");
  return s;
}

Solution beam(const std::string &element, const int cells, const std::string &xi, std::vector<std::string> more = {})
{
  more.insert(more.end(), {"Mesh->Element=" + element,
                           "Mesh->Cells={" + std::to_string(5 * cells) + ", " + std::to_string(cells) + "}",
                           "Contact->Yield Stress=" + xi});
  return bounded(input + "beam.xml", more);
}

TEST(ErrorBound, OfTheBeamThatYieldsEverywhereIsThatOfATable)
{
  // J(u_h), J(u_h) - J(u), and the bound after 0 to 3 steps. All facets yield, so that pressure and solution are unique.
  struct Row {
    const char *element;
    double energy, error, bound[4];
  };
  const Row table[] = {{"P1", -2.813847, 0.1567, {2.411, 0.3090, 0.2239, 0.2041}},
                       {"P2", -2.964252, 6.331e-3, {5.268e-2, 1.013e-2, 8.422e-3, 8.192e-3}},
                       {"Q1", -2.919520, 5.106e-2, {0.1191, 0.05967, 0.05729, 0.05675}},
                       {"Q2", -2.966754, 3.829e-3, {0.01869, 0.005525, 0.005416, 0.005389}}};
  for (const Row &row : table) {
    SCOPED_TRACE(row.element);
    const Solution s = beam(row.element, 8, "4");
    EXPECT_NEAR(s.bound->upper, row.energy, 1e-6);
    EXPECT_NEAR(s.bound->upper + 2.9705828, row.error, 1e-3 * row.error);
    ASSERT_EQ(s.bound->steps.size(), 4u);
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(s.bound->steps[k], row.bound[k], 4e-4 * row.bound[k]) << "after " << k << " steps";
    EXPECT_LT(s.bound->imbalance, 1e-11);
  }
}

TEST(ErrorBound, HoldsTheEnergyOfTheBeamAndIsNear)
{
  for (const auto &[xi, energy] : {std::pair<std::string, double>{"inf", -0.1912749634}, {"16", -0.213440820}})
    for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
      SCOPED_TRACE(element + ", xi = " + xi);
      const Solution s = beam(element, 8, xi);
      EXPECT_LT(s.bound->lower, energy);
      EXPECT_GT(s.bound->upper, energy);
      EXPECT_LT((s.bound->upper - s.bound->lower) / (s.bound->upper - energy), 1.3 * 1.3);
      EXPECT_GT(s.bound->energy_norm, std::sqrt(2 * (s.energy - energy)));
    }
}

TEST(ErrorBound, OfEachMeshThatIsAdapted)
{
  const Solution s = beam("P2", 4, "16", {"Adapt->Target Relative Error=0.01", "Adapt->Meshes=nested"});
  ASSERT_TRUE(s.adaptation);
  ASSERT_GT(s.adaptation->cycles.size(), 1u);
  for (const auto &cycle : s.adaptation->cycles) {
    ASSERT_TRUE(cycle.bound);
    EXPECT_LT(cycle.bound->lower, -0.213440820);
    EXPECT_GT(cycle.bound->upper, -0.213440820);
    EXPECT_LT((cycle.bound->upper - cycle.bound->lower) / (cycle.bound->upper + 0.213440820), 1.3 * 1.3);
  }
}

TEST(ErrorBound, IsWhatAdaptedMeshesStopByAndFollow)
{
  const double target = 0.05;
  const Solution s =
      beam("P1", 4, "16", {"Adapt->Target Relative Error=" + std::to_string(target), "Adapt->Meshes=nested"});
  ASSERT_TRUE(s.adaptation);
  EXPECT_TRUE(s.adaptation->reached);
  const auto &cycles = s.adaptation->cycles;
  const auto relative = [](const auto &cycle) {
    return cycle.bound->energy_norm / std::sqrt(cycle.energy_norm_squared);
  };
  ASSERT_GT(cycles.size(), 1u);
  for (std::size_t k = 0; k + 1 < cycles.size(); ++k) EXPECT_GT(relative(cycles[k]), target);
  EXPECT_LE(relative(cycles.back()), target);
  EXPECT_LT(cycles.back().dofs, 6000); // the estimator, which is smaller, needs 2818 for an estimate of as much
  double sum = 0;
  const auto parts = to_host(s.bound->squared);
  for (std::size_t c = 0; c < parts.extent(0); ++c) sum += parts(c);
  EXPECT_EQ(static_cast<LO>(parts.extent(0)), s.discretization.mesh->num_owned_cells);
  EXPECT_NEAR(sum, s.bound->energy_norm * s.bound->energy_norm, 1e-10 * sum);
}

TEST(ErrorBound, HoldsTheContactForce)
{
  // The reference: cells of P2 a quarter as long.
  const std::string deck = std::string(RPC_TEST_DECKS) + "/heavy_block.xml";
  for (const std::vector<std::string> &law : std::vector<std::vector<std::string>>{
           {"Contact->Gap=0.0005*x"},
           {"Contact->Gap=0.0005*x", "Contact->Stiffness=3e3", "Contact->Hardening=0"},
           {"Contact->Gap=0.0005*x", "Contact->Friction Bound=0.5"}}) {
    SCOPED_TRACE(law.back());
    auto of_fine = law;
    of_fine.push_back("Mesh->Cells={32, 24}");
    const Solution fine = bounded(deck, of_fine);
    const double force = fine.contact.total.force[1];
    ASSERT_GT(force, 0);
    for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
      SCOPED_TRACE(element);
      auto of_coarse = law;
      of_coarse.insert(of_coarse.end(), {"Mesh->Element=" + element, "Mesh->Cells={8, 6}"});
      const Solution s = bounded(deck, of_coarse);
      ASSERT_EQ(s.bound->contact_force.size(), 1u);
      const bound::ForceBound &interval = s.bound->contact_force[0];
      EXPECT_EQ(interval.missing, "");
      EXPECT_LT(interval.lower, force);
      EXPECT_GT(interval.upper, force);
      EXPECT_GT(interval.upper, fine.bound->contact_force[0].lower);
      EXPECT_LT(interval.lower, fine.bound->contact_force[0].upper);
      EXPECT_LT(interval.upper - interval.lower, (element[1] == '1' ? 0.8 : 0.35) * force);
    }
    EXPECT_LT(fine.bound->contact_force[0].upper - fine.bound->contact_force[0].lower, 0.1 * force);
  }
}

TEST(ErrorBound, OfTheContactForceIsItselfWhereTheElementsHaveTheSolution)
{
  for (const std::string element : {"P1", "Q2"}) {
    SCOPED_TRACE(element);
    const Solution s = bounded(std::string(RPC_TEST_DECKS) + "/even_block.xml", {"Mesh->Element=" + element});
    const double force = s.contact.total.force[1];
    ASSERT_EQ(s.bound->contact_force.size(), 1u);
    EXPECT_NEAR(s.bound->contact_force[0].lower, force, 1e-5 * force);
    EXPECT_NEAR(s.bound->contact_force[0].upper, force, 1e-5 * force);
  }
}

TEST(ErrorBound, OfTheContactForceHasAReasonWhereThereIsNone)
{
  const Solution s = beam("P1", 4, "inf");
  ASSERT_EQ(s.bound->contact_force.size(), 1u);
  EXPECT_NE(s.bound->contact_force[0].missing.find("no yield stress limits"), std::string::npos);
}

TEST(ErrorBound, IsZeroWhereTheElementsHaveTheSolution)
{
  // A block under an even pressure of 3 Pa that slides at its sides: constant stresses, in contact or yielding.
  for (const std::string element : {"P1", "P2", "Q1", "Q2"})
    for (const std::string xi : {"inf", "3"}) {
      SCOPED_TRACE(element + ", xi = " + xi);
      const Solution s = bounded(std::string(RPC_TEST_DECKS) + "/even_block.xml",
                                 {"Mesh->Element=" + element, "Contact->Yield Stress=" + xi});
      const double size = s.energy_norm_squared;
      EXPECT_GT(size, 1e-6);
      for (const double bound : s.bound->steps) EXPECT_LT(bound, 1e-11 * size);
    }
}

TEST(ErrorBound, CountsBodyForcesAndTiltedGaps)
{
  // The reference: cells of P2 a quarter as long, whose bracket is narrow.
  const std::string deck = std::string(RPC_TEST_DECKS) + "/heavy_block.xml";
  const Solution fine = bounded(deck, {"Mesh->Element=P2", "Mesh->Cells={32, 24}"});
  ASSERT_GT(fine.contact.total.force[1], 0);
  for (const std::string element : {"P1", "P2", "Q1", "Q2"}) {
    SCOPED_TRACE(element);
    const Solution s = bounded(deck, {"Mesh->Element=" + element, "Mesh->Cells={8, 6}"});
    EXPECT_LE(s.bound->lower, fine.bound->upper);
    EXPECT_GE(s.bound->upper, fine.bound->lower);
    EXPECT_LT(s.bound->upper - s.bound->lower, 1.3 * 1.3 * (s.bound->upper - fine.bound->lower));
  }
}

TEST(ErrorBound, HoldsTheEnergyUnderLoadsThatJumpOrWaveBetweenCells)
{
  // Cells of (0.25 m)^2 end where the load jumps.
  for (const std::string load : {"x > 1.25 ? -10 : 0", "-10*sin(3*x)"}) {
    SCOPED_TRACE(load);
    const auto of_cells = [&](const std::string &element, const std::string &cells) {
      return bounded(input + "beam.xml",
                     {"Mesh->Element=" + element, "Mesh->Cells=" + cells, "Traction->top->Y=" + load});
    };
    const Solution coarse = of_cells("P1", "{20, 4}"), fine = of_cells("P2", "{80, 16}");
    EXPECT_LE(coarse.bound->lower, fine.bound->upper);
    EXPECT_GE(coarse.bound->upper, fine.bound->lower);
  }
}

TEST(ErrorBound, IsRefusedWithWhatIsCovered)
{
  const auto refused = [](const std::string &deck, const std::vector<std::string> &assignments,
                          const std::string &part) {
    SCOPED_TRACE(part);
    std::vector<std::string> all = assignments;
    all.push_back("Adapt->Error Bound=guaranteed");
    try {
      run_scene(input + deck, all);
      ADD_FAILURE() << "not refused";
    } catch (const Error &error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("guaranteed covers"), std::string::npos) << error.what();
    }
  };
  const std::string small = "Mesh->Cells={10, 2}";
  refused("beam.xml", {small, "Contact->Friction Bound=1 + x"}, "Friction Bound");
  refused("beam.xml", {small, "Contact->Yield Stress=16 + x"}, "Yield Stress");
  refused("beam.xml", {small, "Body Force->Y=-x"}, "Body Force");
  refused("beam.xml", {small, "Traction->top->Y=x > 1.1 ? -10 : 0"}, "smooth within each cell");
  refused("beam.xml", {small, "Traction->top->Y=abs(x - 1.005) < 0.01 ? -1000 : 0"}, "smooth within each cell");
  refused("beam.xml", {small, "Dirichlet->left->Y=1e-3*y^3"}, "Dirichlet->left");
  refused("beam.xml", {small, "Dirichlet->top->Force Y=-5"}, "\"Dirichlet->top\" is moved by a force");
  refused("beam.xml", {small, "Contact->Gap=1e-3*x^4"}, "another than between its nodes");
  refused("beam.xml", {small, "Material->Poisson's Ratio=0.45"}, "projected dilatation");
  if (mesh::has_gmsh())
    refused("beam.xml", {small, "Mesh->Element=Q2", "Adapt->Target Relative Error=0.1", "Adapt->Meshes=gmsh"},
            "\"Mesh->Element\" = P2, or \"Adapt->Meshes\" = nested");
  refused("beam.xml", {small, "Contact->Yield Stress=t*x", "Steps->Times={1}"}, "Yield Stress");
  refused("block.xml", {"Contact->Yield Stress=16"}, "in space");
  if (!mesh::has_gmsh()) return;
  const std::filesystem::path quadrilaterals = std::filesystem::temp_directory_path() / "rpc_error_bound_quads.geo";
  std::filesystem::copy_file(std::string(RPC_TEST_DECKS) + "/transfinite.geo", quadrilaterals,
                             std::filesystem::copy_options::overwrite_existing);
  std::ofstream(quadrilaterals, std::ios::app) << "Recombine Surface {1};\n";
  refused("../test/verification/decks/transfinite.xml",
          {"Mesh->File=" + quadrilaterals.string(), "Adapt->Target Relative Error=0.1"}, "Recombine");
}

} // namespace
} // namespace error_bound_test
