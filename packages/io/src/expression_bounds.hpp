// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/interval.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rpc::io
{

/// Bounds on an expression of a deck over a box, by interval arithmetic: every value that muParser gives in the box lies within, up to
/// rounding. They are exact for boxes that are points, and too wide by a multiple of the box's size else.
///
/// Parses muParser's grammar itself, for muParser evaluates points only. It knows muParser's operators and functions but for those without bounds
/// of their own; an expression with anything else has no bounds.
class ExpressionBounds
{
public:
  /// Nothing where the text has something that is not known.
  static std::optional<ExpressionBounds> of(const std::string &text);

  /// Where the expression has no value in a part of the box, that part does not count.
  Interval operator()(const Box &box, double t) const;

private:
  friend class BoundsParser;
  enum class Operation;
  /// In the order of evaluation; operands are steps before.
  struct Step {
    Operation operation;
    double number = 0;
    int first = 0, second = 0, third = 0;
  };
  std::vector<Step> steps_;
};

} // namespace rpc::io
