// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/canonical_order.hpp"
#include "run_scene.hpp"

#include <gtest/gtest.h>

// Adaptive meshes do not depend on the number of ranks.

namespace adapt_ranks_test
{
namespace
{

using namespace rpc;

/// The meshes of an adaptive run and what they came to.
struct Meshes {
  std::vector<std::vector<double>> coords; // of each mesh on rank 0, by node id
  std::vector<double> estimate;
  bool reached = false;

  Meshes(const std::string &deck, const std::vector<std::string> &scene, const RCP<const Comm> &comm)
  {
    std::ostream nowhere(nullptr);
    const auto keep = [&](const Scene &, Solution &s) {
      const mesh::Mesh &mesh = *s.discretization.mesh;
      const auto at = to_host(mesh.coords);
      std::vector<double> own;
      for (LO n = 0; n < mesh.num_owned_nodes(); ++n)
        for (int i = 0; i < mesh.dim(); ++i) own.push_back(at(n, i));
      const mesh::CanonicalOrder order(mesh.owned_nodes->getComm(), mesh.node_id, "node");
      coords.push_back(order.gather(own.data(), mesh.dim()));
      estimate.push_back(relative_estimate(s));
    };
    const Solution last = solve(read_scene(RPC_TEST_DECKS "/" + deck, scene), comm, nowhere, keep);
    reached = last.adaptation->reached;
  }
};

void expect_same_meshes(const std::string &deck, const std::vector<std::vector<std::string>> &scenes,
                        const std::size_t least_meshes = 4)
{
  const auto world = Tpetra::getDefaultComm();
  ASSERT_GT(world->getSize(), 1);
  const auto alone = world->split(world->getRank(), 0);
  for (const auto &scene : scenes) {
    SCOPED_TRACE(deck + (scene.empty() ? "" : ", " + scene[0]));
    const Meshes here(deck, scene, world);
    if (world->getRank() > 0) continue; // rank 0 has the coordinates of both, and the estimate is the same on all ranks
    const Meshes serial(deck, scene, alone);
    EXPECT_TRUE(serial.reached);
    EXPECT_GE(serial.estimate.size(), least_meshes);
    EXPECT_EQ(here.estimate.size(), serial.estimate.size()); // no end of the test: other ranks go on to the next scene
    if (here.estimate.size() != serial.estimate.size()) continue;
    for (std::size_t k = 0; k < here.estimate.size(); ++k) {
      EXPECT_NEAR(here.estimate[k] / serial.estimate[k], 1, 1e-6) << "mesh " << k + 1;
      EXPECT_EQ(here.coords[k], serial.coords[k]) << "mesh " << k + 1;
    }
  }
}

TEST(AdaptiveRanks, GiveABracketTheSameMeshes)
{
  // One with a tip that bears nothing, whose errors are rounding, one that yields, and one that only bends.
  expect_same_meshes(
      "bracket.xml",
      {{}, {"Contact->Yield Stress=5"}, {"Traction->end->Y=-0.5", "Dirichlet->top->Y=0", "Contact->Gap=10"}});
}

TEST(AdaptiveRanks, GiveGluedBlocksTheSameMeshes)
{
  expect_same_meshes("glued.xml", {{}, {"Contact->Yield Stress=inf", "Material->Blocks->hard->Young's Modulus=2e4"}});
}

TEST(AdaptiveRanks, GiveABeamOfQuadrilateralsTheSameMeshes)
{
  expect_same_meshes("../../../input/beam_adaptive.xml", {{"Mesh->Element=Q2", "Adapt->Target Relative Error=0.001"}});
}

TEST(AdaptiveRanks, GiveBodiesInSpaceTheSameMeshes)
{
  // Of a box whose hexahedra give way to tetrahedra, and of a ball; by gmsh and nested.
  expect_same_meshes("../../../input/block_adaptive.xml",
                     {{"Adapt->Target Relative Error=0.08", "Adapt->Meshes=nested"},
                      {"Adapt->Target Relative Error=0.1", "Adapt->Meshes=gmsh"},
                      {"Adapt->Target Relative Error=0.15", "Mesh->Element=P1", "Mesh->Cells={4,4,2}"}},
                     3);
  expect_same_meshes("../../../input/ball_adaptive.xml",
                     {{"Adapt->Target Relative Error=0.06", "Contact->Yield Stress=100"},
                      {"Adapt->Target Relative Error=0.06", "Adapt->Meshes=nested"}},
                     3);
}

TEST(AdaptiveRanks, GiveABodyFromAMshFileTheSameMeshes)
{
  expect_same_meshes("octant_msh.xml", {{"Adapt->Target Relative Error=0.3"}}, 3);
}

TEST(AdaptiveRanks, GiveNestedMeshesOfThePlaneTheSame)
{
  expect_same_meshes("bracket.xml", {{"Adapt->Meshes=nested"}});
  expect_same_meshes("../../../input/beam_adaptive.xml", {{"Adapt->Meshes=nested"}});
}

TEST(AdaptiveRanks, GiveStepsOnSpringsThatYieldTheSameMeshes)
{
  // Friction fills blocks of the stiffness that are exactly 0 without it, of some ranks.
  expect_same_meshes("springs.xml", {{}});
}

} // namespace
} // namespace adapt_ranks_test
