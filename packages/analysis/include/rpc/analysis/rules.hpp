// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/core/rule.hpp"

namespace rpc::analysis
{

// A rule, a line:
// clang-format off

/// How states of contact are chosen, when their choice goes over to another method, and how well the solves between choices are made.
/// A choice is an update of the active set; overshoot is the ratio of inadmissible to admissible contact forces. doc/theory.md (5.7) to (5.9)
struct ChoiceRules {
  // When choices by pressures end
  Rule<int> most_idle{6, "choice.most_idle", "choices without progress [-]", "measurements.md: Limits on active-set updates"};
  Rule<int> most_visits{3, "choice.most_visits", "visits of one active set, friction in space: slip has turned meanwhile [-]", "not measured"};
  Rule<double> first_part{0.5, "choice.first_part", "part of the changes that is tried first where an active set with friction came back [-]",
                          "not measured"};
  Rule<double> most_left{10, "choice.most_left", "predicted to go, by the fall of changes or by the edge's way, that count as progress [choices]",
                         "measurements.md: Limits on active-set updates"};
  Rule<int> most_with_friction{10, "choice.most_with_friction", "choices with friction, whose changes predict nothing [-]", "measurements.md: Ablation of all rules"};
  Rule<int> fewest_to_tell{4, "choice.fewest_to_tell", "choices until their rate is judged: a slow edge ends them, a coarser mesh chooses without overshoot [-]",
                           "measurements.md: Limits on active-set updates"};
  Rule<double> much{0.5, "choice.much", "overshoot with which a choice without progress counts twice, and a coarser mesh chooses [-]",
                    "theory.md (5.8a): bodies of equal sides stay below"};
  Rule<double> far_too_much{1, "choice.far_too_much", "overshoot that ends choices [-]", "measurements.md: Limits on active-set updates"};
  Rule<double> far_too_much_of_rubber{10, "choice.far_too_much_of_rubber", "the same of nearly incompressible bodies [-]", "not measured"};
  Rule<GO> few_changes{5, "choice.few_changes", "changed points up to which overshoot ends nothing [-]", "measurements.md: Limits on active-set updates"};
  // Where an active set is confirmed
  Rule<int> most_updates{2, "choice.most_updates", "multiplier updates at the end, even if pressures miss their tolerance then [-]", "not measured"};
  Rule<int> most_idle_turns{4, "choice.most_idle_turns", "idle steps in a row, friction in space [-]", "not measured"};
  Rule<double> negligible{1e-3, "choice.negligible", "violations that change no state, over the tolerance of pressures [-]", "not measured"};
  // When a coarser mesh chooses
  Rule<int> most_idle_coarse{3, "choice.most_idle_coarse", "of these in a row without fewer changes than before [-]", "not measured"};
  Rule<GO> most_coarse_unknowns{60'000, "choice.most_coarse_unknowns", "unknowns of the coarser mesh, whose stiffness rank 0 holds [-]",
                                "not measured"};
  Rule<double> model_solves{
      on_gpu ? 10. : 1., "choice.model_solves",
      "time of a factor of the coarser mesh, over a solve of the fine mesh on one rank by the cost model; a GPU's model leaves out levels on the host [-]",
      "measured on thin bodies on a GPU, not recorded"};
  Rule<double> part_of_scale{0.25, "choice.part_of_scale", "scale of the coarser mesh's compliance over the least observed one [-]",
                             "theory.md (5.8d)"};
  // When Newton's method hands over
  Rule<double> ended_by_rounding{1e-3, "choice.ended_by_rounding",
                                 "residual over that before the step for the last active set: the step is enough [-]", "not measured"};
  Rule<double> same_gradient{0.1, "choice.same_gradient",
                             "and at most this part of it is due to states that are not those of the last active set [-]; off: 1e9", "not measured"};
  // Inexact solves
  Rule<double> rough_error{2e-4, "choice.rough_error", "error in energy that is enough instead [-]",
                           "theory.md (5.9): 1e-2 costs thin bodies half a step"};
  Rule<double> coarse_error{1e-8, "choice.coarse_error", "the same where a coarser mesh chooses, and what it misses of a change's energy to learn from: the error [-]", "theory.md (5.8d)"};
  Rule<double> enough{0.3, "choice.enough", "last solve's residual over the tolerance: recomputed it is larger [-]", "not measured"};
};
inline constexpr_rules ChoiceRules choice_rules;

/// The interior-point method. doc/theory.md (5.15) to (5.20)
struct PathRules {
  Rule<double> error{0.1, "path.error", "error in energy of a linear solve [-]",
                     "0.03 saves no step; a residual tells nothing of how far a thin body has bent"};
  Rule<double> forcing{1e-2, "path.forcing", "residual of a linear solve over its right side [-]", "5e-3, that of Newton, takes a plate held all around 19 steps instead of 18"};
  Rule<double> trial{1e-2, "path.trial",
                     "complementarity gap, relative, below which settled states are tried; then over the gap of the last trial [-]", "not measured"};
  Rule<double> last_gap{1e-8, "path.last_gap", "gap that ends the path [-]", "not measured"};
  Rule<int> trial_changes{2, "path.trial_changes", "choices without progress from tried states, of the path or of Newton [-]", "not measured"};
};
inline constexpr_rules PathRules path_rules;

/// Uzawa's iteration, load steps and their halvings, predictions on coarser meshes.
struct StepRules {
  // Uzawa's iteration
  Rule<double> fast{0.1, "step.fast", "worst residual over the one before; above, penalties rise [-]",
                    "theory.md (5.12)"};
  Rule<int> iterations_back{6, "step.iterations_back",
                            "iterations back to compare with where friction's bounds follow [-]; off: 1",
                            "accelerated sequences do not fall at each step; not measured"};
  Rule<double> of_rounding{10, "step.of_rounding", "unbalanced forces over what rounding makes, changes of dents over Uzawa's tolerance: the end is due to it; residuals of a start over that tolerance: no prediction is needed [-]", "robustness.md"};
  Rule<double> refinement{1e-4, "step.refinement", "residual of the solve that refines [-]", "1e-2 leaves a strip that bends far a second step"};
  // Load steps
  Rule<int> most_attempts{5, "step.most_attempts",
 "halvings in vain in a row; attempts at a step, each with a lower tolerance of its parts; solves for the dents that points meet, of which two to four are needed [-]", "not measured"};
  Rule<double> part_of_tolerance{0.5, "step.part_of_tolerance", "of the tolerance that the parts of the next attempt aim at [-]", "not measured"};
  // Predictions
  Rule<GO> fewest_points_telling{50, "step.fewest_points_telling", "contact points of a coarser mesh that tells which method to begin with [-]",
                                 "theory.md (5.11)"};
  Rule<double> boundary{0.65, "step.boundary", "growth of cells over that by numbers of nodes: boundaries have more [-]", "not measured"};
};
inline constexpr_rules StepRules step_rules;

/// What a body's kind tells its linear solver: coarse meshes, mixed form, iterations to expect.
struct LinearRules {
  Rule<GO> least_nodes_of_rank{on_gpu ? 200'000 : 2000, "body.least_nodes_of_rank", "nodes of a coarse box on each of its ranks [-]",
                               "measured, not recorded"};
  // Nearly incompressible bodies
  Rule<double> mixed_above{0.48, "body.mixed_above", "Poisson's ratio above which the mixed form is taken [-]", "theory.md (4.13)"};
  Rule<double> soft{0.4, "body.soft", "Poisson's ratio of the soft part of K [-]", "theory.md (4.13)"};
  Rule<double> soft_tetrahedra{0.47, "body.soft_tetrahedra", "the same in tetrahedra [-]", "theory.md (4.13)"};
  Rule<double> pays_above{0.495, "body.pays_above", "Poisson's ratio above which tetrahedra have equations for alternating pressures [-]",
                          "theory.md (4.15a)"};
  Rule<double> softer_tetrahedra{0.45, "body.softer_tetrahedra", "the soft part's where they have [-]", "theory.md (4.15a)"};
  // Iterations to expect, to 1e-8
  Rule<double> cost_of_step{0.035, "body.cost_of_step", "step of the polynomial for pressures [CG iterations]", "theory.md (4.10d)"};
  Rule<double> expected{4, "body.expected", "of other bodies, times (1 - 2 nu)^(-1/2) [CG iterations]", "theory.md (4.10b)"};
  Rule<double> expected_of_p1{6, "body.expected_of_p1", "the same of P1 [CG iterations]", "theory.md (4.10b)"};
  Rule<double> expected_of_stretched{3, "body.expected_of_stretched", "of stretched P1, times (1 - 2 nu)^(-3/4) [CG iterations]",
                                     "theory.md (4.10b)"};
  Rule<double> rough_incompressible{0.002, "body.rough_incompressible", "1 - 2 nu below which solves while states change are better [-]",
                                    "theory.md (5.9b)"};
};
inline constexpr_rules LinearRules linear_rules;

} // namespace rpc::analysis
