// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/error_bar.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace rpc::io
{
namespace
{

constexpr int most_digits = 9;                           // of a value; a bar that asks for more stands by itself
constexpr double rounding = 1e-11;                       // of a value
constexpr double least_plain = 1e-4, beyond_plain = 1e6; // numbers in between need no power of ten

std::string formatted(const char *const format, const double value)
{
  char text[60];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// The power of ten of the first digit, after rounding to so many digits: -2 of 0.0996 in one digit is -1.
int exponent_of(const double value, const int digits)
{
  char text[40];
  std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
  return std::stoi(std::string(text).substr(std::string(text).find('e') + 1));
}

/// How the numbers of a line are written: as multiples of 10^power, rounded at the digit of 10^last.
struct Style {
  int power = 0, last = 0;

  std::string operator()(const double value) const
  {
    const int decimals = power - last;
    double shown = value / std::pow(10., power);
    if (decimals < 0) shown = std::round(shown / std::pow(10., -decimals)) * std::pow(10., -decimals);
    char text[60];
    std::snprintf(text, sizeof text, "%.*f", std::max(0, decimals), shown);
    const std::string all = text;
    return all.find_first_of("123456789") == std::string::npos && all[0] == '-' ? all.substr(1) : all; // no "-0.00"
  }
  std::string ten() const { return power == 0 ? "" : formatted("e%+03.0f", power); }
};

/// Two digits of the bar, and a power of ten where the larger of both needs one.
Style style_of(const double value, const double bar)
{
  const double larger = std::max(value, bar);
  const bool plain = larger >= least_plain && larger < beyond_plain;
  return {plain ? 0 : exponent_of(larger, 2), exponent_of(bar, 2) - 1};
}

bool follows(const double value, const double bar)
{
  return value == 0 || exponent_of(value, most_digits) - exponent_of(bar, 2) + 2 <= most_digits;
}

std::string join(const std::vector<double> &values, const Style &style)
{
  std::string text;
  for (const double value : values) text += (text.empty() ? "(" : ", ") + style(value);
  return text + ")";
}

/// Components in six digits of the longest, without zeros at their ends.
std::string six_digits(const std::vector<double> &values, const double length)
{
  std::string text;
  for (const double value : values) {
    constexpr double rounded = 5e-7; // of the length
    text += (text.empty() ? "(" : ", ") + formatted("%.6g", std::abs(value) < rounded * length ? 0 : value);
  }
  return text + ")";
}

/// What part of the value a bar is.
std::string share(const double value, const double bar)
{
  if (value == 0) return "";
  return bar > value ? " (larger than the value)" : " (" + formatted("%.2g", 100 * bar / value) + " %)";
}

/// @param size  of the value
std::string text_of(const double value, const double size, const double bar, const std::string &unit)
{
  const std::string in = unit.empty() ? "" : " " + unit;
  if (!std::isfinite(value)) return "unknown";
  if (std::isnan(bar)) return formatted("%.6g", value) + in;
  if (bar == 0) return formatted("%.6g", value) + in + " (exact)";
  if (bar <= rounding * size) return formatted("%.6g", value) + in + " (to rounding)";
  if (!std::isfinite(bar) || !follows(size, bar))
    return formatted("%.9g", value) + " ± " + formatted("%.1e", bar) + in + share(size, bar);
  const Style style = style_of(size, bar);
  const std::string both = style(value) + " ± " + style(bar);
  return (style.power == 0 ? both : "(" + both + ")" + style.ten()) + in + share(size, bar);
}

} // namespace

std::string with_error_bar(const double value, const double bar, const std::string &unit)
{
  return text_of(value, std::abs(value), bar, unit);
}

std::string with_error_bar(const std::vector<double> &vector, const double bar, const std::string &unit)
{
  double length = 0;
  for (const double component : vector) length = std::hypot(length, component);
  const std::string text = text_of(length, length, bar, unit);
  if (!std::isfinite(length) || length == 0) return text;
  if (!(bar > 0 && std::isfinite(bar) && follows(length, bar)))
    return text + ", components " + six_digits(vector, length);
  const Style style = style_of(length, bar);
  return text + ", components " + join(vector, style) + style.ten();
}

} // namespace rpc::io
