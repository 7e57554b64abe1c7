#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>

namespace rpc
{

/// A point in space; absent dimensions are 0 [m].
using Point = std::array<double, 3>;

/// A scalar function of position that a user gave as a number or as an expression of x, y, z.
///
/// A constant is known as such, so that nobody evaluates it at a million points.
struct ScalarField {
  std::string text;                        ///< as the user wrote it, for messages
  double constant = 0;                     ///< the value where at() is empty
  std::function<double(const Point &)> at; ///< empty for a constant

  ScalarField() = default;
  explicit ScalarField(const double value) : text(std::to_string(value)), constant(value) {}
  ScalarField(std::string source, std::function<double(const Point &)> function)
      : text(std::move(source)), at(std::move(function))
  {
  }

  bool is_constant() const { return !at; }
  bool is_zero() const { return is_constant() && constant == 0; }
  double operator()(const Point &x) const { return at ? at(x) : constant; }
};

/// Reads a field from a text; `parameter` is its deck path, for messages. The io package has one that knows
/// expressions.
using FieldParser = std::function<ScalarField(const std::string &text, const std::string &parameter)>;

} // namespace rpc
