// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/rule.hpp"

/// Numbers of the contact package that steer a minimization, see core/rule.hpp. Device code takes copies that the host has made.
namespace rpc::contact
{

/// The interior path, doc/theory.md (5.15) to (5.20); for the points of a body and for the model of a coarser mesh (analysis).
struct InteriorRules {
  Rule<double> first_mu{0.1, "interior.first_mu",
                        "products of pairs at the start over pressure times displacement [-]; less gains nothing: a "
                        "point that has to change its "
                        "state starts too near to its corner",
                        "doc/theory.md (5.16)"};
  Rule<double> above_start{
      3, "interior.above_start",
      "pressure at the start over the mean pressure of a given start, where the load's is less [-]",
      "doc/theory.md (5.16)"};
  Rule<double> to_boundary{0.98, "interior.to_boundary",
                           "part of the way to the next point's corner that a step takes [-]; off: 1",
                           "doc/theory.md (5.19)"};
  // Several short steps in a row tell that points start with a pressure far below what they will bear, as where the foundation bends the body
  // and not the load: the path restarts with a larger pressure. A few steps are short on any path.
  Rule<double> short_step{0.25, "interior.short_step", "length of a short step [-]", "doc/theory.md (5.16)"};
  Rule<int> many_short_steps{3, "interior.many_short_steps",
                             "short steps in a row before the path restarts [-]; off: 1e9", "doc/theory.md (5.16)"};
  Rule<double> more_pressure{100, "interior.more_pressure",
                             "factor of the pressure where the path restarts [-]; off: 1", "doc/theory.md (5.16)"};
};
inline constexpr_rules InteriorRules interior_rules;

/// The first states of points, and bodies that contact alone holds.
struct StartRules {
  Rule<double> first_weight{10, "start.first_weight",
                            "of penetrations against pressures in the first active set, over E/diameter [-]",
                            "doc/theory.md (5.8)"};
  Rule<double> beyond_reach{
      100, "start.beyond_reach",
      "yield limit over load per contact area above which it does not count at the start [-]; off: 1e9",
      "doc/theory.md (5.8)"};
  // Springs of points of a body that contact alone holds, (9.8): weak enough not to slow Newton's method down once nodes close, strong
  // against the rounding of K.
  Rule<double> spring{1e-4, "start.spring", "stiffness of the springs over E/diameter [-]; off: 1e-10",
                      "doc/theory.md (9.8)"};
  Rule<double> least_spring{1e-10, "start.least_spring", "the same after a long step [-]", "doc/theory.md (9.8)"};
  Rule<double> long_step{1.1, "start.long_step",
                         "step length that shows springs at work: that of a quadratic is 1 [-]; off: 1e9",
                         "doc/theory.md (9.8)"};
};
inline constexpr_rules StartRules start_rules;

/// Penalties over a point's own stiffness k. One minimization leaves |v| of about p/(gamma k) with r = gamma k; rounding of v is amplified by
/// gamma.
struct PenaltyRules {
  Rule<double> standard{1e5, "penalty.standard", "penalty over own stiffness [-]; off: 1e3", "doc/theory.md (5.12)"};
  // Where the normal lies along no axis, the penalty is on the diagonal of unknowns along the surface too, and smoothers that go by the
  // diagonal do too little there.
  Rule<double> slanting{1e3, "penalty.slanting", "the same where the normal lies along no axis [-]; off: 1e5",
                        "half cylinder with its own normals: 30 CG iterations, 160 with 1e5"};
  Rule<double> largest{1e8, "penalty.largest", "penalty over own stiffness at most, given ones too [-]; off: 1e12",
                       "doc/theory.md (5.12)"};
  Rule<double> raise{100, "penalty.raise", "factor of penalties where multiplier updates are slow [-]; off: 1",
                     "doc/theory.md (5.12)"};
};
inline constexpr_rules PenaltyRules penalty_rules;

/// Bounds of friction that follow the pressure, and dents that move with the foundation.
struct LagRules {
  Rule<int> mixing_depth{4, "lag.mixing_depth",
                         "earlier iterations that Anderson's acceleration of friction bounds combines [-]; off: 0",
                         "doc/theory.md, section 12"};
  Rule<double> least_held{0.1, "lag.least_held",
                          "penalty times prescribed slip of a point that cannot stick, over what friction bears there: "
                          "above, its branch is without multiplier [-]; off: 1e9",
                          "measurements.md: Friction: points that cannot stick"};
  Rule<int> most_sheets{64, "lag.most_sheets",
                        "sheets of dents of one foundation, one a step, before two are joined by interpolation [-]",
                        "doc/theory.md, section 11"};
};
inline constexpr_rules LagRules lag_rules;

} // namespace rpc::contact
