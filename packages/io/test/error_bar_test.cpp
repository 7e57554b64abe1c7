// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/error_bar.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <regex>

namespace error_bar_test
{
namespace
{

using rpc::io::with_error_bar;

constexpr double none = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();

TEST(ErrorBar, EndsTheDigitsOfTheValue)
{
  EXPECT_EQ(with_error_bar(64.93234, 0.02, "N/m"), "64.932 ± 0.020 N/m (0.031 %)");
  EXPECT_EQ(with_error_bar(64.93234, 0.0077, "N/m"), "64.9323 ± 0.0077 N/m (0.012 %)");
  EXPECT_EQ(with_error_bar(98.294, 9.1, "Pa"), "98.3 ± 9.1 Pa (9.3 %)");
  EXPECT_EQ(with_error_bar(98.294, 12.3, "Pa"), "98 ± 12 Pa (13 %)");
  EXPECT_EQ(with_error_bar(0.00012345, 3e-5, "m"), "0.000123 ± 0.000030 m (24 %)");
  EXPECT_EQ(with_error_bar(0.5, 0.1, ""), "0.50 ± 0.10 (20 %)");
}

TEST(ErrorBar, IsRoundedBeforeItsDigitsCount)
{
  EXPECT_EQ(with_error_bar(5, 0.0996, "m"), "5.00 ± 0.10 m (2 %)");
  EXPECT_EQ(with_error_bar(5, 9.96, "m"), "5 ± 10 m (larger than the value)");
}

TEST(ErrorBar, OfHundredsRoundsTheValueToItsSecondDigit)
{
  EXPECT_EQ(with_error_bar(123456, 1234, "N"), "123500 ± 1200 N (1 %)");
  EXPECT_EQ(with_error_bar(-123456, 123.4, "N"), "-123460 ± 120 N (0.1 %)");
}

TEST(ErrorBar, OfNegativeValuesIsAShareOfTheirSize)
{
  EXPECT_EQ(with_error_bar(-0.213440239, 1.7e-6, "J/m"), "-0.2134402 ± 0.0000017 J/m (0.0008 %)");
  EXPECT_EQ(with_error_bar(-0.001, 0.1, "J"), "0.00 ± 0.10 J (larger than the value)"); // no "-0.00"
}

TEST(ErrorBar, OfHugeAndTinyValuesSharesTheirPowerOfTen)
{
  EXPECT_EQ(with_error_bar(6.4e8, 2.5e7, "Pa"), "(6.40 ± 0.25)e+08 Pa (3.9 %)");
  EXPECT_EQ(with_error_bar(8.02275e-14, 4.7e-13, "m"), "(0.8 ± 4.7)e-13 m (larger than the value)");
  EXPECT_EQ(with_error_bar(-3.25e-7, 1e-9, "J"), "(-3.250 ± 0.010)e-07 J (0.31 %)");
  EXPECT_EQ(with_error_bar(1e300, 1e298, "N"), "(1.000 ± 0.010)e+300 N (1 %)");
}

TEST(ErrorBar, OfZeroHasNoShare)
{
  EXPECT_EQ(with_error_bar(0, 0.12, "Pa"), "0.00 ± 0.12 Pa");
  EXPECT_EQ(with_error_bar(0, none, "Pa"), "0 Pa");
}

TEST(ErrorBar, ThatIsZeroSaysExact)
{
  EXPECT_EQ(with_error_bar(16, 0, "Pa"), "16 Pa (exact)");
}

TEST(ErrorBar, ThatIsRoundingSaysSo)
{
  EXPECT_EQ(with_error_bar(5, 5e-12, "m"), "5 m (to rounding)");
  EXPECT_EQ(with_error_bar({3., -4.}, 1e-12, "N"), "5 N (to rounding), components (3, -4)");
}

TEST(ErrorBar, BelowNineDigitsStandsByItself)
{
  EXPECT_EQ(with_error_bar(5, 5e-9, "m"), "5 ± 5.0e-09 m (1e-07 %)");
  EXPECT_EQ(with_error_bar(5, 1.2e-7, "m"), "5.00000000 ± 0.00000012 m (2.4e-06 %)");
}

TEST(ErrorBar, MayBeMissing)
{
  EXPECT_EQ(with_error_bar(64.93234, none, "N/m"), "64.9323 N/m");
  EXPECT_EQ(with_error_bar(-1.5e-9, none, ""), "-1.5e-09");
  EXPECT_EQ(with_error_bar(none, 0.1, "Pa"), "unknown");
  EXPECT_EQ(with_error_bar(infinite, none, "Pa"), "unknown");
  EXPECT_EQ(with_error_bar(2, infinite, "Pa"), "2 ± inf Pa (larger than the value)");
}

TEST(ErrorBar, OfAVectorHoldsForItsComponents)
{
  EXPECT_EQ(with_error_bar({1e-14, 64.93234}, 0.0077, "N/m"),
            "64.9323 ± 0.0077 N/m (0.012 %), components (0.0000, 64.9323)");
  EXPECT_EQ(with_error_bar({-3., 0., 4.}, 0.1, "N"), "5.00 ± 0.10 N (2 %), components (-3.00, 0.00, 4.00)");
  EXPECT_EQ(with_error_bar({3e8, 4e8}, 1e7, "N"), "(5.00 ± 0.10)e+08 N (2 %), components (3.00, 4.00)e+08");
}

TEST(ErrorBar, OfAVectorMayBeMissingOrTiny)
{
  EXPECT_EQ(with_error_bar({1e-14, 64.93234}, none, "N/m"), "64.9323 N/m, components (0, 64.9323)");
  EXPECT_EQ(with_error_bar({3., 4.}, 1e-9, "N"), "5 ± 1.0e-09 N (2e-08 %), components (3, 4)");
  EXPECT_EQ(with_error_bar({0., 0.}, none, "N"), "0 N");
  EXPECT_EQ(with_error_bar({0., 0.}, 0.1, "N"), "0.00 ± 0.10 N");
  EXPECT_EQ(with_error_bar({none, 4.}, 0.1, "N"), "unknown");
}

/// What is printed is the value and the bar, each within half of a unit of its last digit; values have no digits that the bar makes meaningless.
TEST(ErrorBar, ReadsBackWhatItWasGiven)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> powers(-12, 12), ratios(-7, 2), mantissa(1, 10);
  const std::regex form(R"(\(?(-?[\d.]+) ± ([\d.]+)\)?(e[-+]\d+)? N.*)");
  for (int k = 0; k < 2000; ++k) {
    const double value = (k % 2 == 0 ? 1 : -1) * mantissa(random) * std::pow(10, powers(random));
    const double bar = std::abs(value) * std::pow(10, ratios(random));
    const std::string text = with_error_bar(value, bar, "N");
    std::smatch found;
    ASSERT_TRUE(std::regex_match(text, found, form)) << text;
    const auto read = [&](const int part) { return std::stod(found[part].str() + found[3].str()); };
    const double last = std::pow(10, std::floor(std::log10(bar * (1 + 1e-12))) - 1);
    EXPECT_NEAR(read(2), bar, 0.51 * 10 * last) << text;
    EXPECT_NEAR(read(2), bar, 0.06 * bar) << text;
    EXPECT_NEAR(read(1), value, 0.06 * bar) << text;
    const auto decimals = [&](const int part) {
      const std::string number = found[part];
      const auto point = number.find('.');
      return point == std::string::npos ? 0 : number.size() - point - 1;
    };
    EXPECT_EQ(decimals(1), decimals(2)) << text;
  }
}

} // namespace
} // namespace error_bar_test
