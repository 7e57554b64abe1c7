// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/jacobi.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace jacobi_test
{
namespace
{

using namespace rpc;

/// Largest entry of V^T V - I, and of A - sum of the pairs over the largest entry of A.
template <int Dim>
void expect_pairs_of(const double (&a)[Dim][Dim], const EigenPairs<Dim> &pairs)
{
  double largest = 0;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) largest = std::max(largest, std::abs(a[i][j]));
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) {
      double product = 0, sum = 0;
      for (int k = 0; k < Dim; ++k) {
        product += pairs.vector[i][k] * pairs.vector[j][k];
        sum += pairs.value[k] * pairs.vector[k][i] * pairs.vector[k][j];
      }
      EXPECT_NEAR(product, i == j, 4e-15) << i << j;
      EXPECT_NEAR(sum, a[i][j], 4e-15 * largest) << i << j;
    }
}

TEST(Jacobi, FindsThePairsOfASmallMatrix)
{
  const double plane[2][2] = {{2, 1}, {1, 2}};
  const auto two = eigen_pairs(plane);
  expect_pairs_of(plane, two);
  EXPECT_NEAR(std::min(two.value[0], two.value[1]), 1, 1e-15);
  EXPECT_NEAR(std::max(two.value[0], two.value[1]), 3, 1e-15);
  const double space[3][3] = {{2, -1, 0}, {-1, 2, -1}, {0, -1, 2}};
  auto three = eigen_pairs(space);
  expect_pairs_of(space, three);
  std::sort(three.value, three.value + 3);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(three.value[k], 2 - 2 * std::cos((k + 1) * std::acos(-1.) / 4), 4e-15);
  const double indefinite[3][3] = {{0, 3, -1}, {3, 0, 2}, {-1, 2, 1e-3}};
  expect_pairs_of(indefinite, eigen_pairs(indefinite));
}

TEST(Jacobi, LeavesADiagonalMatrixAsItIs)
{
  const double a[3][3] = {{3, 0, 0}, {0, -1e20, 0}, {0, 0, 3}};
  const auto pairs = eigen_pairs(a);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(pairs.value[k], a[k][k]);
    for (int l = 0; l < 3; ++l) EXPECT_EQ(pairs.vector[k][l], k == l);
  }
}

TEST(Jacobi, OfOneDirectionHasOneEigenvalue)
{
  const double m[3] = {0.48, 0.36, -0.8};
  double a[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a[i][j] = 1e9 * m[i] * m[j];
  auto pairs = eigen_pairs(a);
  expect_pairs_of(a, pairs);
  std::sort(pairs.value, pairs.value + 3);
  EXPECT_NEAR(pairs.value[0], 0, 1e-6);
  EXPECT_NEAR(pairs.value[1], 0, 1e-6);
  EXPECT_NEAR(pairs.value[2], 1e9, 1e-6);
}

} // namespace
} // namespace jacobi_test
