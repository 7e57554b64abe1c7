// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/error.hpp"
#include "run_scene.hpp"
#include "scratch_file.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <utility>

// Guaranteed bounds of bodies of hexahedra, doc/bounds.md (13.9c) to (13.9e).

namespace error_bound_hexahedra_test
{
namespace
{

using namespace rpc;

using Assignments = std::vector<std::string>;

const std::string decks = std::string(RPC_TEST_DECKS) + "/";

Solution bounded(Assignments assignments, const std::string &deck = "clamped_block.xml")
{
  assignments.insert(assignments.end(), {"Mesh->Element=Q1", "Adapt->Error Bound=guaranteed"});
  Solution s = run_scene(decks + deck, assignments);
  EXPECT_TRUE(s.bound);
  EXPECT_EQ(s.bound->missing, "");
  return s;
}

TEST(ErrorBoundOfHexahedra, HoldsTheEnergyOfAFinerMeshAndIsNear)
{
  // Open, closed and yielding parts; loads that are not linear; a force per volume; sides that slide; a foundation that hardens, and rubs.
  const Assignments scenes[] = {
      {"Contact->Yield Stress=inf"},
      {"Contact->Yield Stress=6", "Contact->Gap=0.02*x - 0.01"},
      {"Contact->Yield Stress=8", "Traction->front->Z=-6*sin(1 + 0.2*x*y)", "Body Force->Z=-3", "Body Force->X=2"},
      {"Traction->front->X=2", "Dirichlet->bottom->Y=0", "Dirichlet->top->Y=0", "Contact->Gap=0.001"},
      {"Contact->Yield Stress=2", "Contact->Hardening=300", "Contact->Stiffness=3e3", "Contact->Friction Bound=0.3"}};
  for (const Assignments &scene : scenes) {
    SCOPED_TRACE(scene.back());
    const Solution s = bounded(scene);
    Assignments finer = scene;
    finer.insert(finer.end(), {"Mesh->Element=P2", "Mesh->Cells={8, 6, 4}", "Adapt->Error Bound=estimated"});
    const Solution fine = run_scene(decks + "clamped_block.xml", finer);
    ASSERT_TRUE(fine.estimate);
    const double rubbed = fine.contact.total.friction_work, left = fine.estimate->total() / 2,
                 true_error = s.bound->upper - (fine.energy + rubbed - left);
    EXPECT_LT(s.bound->lower, fine.energy + rubbed - left);
    EXPECT_GT(s.bound->upper, fine.energy + rubbed);
    EXPECT_LT(s.bound->upper - s.bound->lower, 1.6 * 1.6 * true_error);
    EXPECT_LT(s.bound->moved, 0.25 * s.bound->energy_norm);
    EXPECT_GT(s.bound->moved, 1e-3 * s.bound->energy_norm); // flat on the halves of faces in contact
    EXPECT_LT(s.bound->imbalance, 1e-11);
    ASSERT_EQ(s.bound->steps.size(), 13u);
    for (int k = 0; k < 12; ++k) EXPECT_LT(s.bound->steps[k + 1], s.bound->steps[k]);
    EXPECT_EQ(static_cast<LO>(s.bound->squared.extent(0)), s.discretization.mesh->num_owned_cells);
    double sum = 0;
    const auto parts = to_host(s.bound->squared);
    for (std::size_t c = 0; c < parts.extent(0); ++c) sum += parts(c);
    EXPECT_NEAR(sum, s.bound->energy_norm * s.bound->energy_norm, 1e-10 * sum);
  }
}

TEST(ErrorBoundOfHexahedra, HoldsAnEvenStressWhoseEnergyTheElementsHave)
{
  for (const char *limit : {"inf", "2"}) {
    SCOPED_TRACE(limit);
    const Solution s = bounded({std::string("Contact->Yield Stress=") + limit}, "even_block_in_space.xml");
    EXPECT_GT(s.energy_norm_squared, 1e-6);
    EXPECT_NEAR(s.bound->upper, s.energy, 1e-12 * s.energy_norm_squared);
    EXPECT_LT(s.bound->moved, 1e-9 * s.bound->energy_norm);
    EXPECT_GE(s.bound->steps.back(), 0);
    EXPECT_LT(s.bound->steps.back(), 0.02 * s.energy_norm_squared);
  }
}

TEST(ErrorBoundOfHexahedra, IsRefusedForGapsAndDisplacementsThatBendBetweenTheHalvesOfAFace)
{
  const auto refused = [](const Assignments &more, const std::string &part) {
    Assignments assignments = {"Mesh->Element=Q1", "Adapt->Error Bound=guaranteed"};
    assignments.insert(assignments.end(), more.begin(), more.end());
    try {
      run_scene(decks + "clamped_block.xml", assignments);
      ADD_FAILURE() << "not refused: " << part;
    } catch (const Error &error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused({"Contact->Gap=0.01*x*y"}, "another than between its nodes");
  refused({"Dirichlet->left->X=0.001*y*z"}, "linear on each triangle");
}

TEST(ErrorBoundOfForcesInSpace, HoldsTheForceOfAFinerMesh)
{
  for (const std::string element : {"P1", "Q1"})
    for (const Assignments &scene : {Assignments{"Contact->Yield Stress=6", "Body Force->Z=-3"},
                                     Assignments{"Contact->Friction Bound=0.3", "Contact->Yield Stress=3"}}) {
      SCOPED_TRACE(element + ", " + scene[0]);
      Assignments deck = scene;
      Assignments own = deck;
      own.insert(own.end(), {"Mesh->Element=" + element, "Adapt->Error Bound=guaranteed"});
      deck.insert(deck.end(), {"Mesh->Element=P2", "Mesh->Cells={8, 6, 4}"});
      const Solution s = run_scene(decks + "clamped_block.xml", own),
                     fine = run_scene(decks + "clamped_block.xml", deck);
      ASSERT_EQ(s.bound->contact_force.size(), 1u);
      const bound::ForceBound &force = s.bound->contact_force[0];
      ASSERT_EQ(force.missing, "");
      const double there = std::abs(fine.contact.total.force[2]);
      EXPECT_LT(force.lower, there);
      EXPECT_GE(force.upper, there * (1 - 1e-9)); // a side that yields everywhere has the largest force
      EXPECT_LE(force.upper - force.lower, there * (1 + 1e-9));
    }
}

TEST(ErrorBoundOfForcesInSpace, IsTheForceWhereTheElementsHaveTheSolution)
{
  // 3 m^2 under 2.55 Pa, or 2 Pa where the foundation yields.
  for (const std::string element : {"P1", "Q1"})
    for (const auto &[limit, force] : {std::pair{"inf", 7.65}, std::pair{"2", 6.}}) {
      SCOPED_TRACE(element + ", " + limit);
      const Solution s =
          run_scene(decks + "even_block_in_space.xml", {std::string("Contact->Yield Stress=") + limit,
                                                        "Mesh->Element=" + element, "Adapt->Error Bound=guaranteed"});
      ASSERT_EQ(s.bound->contact_force.size(), 1u);
      ASSERT_EQ(s.bound->contact_force[0].missing, "");
      const double allowed = element == "P1" ? 1e-4 : 0.1 * force; // stresses of hexahedra are near it
      EXPECT_NEAR(s.bound->contact_force[0].lower, force, allowed);
      EXPECT_NEAR(s.bound->contact_force[0].upper, force, allowed);
      EXPECT_LE(s.bound->contact_force[0].lower, force * (1 + 1e-9));
      EXPECT_GE(s.bound->contact_force[0].upper, force * (1 - 1e-9));
    }
}

// Its corner at (2/3, 1/3, 1/3) lies in the plane of the three beside it, but for a ten-thousandth.
TEST(ErrorBoundOfHexahedra, IsRefusedWhereAPartOfACellIsNearlyFlat)
{
  const test::ScratchFile file("cell.msh", R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
2 1 "back"
2 2 "left"
3 3 "body"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 1 1 0
3 1 0 1
4 0.6667 0.3333 0.3333
5 0 1 0
6 0 0 1
7 1 1 1
8 0 1 1
$EndNodes
$Elements
3
1 3 2 1 0 6 3 7 8
2 3 2 2 0 1 6 8 5
3 5 2 3 0 1 4 2 5 6 3 7 8
$EndElements
)");
  const test::ScratchFile deck("cell.yaml", "cell:\n  Mesh: {Type: gmsh, File: " + file.path() +
                                                "}\n  Material: {Young's Modulus: 1000.0, Poisson's Ratio: 0.3}\n"
                                                "  Dirichlet: {left: {X: 0.0, Y: 0.0, Z: 0.0}}\n"
                                                "  Body Force: {Z: \"1\"}\n  Contact: {Side: back}\n"
                                                "  Adapt: {Error Bound: guaranteed}\n");
  try {
    run_scene(deck.path(), {});
    ADD_FAILURE() << "not refused";
  } catch (const Error &error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    EXPECT_NE(std::string(error.what()).find("times the volume of a sixth of it"), std::string::npos) << error.what();
  }
}

TEST(ErrorBoundOfForcesInSpace, CountsWhatTheNodesOfAHeldEndMayCarry)
{
  // 2 Pa on 3 m^2, where the foundation yields and the bottom prescribes what the body does: w is 0 at the side's end y = 0, 2 m long, and rises
  // over cells of 0.5 m.
  constexpr double force = 6, at_end = 2 * 2 * 0.5 / 2;
  for (const std::string element : {"P1", "Q1"}) {
    SCOPED_TRACE(element);
    const Solution s = run_scene(decks + "even_block_in_space.xml",
                                 {"Contact->Yield Stress=2", "Dirichlet->bottom->Z=-0.00055 - 0.00245*z",
                                  "Mesh->Element=" + element, "Adapt->Error Bound=guaranteed"});
    ASSERT_EQ(s.bound->contact_force.size(), 1u);
    ASSERT_EQ(s.bound->contact_force[0].missing, "");
    const double room = element == "P1" ? 1e-3 : 0.8; // stresses of hexahedra are near it
    EXPECT_NEAR(s.bound->contact_force[0].lower, force - at_end, room);
    EXPECT_LE(s.bound->contact_force[0].lower, force - at_end + 1e-9);
    EXPECT_NEAR(s.bound->contact_force[0].upper, force, 1e-9 * force);
  }
}

TEST(ErrorBoundOfForcesInSpace, IsAsWideAsTheErrorOfTheStress)
{
  // (13.13), (13.14): w is compressed evenly from 1 at the back to 0 at the front, E * 3 m^2 / 1 m = |w|^2.
  constexpr double of_w = 3000;
  for (const std::string element : {"P1", "Q1"}) {
    SCOPED_TRACE(element);
    const Solution s =
        run_scene(decks + "even_block_in_space.xml",
                  {"Traction->right->X=1.5 - z^2", "Mesh->Element=" + element, "Adapt->Error Bound=guaranteed"});
    ASSERT_EQ(s.bound->contact_force.size(), 1u);
    const bound::ForceBound &force = s.bound->contact_force[0];
    ASSERT_EQ(force.missing, "");
    const double b = s.bound->steps.back();
    EXPECT_GT(b, 1e-8);
    EXPECT_GT(force.lower, 0);
    EXPECT_GT(force.upper - force.lower, 2 * std::sqrt(b / 2 * of_w) * (1 - 1e-6)); // of the stress alone
    EXPECT_LT(force.upper - force.lower, 2 * std::sqrt(b * of_w) * (1 + 1e-6));     // of contact alone
  }
}

} // namespace
} // namespace error_bound_hexahedra_test
