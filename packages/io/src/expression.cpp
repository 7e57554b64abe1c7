// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/expression.hpp"

#include "deck_text.hpp"
#include "expression_bounds.hpp"
#include "expression_remedy.hpp"
#include "rpc/core/error.hpp"

#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <muParser.h>
#include <optional>
#include <regex>
#include <utility>

namespace rpc::io
{
namespace
{

constexpr const char *known_names = "Variables: x, y, z, t; constants: pi, e, inf.";

/// A muParser with the variables that it points to; neither copied nor moved, or the parser would point astray.
struct Expression {
  mu::Parser parser;
  Point x{};
  double t = 1;

  explicit Expression(const std::string &text)
  {
    parser.DefineConst("pi", 3.14159265358979323846);
    parser.DefineConst("e", 2.71828182845904523536);
    parser.DefineConst("inf", std::numeric_limits<double>::infinity());
    parser.DefineVar("x", &x[0]);
    parser.DefineVar("y", &x[1]);
    parser.DefineVar("z", &x[2]);
    parser.DefineVar("t", &t);
    parser.SetExpr(text);
  }
  Expression(const Expression &) = delete;
  Expression &operator=(const Expression &) = delete;

  double operator()(const Point &at, const double time)
  {
    x = at;
    t = time;
    return parser.Eval();
  }

  /// x = 3 is an assignment in muParser, where a user means x == 3. Known after the first evaluation.
  bool assigns() const
  {
    const mu::SToken *token = parser.GetByteCode().GetBase();
    for (; token->Cmd != mu::cmEND; ++token)
      if (token->Cmd == mu::cmASSIGN) return true;
    return false;
  }
};

/// The whole text as a number, inf and nan included; none if it is anything else or does not fit a double.
std::optional<double> read_number(const std::string &text)
{
  errno = 0;
  char *end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || (errno == ERANGE && std::isinf(value))) return std::nullopt;
  while (std::isspace(static_cast<unsigned char>(*end))) ++end;
  if (*end != '\0') return std::nullopt;
  return value;
}

std::string refused(const std::string &text, const std::string &parameter, const std::string &reason,
                    const Wanted &wanted)
{
  return "deck: \"" + parameter + "\" = \"" + text + "\" is not a number or an expression: " + reason + "." +
         expression_remedy(text, wanted) + " " + known_names;
}

/// muParser's words, without its own and not always present 0-based position.
std::string reason_of(const mu::ParserError &error)
{
  static const std::regex position("( found)? at (expression )?position -?[0-9]+");
  std::string reason = std::regex_replace(error.GetMsg(), position, "");
  while (!reason.empty() && (reason.back() == '.' || reason.back() == ' ')) reason.pop_back();
  if (!reason.empty() && reason.back() == '"') { // behind blanks that muParser adds
    reason.pop_back();
    reason = trimmed(reason) + '"';
  }
  if (error.GetPos() >= 0 && error.GetPos() != std::numeric_limits<int>::max())
    reason += " at character " + std::to_string(error.GetPos() + 1);
  return reason;
}

/// Whether muParser and the bounds read an expression alike, as far as some points tell.
bool agree(const ExpressionBounds &bounds, Expression &expression)
{
  for (const double s : {-1.3, 0., 0.17, 0.71, 2.9}) {
    const Point at{s, 0.6 - s, 0.3 * s};
    const double value = expression(at, s), rounding = 1e-9 * (1 + std::abs(value));
    const Interval bound = bounds({at, at}, s);
    if (std::isfinite(value) && !(bound.low - rounding <= value && value <= bound.high + rounding)) return false;
  }
  return true;
}

} // namespace

ScalarField parse_field(const std::string &text, const std::string &parameter, const Wanted &wanted)
{
  const auto constant = [&](const double value) {
    RPC_REQUIRE(!std::isnan(value), "deck: \"" << parameter << "\" = \"" << text << "\" is not a number (nan)");
    ScalarField field(value);
    field.text = text;
    return field;
  };
  if (const auto value = read_number(text)) return constant(*value);
  try {
    const auto expression = std::make_shared<Expression>(text);
    const double at_origin = (*expression)(Point{}, 1);
    RPC_REQUIRE(expression->parser.GetNumResults() == 1,
                refused(text, parameter, "it has several values, separated by commas", wanted));
    RPC_REQUIRE(!expression->assigns(), refused(text, parameter, "\"=\" assigns; to compare, write \"==\"", wanted));
    if (expression->parser.GetUsedVar().empty()) return constant(at_origin);
    ScalarField field(text, [expression](const Point &x, const double t) { return (*expression)(x, t); });
    if (const auto bounds = ExpressionBounds::of(text); bounds && agree(*bounds, *expression)) field.bounds = *bounds;
    return field;
  } catch (const mu::ParserError &error) {
    throw Error(ExitCode::bad_input, refused(text, parameter, reason_of(error), wanted));
  }
}

FieldParser field_parser(const Teuchos::ParameterList &valid)
{
  return [valid](const std::string &text, const std::string &parameter) {
    return parse_field(text, parameter, wanted_of(valid, parameter));
  };
}

} // namespace rpc::io
