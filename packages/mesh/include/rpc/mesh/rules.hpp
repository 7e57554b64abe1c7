// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/rule.hpp"

/// Numbers that steer which coarser meshes multigrid gets, see core/rule.hpp.
namespace rpc::mesh
{

/// Of boxes, structured grids, meshes whose edges are contracted, and nested ones.
struct CoarseningRules {
  Rule<int> few{400, "coarsening.few", "unknowns with no coarser mesh [-]", "measurements.md: Ablation of all rules"};
  Rule<double> most_kept{0.7, "coarsening.most_kept", "part of the nodes in a coarser mesh worth having [-]; off: 1",
                         "doc/theory.md, section 2"};
  Rule<double> least_added{
      1.3, "coarsening.least_added", "nodes of a nested mesh over its parent's [-]; off: 1",
      "doc/measurements.md: Adapted meshes in space; 1/most_kept takes a fifth more CG iterations"};
  Rule<int> least_cells_of_rank{16, "coarsening.least_cells_of_rank",
                                "cells of a coarser mesh on each of its ranks [-]", "not measured"};
  Rule<double> equally_long{1.7, "coarsening.equally_long", "node distance or sheet, over the least, still alike [-]",
                            "doc/theory.md (4.7e)"};
};
inline constexpr_rules CoarseningRules coarsening_rules;

/// Of the contraction of edges.
struct ContractionRules {
  Rule<int> few{2500, "contraction.few", "unknowns of order 1 that multigrid factors, with no coarser mesh [-]",
                "doc/measurements.md: Contracted meshes with few unknowns"};
  // Of stretched cells some are sheared before their neighbours follow: a part of what a vertex' worst cell had at first is enough.
  Rule<double> least_quality{0.3, "contraction.least_quality", "of new cells, 1 for an equilateral one [-]",
                             "doc/theory.md, section 2"};
  Rule<double> part_kept{0.8, "contraction.part_kept",
                         "quality over that of the worst cell before that will do [-]; off: 1",
                         "doc/theory.md, section 2"};
  Rule<double> least_cosine{0.8, "contraction.least_cosine",
                            "cosine of the turn of a boundary facet, and of the angle at an edge of the body [-]",
                            "doc/theory.md, section 2: 37 degrees"};
  // In a cube cut into tetrahedra edges are up to 1.73 times as long as the shortest one, and where inner nodes are moved by 15 % of a cell up
  // to 2.7 times.
  Rule<double> most_stretched{3, "contraction.most_stretched",
                              "length of edges over the shortest that join neighbours [-]", "doc/theory.md, section 2"};
};
inline constexpr_rules ContractionRules contraction_rules;

} // namespace rpc::mesh
