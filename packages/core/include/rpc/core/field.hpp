// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/interval.hpp"

#include <functional>
#include <string>
#include <utility>

namespace rpc
{

/// A scalar function of position and time that a user gave as a number or as an expression of x, y, z, t, seen at one time.
///
/// A constant is known as such: kernels need not evaluate it at every point.
struct ScalarField {
  std::string text;                                ///< as the user wrote it, for messages
  double constant = 0;                             ///< the value where at() is empty
  std::function<double(const Point &, double)> at; ///< of place and time; empty for a constant
  std::function<Interval(const Box &, double)>
      bounds;      ///< on its values in a box, of box and time; empty: not known, or a constant
  double time = 1; ///< at which it is seen

  ScalarField() = default;
  explicit ScalarField(const double value) : text(std::to_string(value)), constant(value) {}
  ScalarField(std::string source, std::function<double(const Point &, double)> function)
      : text(std::move(source)), at(std::move(function))
  {
  }
  ScalarField(std::string source, std::function<double(const Point &)> function)
      : text(std::move(source)), at([of_place = std::move(function)](const Point &x, double) { return of_place(x); })
  {
  }

  bool is_constant() const { return !at; }
  bool is_zero() const { return is_constant() && constant == 0; }
  double operator()(const Point &x) const { return at ? at(x, time) : constant; }
  /// The same field, seen at another time.
  ScalarField seen_at(const double t) const
  {
    ScalarField field = *this;
    field.time = t;
    return field;
  }
};

/// Reads a field from a text; `parameter` is its deck path, for messages. The io package has one that knows
/// expressions.
using FieldParser = std::function<ScalarField(const std::string &text, const std::string &parameter)>;

} // namespace rpc
