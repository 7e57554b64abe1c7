#include "rpc/io/expression.hpp"

#include "rpc/core/error.hpp"
#include "scratch.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

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
