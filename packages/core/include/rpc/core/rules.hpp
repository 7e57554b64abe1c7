// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/rule.hpp"

namespace rpc
{

/// What iterations of several packages count as progress, see core/headway.hpp.
struct HeadwayRules {
  Rule<double> falls{0.9, "headway.falls",
                     "measure over the least before that is progress: residual on one quadratic piece, of an accurate "
                     "solve for a confirmed active set, or of a pass of "
                     "the mixed form, energy that a half "
                     "of a step misses, gain of energy by a CG iteration, way of an obstacle to its rest, "
                     "residual of step.iterations_back iterations ago where friction's bounds follow [-]",
                     "not measured"};
};
inline constexpr_rules HeadwayRules headway_rules;

} // namespace rpc
