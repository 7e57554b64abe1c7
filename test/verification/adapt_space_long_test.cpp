// SPDX-License-Identifier: BSD-3-Clause
#include "adapt_space_scenes.hpp"

// What takes as long as all of adapt_space, and differs from it by the foundation or by how meshes are refined.

namespace adapt_space_long_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

TEST(AdaptiveBallOnAYieldingFoundation, InSpaceHasTheForceThePressureAndTheRadiusThatWereAskedFor)
{
  expect_force_pressure_and_radius(balls[1]);
}

TEST(AdaptiveBlockOfNestedMeshes, GradesItsClampedEdgesWithFewerUnknownsThanUniformMeshes)
{
  expect_fewer_unknowns_than_uniform_meshes("nested");
}

TEST(AdaptiveStepsOnNestedMeshes, InSpaceKeepDentsAndDissipation)
{
  expect_dents_and_dissipation_to_stay("nested");
}

} // namespace
} // namespace adapt_space_long_test
