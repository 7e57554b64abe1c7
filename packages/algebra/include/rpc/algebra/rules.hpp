// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/rule.hpp"

namespace rpc
{

/// Numbers that steer whether nodes are sorted into kinds with equal rows, see core/rule.hpp.
struct KindRules {
  Rule<int> most{600, "kinds.most", "kinds at most [-]; off: 0", "doc/theory.md, section 4"};
  Rule<int> enough{30, "kinds.enough",
                   "kinds after which it ends if most kinds, at their rate, miss least_part [-]; off: 1e9",
                   "doc/theory.md, section 4"};
  Rule<double> least_part{0.75, "kinds.least_part", "part of the nodes that repeat, worth it [-]",
                          "doc/theory.md, section 4"};
};
inline constexpr_rules KindRules kind_rules;

} // namespace rpc
