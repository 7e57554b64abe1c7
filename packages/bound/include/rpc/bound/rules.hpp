// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/rule.hpp"

/// Numbers that steer how near a bound comes to the error, see core/rule.hpp. It is a bound whatever they are.
namespace rpc::bound
{

struct BoundRules {
  Rule<int> steps{
      3, "bound.steps",
      "of conjugate gradients on tractions in balance, in space twice as many, of hexahedra four times [-]; off: 0",
      "doc/bounds.md (13.9): the table of what each step gains"};
};
inline constexpr_rules BoundRules bound_rules;

} // namespace rpc::bound
