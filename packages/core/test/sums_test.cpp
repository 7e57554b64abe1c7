// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/sums.hpp"

#include <gtest/gtest.h>

namespace sums_test
{
namespace
{

using namespace rpc;

/// Sums of 1/(n + 1), of n, and of nothing.
std::vector<double> sums_to(const LO items)
{
  return sums_over(
      "sums_test::sums", device_range(items), 3, KOKKOS_LAMBDA(const LO n, double sum[]) {
        sum[0] += 1. / (n + 1);
        sum[1] += n;
      });
}

TEST(Sums, AreThoseOfEachItem)
{
  EXPECT_EQ(sums_to(0), (std::vector<double>{0, 0, 0}));
  constexpr LO items = 1000;
  double harmonic = 0;
  for (LO n = 0; n < items; ++n) harmonic += 1. / (n + 1);
  const auto sums = sums_to(items);
  EXPECT_NEAR(sums[0], harmonic, 1e-13);
  EXPECT_EQ(sums[1], 0.5 * items * (items - 1));
  EXPECT_EQ(sums[2], 0);
}

TEST(Sums, HaveTheSameBitsEachTime)
{
  constexpr LO items = 100000; // so many that threads work side by side
  const auto first = sums_to(items);
  for (int again = 0; again < 20; ++again) EXPECT_EQ(sums_to(items), first);
}

} // namespace
} // namespace sums_test
