// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/expression.hpp"

#include "rpc/core/error.hpp"
#include "scratch.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace expression_test
{
namespace
{

using rpc::ExitCode;
using rpc::io::parse_field;
using rpc::test::expect_error;

void expect_refusal(const std::string &text, const std::string &part)
{
  expect_error(ExitCode::bad_input, "\"Contact->Yield Stress\" = \"" + text + "\"",
               [&] { parse_field(text, "Contact->Yield Stress"); });
  expect_error(ExitCode::bad_input, part, [&] { parse_field(text, "Contact->Yield Stress"); });
}

TEST(ExpressionBounds, HoldAllValuesInABoxAndAreExactAtPoints)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> places(-2, 2), shares(0, 1);
  for (const std::string text :
       {"0.19 - sqrt(0.04 - min((x - 0.3125)^2, 0.039))", "x < 0.65 ? 0 : 1", "0.35*max(abs(x - 0.5), abs(y)) - t",
        "1 - 2*exp(-((x - 0.6)/0.05)^2 - y^2)", "-x^2 + 2^-x", "x*x - y*y*x", "sin(3*x)*cos(2*y - 1) + tanh(x/y)",
        "(x - 1)^3/(y^2 + 1)", "x > 0 && y < 1 || z == 0 ? ln(abs(x) + 1) : exp(-y)", "abs(x)^1.5 - atan(y)/pi",
        "1 - 0.01*t*(t <= 1) + 1*(t > 1)", "2*(x != y) + (x >= y)", "-2^2*x", "x - -y", "sum(x, y, log(z^2))"}) {
    const auto field = parse_field(text, "Gap");
    ASSERT_TRUE(field.bounds) << text;
    for (int k = 0; k < 2000; ++k) {
      rpc::Box box;
      for (int i = 0; i < 3; ++i) {
        box.low[i] = places(random);
        box.high[i] = box.low[i] + (k % 3 == 0 ? 0 : k % 3 == 1 ? 1e-3 : 0.5) * shares(random);
      }
      const double t = places(random);
      const rpc::Interval bound = field.bounds(box, t);
      for (int m = 0; m < 5; ++m) {
        rpc::Point at{};
        for (int i = 0; i < 3; ++i) at[i] = box.low[i] + shares(random) * (box.high[i] - box.low[i]);
        const double value = field.at(at, t), rounding = 1e-12 * (1 + std::abs(value));
        if (std::isnan(value)) continue;
        ASSERT_GE(value, bound.low - rounding) << text;
        ASSERT_LE(value, bound.high + rounding) << text;
        if (k % 3 == 0) {
          ASSERT_NEAR(bound.low, bound.high, rounding) << text;
        }
      }
    }
  }
}

TEST(ExpressionBounds, ThereAreNoneOfWhatIsNotKnown)
{
  for (const std::string text : {"rint(x)", "avg(x, y)", "x > 0 ? rint(y) : 1"})
    EXPECT_FALSE(parse_field(text, "Gap").bounds);
  EXPECT_FALSE(parse_field("2*pi", "Gap").bounds); // a constant
}

TEST(Expression, TextWithoutVariablesIsAConstant)
{
  const std::vector<std::pair<std::string, double>> cases = {
      {"16", 16}, {" -2.5e3 ", -2500}, {"2*pi", 2 * M_PI}, {"e", M_E}, {"sqrt(2)^2", std::pow(std::sqrt(2.), 2)}};
  for (const auto &[text, value] : cases) {
    const auto field = parse_field(text, "A");
    EXPECT_TRUE(field.is_constant()) << text;
    EXPECT_DOUBLE_EQ(field.constant, value) << text;
    EXPECT_EQ(field.text, text);
  }
}

TEST(Expression, InfIsANumberAloneAndInsideAnExpression)
{
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(parse_field("inf", "A").constant, inf);
  EXPECT_EQ(parse_field("-inf", "A").constant, -inf);
  const auto field = parse_field("x > 1 ? inf : 2", "A");
  EXPECT_EQ(field({2, 0, 0}), inf);
  EXPECT_EQ(field({1, 0, 0}), 2);
}

TEST(Expression, KnowsAllThreeCoordinates)
{
  const auto field = parse_field("x + 10*y + 100*z", "A");
  EXPECT_FALSE(field.is_constant());
  EXPECT_EQ(field.text, "x + 10*y + 100*z");
  EXPECT_DOUBLE_EQ(field({1, 2, 3}), 321);
  EXPECT_DOUBLE_EQ(parse_field("-20*sin(pi*x/5)", "A")({2.5, 0, 0}), -20);
}

TEST(Expression, CopiesOutliveTheOriginal)
{
  rpc::ScalarField copy;
  {
    const auto field = parse_field("x*y", "A");
    copy = field;
  }
  EXPECT_DOUBLE_EQ(copy({3, 4, 0}), 12);
}

TEST(Expression, NanAtAPointIsLeftToTheEvaluation)
{
  const auto field = parse_field("sqrt(x)", "A");
  EXPECT_TRUE(std::isnan(field({-1, 0, 0})));
  EXPECT_EQ(parse_field("1/x", "A")({2, 0, 0}), 0.5); // infinite at the origin, where it is tried
}

TEST(Expression, ConstantNanIsRefused)
{
  for (const char *text : {"nan", "NaN", "0/0", "inf-inf", "sqrt(-1)"}) expect_refusal(text, "nan");
}

TEST(Expression, MessageNamesReasonPositionAndVariables)
{
  expect_refusal("2*xi", "Unexpected token \"xi\" at character 3");
  expect_refusal("2*(x", "Missing parenthesis at character");
  expect_refusal("sin(x, y)", "Too many parameters");
  for (const char *text : {"", "  ", "x +", "foo(x)", "x y", "1e400", "16 Pa", "\"x\""})
    expect_refusal(text, "Variables: x, y, z, t; constants: pi, e, inf.");
}

TEST(Expression, AssignmentsAndListsAreRefused)
{
  expect_refusal("x = 3", "==");
  expect_refusal("1, 2", "several values");
  expect_refusal("x, y", "several values");
  EXPECT_EQ(parse_field("x == 3", "A")({3, 0, 0}), 1);
}

} // namespace
} // namespace expression_test
