// SPDX-License-Identifier: BSD-3-Clause
#include "expression_remedy.hpp"

#include "rpc/core/remedies.hpp"

#include <algorithm>
#include <cctype>
#include <regex>
#include <string>
#include <vector>

namespace rpc::io
{
namespace
{

const std::vector<std::string> names_in_expressions = {
    "x",    "y",    "z",     "t",    "pi",   "e",    "inf",   "sin",   "cos",   "tan",  "asin",
    "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "log2", "log10",
    "log",  "ln",   "exp",   "sqrt", "sign", "rint", "abs",   "min",   "max",   "sum",  "avg"};

/// Names of other languages, in small letters, and what stands for them here.
struct OtherName {
  const char *name, *remedy;
};
constexpr OtherName other_names[] = {{"r", "sqrt(x^2 + y^2)"},
                                     {"time", "t"},
                                     {"pow", "a^b for pow(a, b)"},
                                     {"if", "condition ? value : other"},
                                     {"heaviside", "x > 0 ? 1 : 0"},
                                     {"and", "&& (in XML &amp;&amp;)"},
                                     {"or", "||"},
                                     {"fabs", "abs"},
                                     {"arctan", "atan"},
                                     {"arcsin", "asin"},
                                     {"arccos", "acos"},
                                     {"infinity", "inf"},
                                     {"unlimited", "inf"},
                                     {"none", "0 or inf, or leave the parameter out"},
                                     {"null", "0 or inf, or leave the parameter out"},
                                     {"true", "a number"},
                                     {"false", "a number"}};

std::string remedy_of_name(const std::string &name)
{
  std::string small = name;
  std::transform(small.begin(), small.end(), small.begin(), [](const unsigned char c) { return std::tolower(c); });
  for (const OtherName &other : other_names)
    if (small == other.name) return std::string(" For \"") + name + "\" write " + other.remedy + ".";
  if (name.size() > 1 ||
      std::find(names_in_expressions.begin(), names_in_expressions.end(), small) != names_in_expressions.end())
    return did_you_mean(name, names_in_expressions);
  return "";
}

/// A number with a decimal comma, with a point for it: digits at both sides of a comma that separates no arguments; empty if there is none.
std::string decimal_comma(const std::string &text)
{
  int depth = 0;
  const auto is_digit = [&](const std::size_t n) {
    return n < text.size() && std::isdigit(static_cast<unsigned char>(text[n]));
  };
  for (std::size_t n = 1; n < text.size(); ++n) {
    depth += (text[n - 1] == '(') - (text[n - 1] == ')');
    if (depth > 0 || text[n] != ',' || !is_digit(n - 1) || !is_digit(n + 1)) continue;
    std::size_t begin = n, end = n + 1;
    while (begin > 0 && is_digit(begin - 1)) --begin;
    while (is_digit(end)) ++end;
    return text.substr(begin, n - begin) + "." + text.substr(n + 1, end - n - 1);
  }
  return "";
}

} // namespace

std::string expression_remedy(const std::string &text, const Wanted &wanted)
{
  if (text.find_first_not_of(" \t") == std::string::npos)
    return " Write a number or an expression, or remove the parameter.";
  if (const std::string remedy = number_remedy(text, wanted); !remedy.empty()) return remedy;
  if (text.find("**") != std::string::npos) return " Powers are written ^.";
  for (const char *const minus : {"\u2212", "\u2013", "\u2014"})
    if (text.find(minus) != std::string::npos)
      return std::string(" For \"") + minus + "\" write \"-\", the minus of a keyboard.";
  for (const char *const mark : {"\u00d7", "\u00b7"})
    if (text.find(mark) != std::string::npos) return std::string(" For \"") + mark + "\" write \"*\".";
  static const std::regex module(R"(\b(np|numpy|math|Math|std|sp|torch)(\.|::)\s*\w)");
  std::smatch found;
  if (std::regex_search(text, found, module)) return " Leave out \"" + found[1].str() + found[2].str() + "\".";
  static const std::regex missing_product(R"(\d\s*(x|y|z|t|pi)\b|\)\s*\(|\d\s*\()");
  if (const std::string number = decimal_comma(text); !number.empty())
    return " For a decimal comma write a point: " + number + ".";
  static const std::regex name(R"([A-Za-z_]\w*)");
  for (auto at = std::sregex_iterator(text.begin(), text.end(), name); at != std::sregex_iterator(); ++at) {
    const std::string given = at->str();
    if (at->position() > 0 && std::isdigit(static_cast<unsigned char>(text[at->position() - 1]))) continue; // 2e5, 3x
    if (std::find(names_in_expressions.begin(), names_in_expressions.end(), given) != names_in_expressions.end())
      continue;
    return remedy_of_name(given);
  }
  const auto opened = std::count(text.begin(), text.end(), '('), closed = std::count(text.begin(), text.end(), ')');
  if (opened > closed) return " A \")\" is missing.";
  if (opened < closed) return " A \"(\" is missing, or a \")\" too many.";
  if (std::regex_search(text, found, missing_product)) return " Products are written *, as in 2*x.";
  if (text.find('?') != std::string::npos && text.find(':') == std::string::npos)
    return " A condition is written condition ? value : other.";
  return "";
}

} // namespace rpc::io
