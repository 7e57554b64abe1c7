// SPDX-License-Identifier: BSD-3-Clause
#include "host_program.hpp"

#include "scene.hpp"

#include <cstdlib>
#include <gtest/gtest.h>

namespace host_program_test
{
namespace
{

Teuchos::ParameterList scene(const std::string &deck, const std::vector<std::string> &assignments = {})
{
  return rpc::read_parameters(std::string(RPC_TEST_DECKS) + "/../../../input/" + deck, assignments);
}

/// By hand: nodes of the box times the dimension, nodes between vertices of order 2 included.
TEST(HostProgram, ForeseesUnknownsOfBoxes)
{
  EXPECT_EQ(rpc::foreseen_unknowns(scene("beam.xml", {"Mesh->Cells={10, 2}"})), 11 * 3 * 2);
  EXPECT_EQ(rpc::foreseen_unknowns(scene("beam.xml", {"Mesh->Cells={10, 2}", "Mesh->Element=P2"})), 21 * 5 * 2);
  EXPECT_EQ(rpc::foreseen_unknowns(scene("block.xml", {"Mesh->Cells={4, 3, 2}"})), 9 * 7 * 5 * 3); // Q2
  EXPECT_EQ(rpc::foreseen_unknowns(scene("hertz.xml")), -1);                                       // gmsh's
}

/// Adapted meshes may have as many as the deck allows.
TEST(HostProgram, ForeseesTheLargestOfAdaptedMeshes)
{
  EXPECT_EQ(rpc::foreseen_unknowns(scene("beam_adaptive.xml", {"Adapt->Max Dofs=70000"})), 70000);
}

TEST(HostProgram, TakesMoreUnknownsWithMoreThreads)
{
  EXPECT_EQ(rpc::most_unknowns_of_host(1, false), 50000);
  EXPECT_EQ(rpc::most_unknowns_of_host(16, false), 263901);
  EXPECT_EQ(rpc::most_unknowns_of_host(64, false), 263901); // the memory of a host serves no more
  EXPECT_EQ(rpc::most_unknowns_of_host(16, true), 26390);
}

} // namespace
} // namespace host_program_test
