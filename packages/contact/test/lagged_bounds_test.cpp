// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/lagged_bounds.hpp"

#include <Tpetra_Core.hpp>
#include <array>
#include <cmath>
#include <gtest/gtest.h>

namespace lagged_bounds_test
{
namespace
{

using namespace rpc;

constexpr LO points = 3; // of each rank

DeviceView<double *> on_device(const std::array<double, points> &values)
{
  const DeviceView<double *> result("values", points);
  const auto host = Kokkos::create_mirror_view(result);
  for (LO i = 0; i < points; ++i) host(i) = values[i];
  Kokkos::deep_copy(result, host);
  return result;
}

/// What a wedge does whose wall leans by less than the friction: the plain iteration s <- G(s) moves away from s = 2, 5, 1, by -1.5 along
/// (1, 2, 1) and by -1.2 along (0, 1, -2).
std::array<double, points> wedge(const DeviceView<double *> &s)
{
  const auto at = to_host(s);
  const double x = at(0) - 2, y = at(1) - 5, z = at(2) - 1;
  const double a = (x + 2 * y + z) / 6, b = (y - 2 * z) / 5, c = (-5 * x + 2 * y + z) / 30; // orthogonal directions
  return {2 - 1.5 * a - 5 * 0.5 * c, 5 - 3 * a - 1.2 * b + 2 * 0.5 * c, 1 - 1.5 * a + 2.4 * b + 0.5 * c};
}

TEST(LaggedBounds, FindTheFixedPointThatThePlainIterationLeaves)
{
  const auto weight = on_device({1, 0.5, 2});
  auto s = on_device({2.2, 5.3, 0.9});
  for (int k = 0; k < 6; ++k) s = on_device(wedge(s));
  EXPECT_GT(std::abs(to_host(s)(0) - 2), 1); // the plain iteration

  contact::LaggedBounds bounds;
  s = on_device({2.2, 5.3, 0.9});
  for (int k = 0; k < 5; ++k) s = bounds.next(*Tpetra::getDefaultComm(), s, on_device(wedge(s)), weight);
  const auto found = to_host(s);
  EXPECT_NEAR(found(0), 2, 1e-8);
  EXPECT_NEAR(found(1), 5, 1e-8);
  EXPECT_NEAR(found(2), 1, 1e-8);
}

TEST(LaggedBounds, BeginWithThePlainIterationAndStayPositive)
{
  contact::LaggedBounds bounds;
  const Comm &comm = *Tpetra::getDefaultComm();
  const auto weight = on_device({1, 1, 1});
  const auto first = to_host(bounds.next(comm, on_device({1, 1, 1}), on_device({2, 0, 3}), weight));
  EXPECT_EQ(first(0), 2);
  EXPECT_EQ(first(1), 0);
  EXPECT_EQ(first(2), 3);
  const auto second = to_host(bounds.next(comm, on_device({2, 0, 3}), on_device({3.5, -0.5, 4}), weight));
  for (LO i = 0; i < points; ++i) EXPECT_GE(second(i), 0);
}

} // namespace
} // namespace lagged_bounds_test
