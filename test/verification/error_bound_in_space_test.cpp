// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/error.hpp"
#include "run_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

// Guaranteed bounds of bodies in space, doc/bounds.md. The table comes from independent code.

namespace error_bound_in_space_test
{
namespace
{

using namespace rpc;

const std::string deck = std::string(RPC_TEST_DECKS) + "/clamped_block.xml";

Solution bounded(std::vector<std::string> assignments, const std::string &of = deck)
{
  assignments.push_back("Adapt->Error Bound=guaranteed");
  Solution s = run_scene(of, assignments);
  EXPECT_TRUE(s.bound);
  EXPECT_EQ(s.bound->missing, "");
  return s;
}

Solution finer(std::vector<std::string> assignments, const std::string &cells, const std::string &of = deck)
{
  assignments.insert(assignments.end(), {"Mesh->Element=P2", "Mesh->Cells=" + cells, "Adapt->Error Bound=estimated"});
  return run_scene(of, assignments);
}

TEST(ErrorBoundInSpace, OfABlockIsThatOfATable)
{
  // J(u^) and the bound after 0 to 6 steps. At xi = 1 and 0.2 all facets yield, so that the pressure is unique; at xi = inf all are closed,
  // at xi = 6 some.
  struct Row {
    const char *limit;
    double energy, bound[7];
  };
  const Row table[] = {
      {"1", -0.51155268, {8.027756, 1.122892, 0.7487193, 0.6062920, 0.5462927, 0.5001992, 0.4771354}},
      {"0.2", -0.63041661, {9.906214, 1.392126, 0.9316023, 0.7558070, 0.6817035, 0.6247341, 0.5959876}},
      {"6", -0.14450007, {0.8859030, 0.1171910, 0.07129009, 0.05561393, 0.04900375, 0.04418549, 0.04193142}},
      {"inf", -0.14068611, {0.4961460, 0.07266163, 0.04196190, 0.03244007, 0.02853472, 0.02580450, 0.02447184}}};
  for (const Row &row : table) {
    SCOPED_TRACE(row.limit);
    const Solution s = bounded({std::string("Contact->Yield Stress=") + row.limit});
    EXPECT_NEAR(s.bound->upper, row.energy, 1e-8);
    ASSERT_EQ(s.bound->steps.size(), 7u);
    constexpr double allowed = 5e-5; // what steers the descent is of single precision
    for (int k = 0; k < 7; ++k)
      EXPECT_NEAR(s.bound->steps[k], row.bound[k], allowed * row.bound[k]) << "after " << k << " steps";
    EXPECT_LT(s.bound->imbalance, 1e-12);
    EXPECT_NEAR(s.bound->lower, s.bound->upper - s.bound->steps[6], 1e-12);
  }
}

/// The interval of a solution holds the energy of one on a finer mesh, and its root is not much larger than the error.
void expect_near(const Solution &s, const Solution &fine, const double most_effectivity)
{
  ASSERT_TRUE(fine.estimate);
  const double left = fine.estimate->total() / 2, true_error = s.bound->upper - (fine.energy - left);
  EXPECT_LT(s.bound->lower, fine.energy - left);
  EXPECT_GT(s.bound->upper, fine.energy);
  EXPECT_LT(s.bound->upper - s.bound->lower, most_effectivity * most_effectivity * true_error);
  EXPECT_LT(s.bound->imbalance, 1e-11);
  for (int k = 0; k < 6; ++k) EXPECT_LT(s.bound->steps[k + 1], s.bound->steps[k]);
}

TEST(ErrorBoundInSpace, HoldsTheEnergyOfAFinerMeshAndIsNear)
{
  // Open, closed and yielding parts; a load that no polynomial of degree 1 has; a force per volume; sides that slide.
  const std::vector<std::vector<std::string>> scenes = {
      {"Contact->Yield Stress=inf"},
      {"Contact->Yield Stress=6", "Contact->Gap=0.02*x - 0.01"},
      {"Contact->Yield Stress=8", "Traction->front->Z=-6*sin(1 + x*y)", "Body Force->Z=-3", "Body Force->X=2"},
      {"Traction->front->X=2", "Dirichlet->bottom->Y=0", "Dirichlet->top->Y=0", "Contact->Gap=0.001"}};
  for (const auto &scene : scenes) {
    SCOPED_TRACE(scene.back());
    std::vector<std::string> more = scene;
    more.push_back("Mesh->Cells={8, 6, 4}");
    const Solution s = bounded(more), fine = finer(scene, "{8, 6, 4}");
    expect_near(s, fine, 1.5);
  }
}

TEST(ErrorBoundInSpace, OfOrder2HoldsTheEnergyOfAFinerMeshAndIsNear)
{
  // As above: the reference has cells a third as long.
  const std::vector<std::vector<std::string>> scenes = {
      {"Contact->Yield Stress=inf"},
      {"Contact->Yield Stress=1"},
      {"Contact->Yield Stress=6", "Contact->Gap=0.02*x - 0.01"},
      {"Contact->Yield Stress=8", "Traction->front->Z=-6*sin(1 + 0.2*x*y)", "Body Force->Z=-3", "Body Force->X=2"},
      {"Traction->front->X=2", "Dirichlet->bottom->Y=0", "Dirichlet->top->Y=0", "Contact->Gap=0.001"}};
  for (const auto &scene : scenes) {
    SCOPED_TRACE(scene.back());
    std::vector<std::string> more = scene;
    more.push_back("Mesh->Element=P2");
    const Solution s = bounded(more), fine = finer(scene, "{12, 9, 6}");
    expect_near(s, fine, 1.6);
  }
}

TEST(ErrorBoundInSpace, CountsWhatLoadsHaveBeyondTheOrder)
{
  // On both triangles of the upper side the load is a polynomial of degree 2 that has no moment with linear functions, and little else.
  const std::vector<std::string> scene = {
      "Mesh->Upper={1, 1, 1}", "Contact->Gap=1",
      "Traction->front->Z=6*((1 - max(x,y))^2 + (max(x,y) - min(x,y))^2 + min(x,y)^2 - 0.5) - 0.001"};
  std::vector<std::string> coarse = scene;
  coarse.push_back("Mesh->Cells={1, 1, 1}");
  const Solution s = bounded(coarse), fine = finer(scene, "{4, 4, 4}");
  EXPECT_LT(fine.energy, 100 * s.bound->upper); // elements of order 1 see nearly nothing of it
  EXPECT_LT(s.bound->lower, fine.energy);
}

TEST(ErrorBoundInSpace, IsZeroWhereTheElementsHaveTheSolution)
{
  // A block under an even pressure of 2.55 Pa, or 2 Pa where it yields, that slides at its sides: constant stresses, in contact or yielding.
  for (const char *limit : {"inf", "2"})
    for (const char *element : {"P1", "P2"}) {
      SCOPED_TRACE(std::string(limit) + ", " + element);
      const Solution s =
          bounded({std::string("Contact->Yield Stress=") + limit, std::string("Mesh->Element=") + element},
                  std::string(RPC_TEST_DECKS) + "/even_block_in_space.xml");
      EXPECT_GT(s.energy_norm_squared, 1e-6);
      for (const double bound : s.bound->steps) EXPECT_LT(bound, 1e-11 * s.energy_norm_squared);
    }
}

TEST(ErrorBoundInSpace, IsWhatAdaptedMeshesStopByAndFollow)
{
  const double target = 0.4;
  const Solution s = bounded({"Adapt->Target Relative Error=" + std::to_string(target), "Adapt->Meshes=nested"});
  ASSERT_TRUE(s.adaptation);
  EXPECT_TRUE(s.adaptation->reached) << s.adaptation->reason;
  const auto &cycles = s.adaptation->cycles;
  const auto relative = [](const auto &cycle) {
    return cycle.bound->energy_norm / std::sqrt(cycle.energy_norm_squared);
  };
  ASSERT_GT(cycles.size(), 1u);
  for (std::size_t k = 0; k + 1 < cycles.size(); ++k) EXPECT_GT(relative(cycles[k]), target);
  EXPECT_LE(relative(cycles.back()), target);
  double sum = 0;
  const auto parts = to_host(s.bound->squared);
  for (std::size_t c = 0; c < parts.extent(0); ++c) sum += parts(c);
  EXPECT_EQ(static_cast<LO>(parts.extent(0)), s.discretization.mesh->num_owned_cells);
  EXPECT_NEAR(sum, s.bound->energy_norm * s.bound->energy_norm, 1e-10 * sum);
  ASSERT_EQ(s.bound->contact_force.size(), 1u);
  EXPECT_NE(s.bound->contact_force[0].missing, "");
}

TEST(ErrorBoundInSpace, OfAStepWithoutDentsIsThatOfItsLoads)
{
  const Solution alone = bounded({"Traction->front->Z=-3"}),
                 step = bounded({"Traction->front->Z=-3*t", "Steps->Times={0.5, 1}"});
  EXPECT_NEAR(step.bound->upper, alone.bound->upper, 1e-9 * std::abs(alone.bound->upper));
  EXPECT_NEAR(step.bound->lower, alone.bound->lower, 1e-6 * std::abs(alone.bound->lower));
}

TEST(ErrorBoundInSpace, CoversDisplacementsThatTheElementsRepresent)
{
  const std::vector<std::string> bent = {"Dirichlet->left->X=0.002*z - 0.001*y"};
  const Solution s = bounded(bent), fine = finer(bent, "{8, 6, 4}");
  EXPECT_LT(s.bound->lower, fine.energy);
  EXPECT_GT(s.bound->upper, fine.energy);
  const std::vector<std::string> curved = {"Dirichlet->left->X=0.002*z^2 - 0.001*y*z", "Contact->Gap=0.002*x*x"};
  std::vector<std::string> quadratic = curved;
  quadratic.push_back("Mesh->Element=P2");
  const Solution of_order_2 = bounded(quadratic), finer_2 = finer(curved, "{8, 6, 4}");
  EXPECT_LT(of_order_2.bound->lower, finer_2.energy);
  EXPECT_GT(of_order_2.bound->upper, finer_2.energy);
}

TEST(ErrorBoundInSpace, OfABodyThatNothingStrainsIsMissing)
{
  const Solution s =
      run_scene(std::string(RPC_TEST_DECKS) + "/even_block_in_space.xml",
                {"Traction->right->X=0", "Dirichlet->front->Z=0.00037", "Adapt->Error Bound=guaranteed"});
  EXPECT_EQ(s.contact.total.max_pressure, 0);
  ASSERT_TRUE(s.bound);
  EXPECT_EQ(s.bound->missing, "nothing is strained but by rounding");
}

TEST(ErrorBoundInSpace, IsRefusedWithWhatIsCovered)
{
  const auto refused = [](std::vector<std::string> assignments, const std::string &part) {
    SCOPED_TRACE(part);
    assignments.push_back("Adapt->Error Bound=guaranteed");
    try {
      run_scene(deck, assignments);
      ADD_FAILURE() << "not refused";
    } catch (const Error &error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("guaranteed covers"), std::string::npos) << error.what();
    }
  };
  refused({"Mesh->Element=Q2"}, "the cells are Q2");
  refused({"Contact->Gap=0.01*x^2"}, "another than between its nodes");
  refused({"Contact->Gap=0.01*x^3", "Mesh->Element=P2"}, "another than between its nodes");
  refused({"Contact->Yield Stress=5 + x"}, "depends on the place");
  refused({"Dirichlet->left->X=0.001*y^2"}, "displacements that the elements represent");
  refused({"Traction->front->Z=x > 1.1 ? -10 : 0"}, "smooth within each cell");
  refused({"Material->Poisson's Ratio=0.45"}, "projected dilatation");
}

} // namespace
} // namespace error_bound_in_space_test
