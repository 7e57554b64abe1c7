// SPDX-License-Identifier: BSD-3-Clause
#include "run_scene.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace sphere_test
{
namespace
{

using namespace rpc;

const std::string sphere = std::string(RPC_TEST_DECKS) + "/sphere.xml";

/// Points of the top from which the vertical meets the sphere, of n x n cells.
GO facing(const int n)
{
  GO count = 0;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) count += std::hypot(double(i) / n - 0.5, double(j) / n - 0.5) <= 0.6;
  return count;
}

TEST(Sphere, PressesTheCubeWhoseCornersItMisses)
{
  struct Expected {
    const char *cells;
    int n;
    double force; // with corners that cannot touch either [N]
  };
  for (const Expected &expected : {Expected{"{8,8,8}", 8, 165.482}, Expected{"{16,16,16}", 16, 232.356}}) {
    const Solution s = run_scene(sphere, {std::string("Mesh->Cells=") + expected.cells});
    ASSERT_TRUE(s.uzawa.converged) << s.uzawa.reason;
    EXPECT_NEAR(s.contact.total.force[2], -expected.force, 1e-5 * expected.force);
    EXPECT_NEAR(s.contact.total.force[0], 0, 1e-7 * expected.force);
    const auto &contact = s.step.contact;
    EXPECT_EQ(contact.num_total, facing(expected.n));
    EXPECT_EQ(contact.num_total + contact.num_missing, (expected.n + 1) * (expected.n + 1));
    const double held = std::max_element(s.reactions.begin(), s.reactions.end(), [](const auto &a, const auto &b) {
                          return a[2] < b[2];
                        })->at(2);
    EXPECT_NEAR(held, expected.force, 1e-5 * expected.force); // the bottom bears it
  }
}

} // namespace
} // namespace sphere_test
