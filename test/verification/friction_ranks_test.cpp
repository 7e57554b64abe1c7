// SPDX-License-Identifier: BSD-3-Clause
#include "friction_scene.hpp"

#include <map>

// Several ranks find what one rank finds.

namespace friction_ranks_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

struct Case {
  const char *name, *deck;
  Assignments assignments;
};
const Assignments sheared_block =
    joined(block_in_space, {"Dirichlet->top->Z=-0.01", "Dirichlet->top->Y=0.01*(t-1)^2",
                            "Contact->Friction Coefficient=0.3", "Dirichlet->top->X=(t < 2.5 ? 0.01*(t-1) : 0.005)"});
const Case cases[] = {{"PlaneInAllStates", "cantilever_coulomb", {"Mesh->Cells={48, 16}"}},
                      {"PlaneOfP2", "cantilever_coulomb", {"Mesh->Cells={24, 8}", "Mesh->Element=P2"}},
                      {"PlateHeldByContact", "greco", {}},
                      {"Wedge", "wedge", {}},
                      {"PushedAlmostToTheLimit", "push", {"Traction->left->X=" + text(0.999 * 0.3 * 2 * 12.345)}},
                      {"SpaceTresca", "block_tresca", {"Mesh->Cells={8, 6, 4}"}},
                      {"SpaceCoulomb",
                       "block_tresca",
                       {"Mesh->Cells={8, 6, 4}", "Contact->Friction Bound=0", "Contact->Friction Coefficient=0.3"}},
                      {"SpaceOfP2",
                       "block_tresca",
                       {"Mesh->Cells={6, 4, 3}", "Mesh->Element=P2", "Contact->Friction Bound=0",
                        "Contact->Friction Coefficient=0.3", "Nested Iteration->Enabled=false"}},
                      {"StepsInThePlane",
                       "loop",
                       {"Mesh->Cells={16, 8}", "Traction->left->X=0", "Traction->left->Y=0", "Traction->right->X=0",
                        "Traction->right->Y=0", "Contact->Yield Stress=14", "Steps->Times={1, 1.5, 2, 2.5, 3}"}},
                      {"StepsInSpace", "loop", sheared_block}};

class FrictionRanks : public testing::TestWithParam<Case>
{
};
INSTANTIATE_TEST_SUITE_P(Scenes, FrictionRanks, testing::ValuesIn(cases),
                         [](const auto &info) { return std::string(info.param.name); });

TEST_P(FrictionRanks, FindTheSolutionOfOneRank)
{
  const auto world = Tpetra::getDefaultComm();
  ASSERT_GT(world->getSize(), 1);
  const RCP<const Comm> alone = world->split(world->getRank(), 0);
  const Assignments deck = joined(tight, GetParam().assignments);
  const Solution shared = run_scene(friction_deck(GetParam().deck), deck, world),
                 own = run_scene(friction_deck(GetParam().deck), deck, alone);
  ASSERT_TRUE(shared.uzawa.converged) << shared.uzawa.reason;
  ASSERT_TRUE(own.uzawa.converged) << own.uzawa.reason;
  const auto &a = shared.contact.total, &b = own.contact.total;
  const double force = std::hypot(b.force[0], b.force[1], b.force[2]);
  EXPECT_NEAR(shared.energy, own.energy, 1e-10 * std::abs(own.energy));
  EXPECT_NEAR(shared.energy_norm_squared, own.energy_norm_squared, 1e-10 * own.energy_norm_squared);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a.force[k], b.force[k], 1e-10 * force);
  EXPECT_NEAR(a.friction_work, b.friction_work, 1e-9 * b.friction_work + 1e-12 * own.energy_norm_squared);
  ASSERT_EQ(shared.history.size(), own.history.size());
  for (std::size_t n = 0; n < own.history.size(); ++n) {
    const auto &one = shared.history[n], &other = own.history[n];
    EXPECT_EQ(one.parts, other.parts);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(one.contact.force[k], other.contact.force[k], 1e-9 * force);
    EXPECT_NEAR(one.energies.friction, other.energies.friction, 1e-9 * other.energies.largest());
    EXPECT_NEAR(one.energies.dissipated, other.energies.dissipated, 1e-9 * other.energies.largest());
  }
  const auto points = contact_points(shared), serial = contact_points(own);
  EXPECT_LT(difference(points, serial), 1e-8);
  double most = 0;
  for (const ContactPoint &point : serial)
    most = std::max(most, std::hypot(point.slip[0], point.slip[1], point.slip[2]));
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(points[i].slip[k], serial[i].slip[k], 1e-8 * most);
  const FrictionCounts n = friction_counts(points), m = friction_counts(serial);
  EXPECT_EQ(n.stick, m.stick);
  EXPECT_EQ(n.slip, m.slip);
  EXPECT_GT(m.slip, 0);
}

} // namespace
} // namespace friction_ranks_test
