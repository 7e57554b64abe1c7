#include "rpc/adapt/observed_error.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace
{

using rpc::adapt::observed_error;

TEST(ObservedError, IsExactForAQuantityWhoseErrorIsProportionalToTheEstimate)
{
  // Q_k = Q + C eta_k with C = 3.
  EXPECT_NEAR(observed_error({3 * (0.4 - 0.1)}, {0.4, 0.1}), 3 * 0.1, 1e-15);
  EXPECT_NEAR(observed_error({3 * (0.4 - 0.1), 3 * (0.1 - 0.05)}, {0.4, 0.1, 0.05}), 3 * 0.05, 1e-15);
}

TEST(ObservedError, BoundsThatOfAQuantityWhichConvergesFaster)
{
  const auto q = [](const double eta) { return 7 + 5 * eta * eta; };
  const double error = observed_error({q(0.4) - q(0.2), q(0.2) - q(0.1)}, {0.4, 0.2, 0.1});
  EXPECT_GT(error, q(0.1) - 7);
  EXPECT_LT(error, 10 * (q(0.1) - 7));
}

TEST(ObservedError, IsNotFooledByAChangeThatIsSmallByChance)
{
  EXPECT_NEAR(observed_error({0.2, 1e-9}, {0.4, 0.2, 0.1}), 0.1, 1e-15); // half of what the pair before showed
}

TEST(ObservedError, IsUnknownOfOneMeshAndFiniteWhereTheEstimateDoesNotFall)
{
  EXPECT_TRUE(std::isnan(observed_error({}, {0.4})));
  EXPECT_TRUE(std::isfinite(observed_error({1}, {0.4, 0.4})));
  EXPECT_GE(observed_error({1}, {0.4, 0.4}), 1);
}

} // namespace
