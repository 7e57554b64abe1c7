// SPDX-License-Identifier: BSD-3-Clause
#include "run_scene.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <utility>
#include <vector>

// Several ranks find what one rank finds.

namespace ranks_test
{
namespace
{

using namespace rpc;

const std::string decks = std::string(RPC_TEST_DECKS) + "/", input = decks + "../../../input/";

struct Case {
  std::string name, deck;
  std::vector<std::string> assignments;
};

const std::vector<std::string> tight = {"Uzawa->Tolerance=1e-12", "NOX->Residual Tolerance=1e-13"};

std::vector<std::string> tight_and(std::vector<std::string> assignments)
{
  assignments.insert(assignments.begin(), tight.begin(), tight.end());
  return assignments;
}

const Case cases[] = {
    {"BeamThatYields", input + "beam.xml", {"Mesh->Cells={160, 32}", "Contact->Yield Stress=2"}},
    {"BeamInThreeStates", input + "beam.xml", tight_and({"Mesh->Cells={160, 32}", "Contact->Yield Stress=16"})},
    {"BeamOnARigidFoundation", input + "beam.xml", {"Mesh->Cells={160, 32}", "Contact->Yield Stress=inf"}},
    {"HalfCylinder", input + "hertz.xml", tight_and({"Mesh->Size Factor=2", "Contact->Yield Stress=50"})},
    {"ManufacturedP2", input + "manufactured.xml", tight_and({"Mesh->Element=P2", "Mesh->Cells={48, 16}"})},
    {"BlockInACorner",
     decks + "block.xml",
     {"Traction->top->Y=0", "Dirichlet->left->Side=right", "Dirichlet->left->X=-0.001", "Dirichlet->right->X=-0.001",
      "Dirichlet->top->Y=-0.003", "Contact->Sides->left->Yield Stress=inf"}},
    {"BlockHeldByContact", decks + "block.xml", {"Contact->Gap=0.1", "Traction->top->Y=-4-2*cos(pi*x)"}},
    {"Wedge", decks + "vee.xml", {}},
    {"TwoMaterials", decks + "glued.xml", {"Adapt->Target Relative Error=0"}},
    {"DiscInPlaneStress", input + "hertz.xml", tight_and({"Mesh->Size Factor=2", "Kinematics=plane stress"})},
    {"AxisymmetricBall", input + "ball_axisymmetric.xml",
     tight_and({"Mesh->Size Factor=2", "Contact->Yield Stress=100"})},
    {"CubeUnderABall", decks + "sphere.xml", tight_and({"Contact->Yield Stress=2e4"})},
    {"BlockOfP1", input + "block.xml", tight_and({"Mesh->Element=P1", "Mesh->Cells={8,8,4}"})},
    // Coarser meshes have too few cells for three ranks, and are on fewer.
    {"BlockOfP2", input + "block.xml", tight_and({"Mesh->Element=P2", "Mesh->Cells={6,6,3}"})},
    {"BlockOfQ2", input + "block.xml", tight_and({"Mesh->Element=Q2", "Mesh->Cells={6,6,3}"})},
    {"PlateOfTwoBlocks", decks + "plate_of_two_blocks.xml", {}},
    {"Ball", input + "ball.xml", tight_and({"Mesh->Size Factor=2", "Contact->Yield Stress=100"})},
    {"RefinedHalfCylinder", input + "hertz.xml",
     tight_and({"Mesh->Size Factor=8", "Mesh->Refinements=2", "Contact->Yield Stress=50"})},
    {"RefinedBall", input + "ball.xml",
     tight_and({"Mesh->Size Factor=4", "Mesh->Refinements=1", "Contact->Yield Stress=100"})},
    {"RefinedBallOfOrderOne", input + "ball.xml",
     tight_and({"Mesh->Order=1", "Mesh->Size Factor=4", "Mesh->Refinements=2", "Contact->Yield Stress=100"})}};

/// Of all ranks, by the ids of nodes: those of the solution are its components, those of contact (side, pressure).
struct Fields {
  std::map<std::pair<GO, int>, double> displacement, pressure;
};

Fields own_fields(const Solution &s)
{
  Fields fields;
  const mesh::Mesh &mesh = *s.discretization.mesh;
  const int dim = mesh.dim();
  const auto u = s.u->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
    for (int k = 0; k < dim; ++k) fields.displacement[{mesh.node_id(n), k}] = u(dim * n + k, 0);
  const auto &contact = s.step.contact;
  const auto node = to_host(contact.node);
  const auto p = to_host(s.contact.pressure);
  for (int side = 0; side < contact.num_sides(); ++side)
    for (LO i = contact.first(side); i < contact.first(side + 1); ++i)
      fields.pressure[{mesh.node_id(node(i)), side}] = p(i);
  return fields;
}

/// Each of a rank's values is that of the only rank; together there are as many.
void expect_same(const std::map<std::pair<GO, int>, double> &mine, const std::map<std::pair<GO, int>, double> &serial,
                 const double tolerance, const Comm &comm)
{
  EXPECT_EQ(sum_all(comm, static_cast<GO>(mine.size())), static_cast<GO>(serial.size()));
  double largest = 0;
  for (const auto &[key, value] : serial) largest = std::max(largest, std::abs(value));
  ASSERT_GT(largest, 0);
  for (const auto &[key, value] : mine) {
    const auto found = serial.find(key);
    ASSERT_NE(found, serial.end()) << "node " << key.first;
    EXPECT_NEAR(value, found->second, tolerance * largest) << "node " << key.first << ", " << key.second;
  }
}

class Ranks : public testing::TestWithParam<Case>
{
};
INSTANTIATE_TEST_SUITE_P(Scenes, Ranks, testing::ValuesIn(cases), [](const auto &info) { return info.param.name; });

TEST_P(Ranks, FindTheSolutionOfOneRank)
{
  const auto world = Tpetra::getDefaultComm();
  ASSERT_GT(world->getSize(), 1);
  const RCP<const Comm> alone = world->split(world->getRank(), 0);
  const Solution shared = run_scene(GetParam().deck, GetParam().assignments, world),
                 own = run_scene(GetParam().deck, GetParam().assignments, alone);
  ASSERT_TRUE(shared.uzawa.converged) << shared.uzawa.reason;
  ASSERT_TRUE(own.uzawa.converged) << own.uzawa.reason;
  EXPECT_NEAR(shared.energy, own.energy, 1e-10 * std::abs(own.energy));
  EXPECT_NEAR(shared.energy_norm_squared, own.energy_norm_squared, 1e-8 * own.energy_norm_squared);
  EXPECT_EQ(shared.uzawa.iterations, own.uzawa.iterations);
  EXPECT_NEAR(shared.uzawa.newton_iterations[0], own.uzawa.newton_iterations[0], 1);
  const Fields mine = own_fields(shared), serial = own_fields(own);
  expect_same(mine.displacement, serial.displacement, 1e-8, *world);
  expect_same(mine.pressure, serial.pressure, 1e-8, *world);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(shared.contact.total.force[k], own.contact.total.force[k], 1e-8 * own.contact.total.max_pressure);
}

} // namespace
} // namespace ranks_test
