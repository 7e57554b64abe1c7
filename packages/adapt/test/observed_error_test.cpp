// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/adapt/observed_error.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace observed_error_test
{
namespace
{

using rpc::adapt::error_over_span;
using rpc::adapt::grows_without_limit;
using rpc::adapt::hardly_finer;
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

TEST(ErrorOverSpan, IsWhatSmallStepsShowTogether)
{
  // Q_k = 3 eta_k from five meshes whose estimates fall by little, with a last step that is small by chance.
  const std::vector<double> eta = {0.1, 0.08, 0.06, 0.05, 0.04};
  EXPECT_NEAR(error_over_span({3 * 0.06, 3 * 0.04, 3 * 0.02, 3 * 0.01}, eta), 3 * 0.04, 1e-15);
  EXPECT_NEAR(error_over_span({3 * 0.06, 3 * 0.04, 3 * 0.02, 1e-9}, eta), 3 * 0.04, 1e-15);
  EXPECT_EQ(error_over_span({5., 5.}, {0.4, 0.3, 0.05}), 0); // the next one has fallen by more than a span
}

TEST(HardlyFiner, AreMeshesWhoseEstimateHasNotHalved)
{
  EXPECT_TRUE(hardly_finer({0.1}));
  EXPECT_TRUE(hardly_finer({0.1, 0.077}));
  EXPECT_TRUE(hardly_finer({0.08, 0.1, 0.06}));
  EXPECT_FALSE(hardly_finer({0.1, 0.049}));
  EXPECT_FALSE(hardly_finer({0.1, 0.08, 0.06, 0.049}));
}

std::vector<double> of(const std::vector<double> &eta, double (*value)(double))
{
  std::vector<double> values;
  for (const double e : eta) values.push_back(value(e));
  return values;
}

TEST(GrowsWithoutLimit, DoesALogarithmAndNoPowerFromTheFirstOn)
{
  const std::vector<std::vector<double>> sequences = {
      {0.4, 0.1, 0.02}, {0.5, 0.2, 0.1, 0.04}, {0.5, 0.1, 0.05, 0.01, 0.002}};
  for (const auto &eta : sequences) {
    EXPECT_TRUE(grows_without_limit(of(eta, [](const double e) { return -std::log(e); }), eta, 0));
    EXPECT_TRUE(grows_without_limit(of(eta, [](const double e) { return std::pow(e, -0.5); }), eta, 0));
    EXPECT_FALSE(grows_without_limit(of(eta, [](const double e) { return 1 - e; }), eta, 0));
    EXPECT_FALSE(grows_without_limit(of(eta, [](const double e) { return 1 - e * e; }), eta, 0));
    EXPECT_FALSE(grows_without_limit(of(eta, [](const double e) { return std::log(e); }), eta, 0)); // it falls
    EXPECT_FALSE(
        grows_without_limit(of(eta, [](const double e) { return -std::log(e); }), eta, 9)); // by less than is resolved
  }
  EXPECT_FALSE(grows_without_limit({1, 2}, {0.4, 0.1}, 0)); // two meshes do not tell
}

TEST(GrowsWithoutLimit, DoesThePressureAtTheTipOfACone)
{
  const std::vector<double> eta = {0.538, 0.114, 0.0237, 0.0066, 0.0023, 0.0009}, p = {191, 321, 566, 702, 859, 882};
  for (std::size_t n = 3; n <= eta.size(); ++n)
    EXPECT_TRUE(grows_without_limit({p.begin(), p.begin() + n}, {eta.begin(), eta.begin() + n}, eta[n - 1] * p[n - 1]))
        << n;
}

} // namespace
} // namespace observed_error_test
