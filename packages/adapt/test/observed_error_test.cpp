#include "rpc/adapt/observed_error.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace observed_error_test
{
namespace
{

using rpc::adapt::observed_error;
using rpc::adapt::unsettled;

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

TEST(Unsettled, IsASequenceWhoseChangesDoNotFallWithTheEstimate)
{
  const std::vector<double> eta = {0.4, 0.1, 0.025};
  EXPECT_TRUE(unsettled({1, 2}, eta, 0));            // like 1 / eta^(1/2)
  EXPECT_TRUE(unsettled({1, 1}, eta, 0));            // like log(1 / eta)
  EXPECT_FALSE(unsettled({1, 0.25}, eta, 0));        // like eta
  EXPECT_FALSE(unsettled({1, 0.06}, eta, 0));        // like eta^2
  EXPECT_FALSE(unsettled({1, 0.9}, {3, 2, 1.5}, 0)); // the estimate itself hardly falls
  EXPECT_TRUE(unsettled({1, 1.1}, {3, 2, 1.5}, 0));
}

TEST(Unsettled, IsNotToldByOneChangeOrByOnesBelowTheResolution)
{
  EXPECT_FALSE(unsettled({}, {1}, 0));
  EXPECT_FALSE(unsettled({1}, {1, 0.1}, 0));
  EXPECT_FALSE(unsettled({1, 2}, {1, 0.3, 0.1}, 2));
}

} // namespace
} // namespace observed_error_test
