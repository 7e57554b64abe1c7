// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/rule.hpp"

/// Numbers that steer which mesh comes next, see core/rule.hpp. What error bars cover is no rule: those numbers stand with the estimates.
namespace rpc::adapt
{

/// What the next mesh is planned for, and when there is none.
struct PlanRules {
  // Predictions are right to some ten per cent, and in space another mesh costs more.
  Rule<double> aim{0.95, "plan.aim", "planned estimate over the target, in the plane [-]; off: 1",
                   "doc/theory.md, section 10"};
  Rule<double> aim_in_space{0.88, "plan.aim_in_space", "the same in space [-]; off: 1", "doc/theory.md, section 10"};
  // Sizes of nested cells are a factor of 1.26 or 1.41 apart: plans that ask for little change nothing in many places.
  Rule<double> aim_near_nested{0.7, "plan.aim_near_nested", "the same of nested meshes near the target [-]; off: 1",
                               "not measured"};
  Rule<double> greatest_reduction{4, "plan.greatest_reduction", "factor by which the estimate falls a mesh [-]",
                                  "doc/theory.md, section 10: a coarse mesh knows little of where a fine one is fine"};
  // Near the target the next plan makes up for the excess of the estimates over their plans since then: an excess that stays asks for more
  // each time. Cells hardly grow there, so that no accuracy is lost.
  Rule<double> near{2, "plan.near", "estimate over the planned one that is near, in the plane [-]", "not measured"};
  Rule<double> near_in_space{1.3, "plan.near_in_space", "the same in space [-]", "not measured"};
  Rule<double> greatest_correction{3, "plan.greatest_correction", "factor that makes up for excess [-]; off: 1",
                                   "not measured"};
  Rule<double> growth{2.5, "plan.growth", "of a cell's size from mesh to mesh, at most [-]; off: 1e3",
                      "doc/theory.md (10.5)"};
  Rule<double> growth_near{1.25, "plan.growth_near", "the same near the target [-]; off: 1e3", "not measured"};
  Rule<double> greatest_excess{1.5, "plan.greatest_excess", "cells over what the elements' order asks for [-]",
                               "not measured: where a coarse mesh asks for more, its estimate misleads"};
  // gmsh makes more cells or fewer than it is asked for; after the first mesh at the limit it is known how many.
  Rule<double> share_of_max_dofs{0.75, "plan.share_of_max_dofs", "of Max Dofs that is planned for [-]; off: 1",
                                 "not measured"};
  Rule<double> share_again{
      0.9, "plan.share_again",
      "the same after a mesh at the limit, and part of the planned unknowns that makes a mesh one "
      "at the limit [-]; off: 1",
      "with 0.75 a roller of at most 5000 unknowns ends with 3342 and an error of 0.0117, not 4016 and 0.0092"};
  // Coarse meshes cannot be as coarse as they may, for the body's edges; nested ones are no coarser than the first one, and neighbours of
  // small cells are halved.
  Rule<double> excess{2, "plan.excess",
                      "cells made for a planned one in space, and of nested meshes, a guess [-]; off: 1",
                      "not measured"};
  // gmsh makes cells of twice the size, which are halved: an eighth of its time, and multigrid has a mesh more. Halved meshes of fewer cells
  // could not be as coarse. In the plane gmsh is fast enough, and finer gradings pay.
  Rule<double> least_halved{6000, "plan.least_halved",
                            "cells of a mesh in space from which they are halved [-]; off: 1e30",
                            "doc/measurements.md: Adapted meshes in space"};
};
inline constexpr_rules PlanRules plan_rules;

/// Sizes of cells from an estimate, doc/theory.md (10.5) to (10.6).
struct SizeRules {
  Rule<double> least_ratio{0.1, "sizes.least_ratio",
                           "size over the present one at least, where the solution is smooth [-]",
                           "doc/theory.md (10.5): the estimate knows no better"};
  Rule<double> least_vertex_ratio{1e-4, "sizes.least_vertex_ratio", "the same at a singular vertex in the plane [-]",
                                  "not measured: few cells"};
  Rule<double> gradation{0.4, "sizes.gradation", "growth of sizes with the distance [-]; off: 1e9",
                         "doc/theory.md, section 10: neighbours differ by about half"};
  Rule<int> rings{4, "sizes.rings", "of cells about a vertex that tell its exponent, in the plane [-]; off: 1",
                  "doc/theory.md (10.6)"};
  Rule<int> rings_in_space{3, "sizes.rings_in_space", "the same in space [-]; off: 1", "doc/theory.md (10.6)"};
  Rule<double> telling_spread{0.05, "sizes.telling_spread", "variance of log(distance) that tells an exponent [-]",
                              "not measured"};
  Rule<double> margin{0.25, "sizes.margin", "exponent short of the elements' order that is singular [-]",
                      "doc/theory.md (10.6)"};
  Rule<double> same_in_space{0.2, "sizes.same_in_space", "difference of exponents in space that are the same [-]",
                             "doc/theory.md (10.6)"};
  Rule<int> most_corrections{6, "sizes.most_corrections",
                             "of the level for the error of the sizes, in space [-]; off: 0", "doc/theory.md (10.5a)"};
  Rule<double> most_above{1.05, "sizes.most_above",
                          "squared error asked for over that of the sizes, or the other way round: right [-]",
                          "not measured"};
  Rule<double> level_step{1.5, "sizes.level_step", "factor of the level while there are too many cells [-]; off: 1.1",
                          "not measured"};
};
inline constexpr_rules SizeRules size_rules;

} // namespace rpc::adapt
