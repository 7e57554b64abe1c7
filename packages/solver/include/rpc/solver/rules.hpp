// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/core/rule.hpp"

#include <limits>

namespace rpc::solver
{

/// Which preconditioner a linear solve has, how each is made, and when the next one takes over. Equations are those of doc/theory.md.
struct LinearRules {
  // Choice of a preconditioner.
  Rule<GO> few_rows{1000, "linear.few_rows",
                    "unknowns of a mesh that one factor solves for sooner than coarser meshes: it has the factor from "
                    "the start, MueLu has no level below, and without friction no coarser mesh predicts [-]",
                    "coarser meshes save little there, and leave CG a rest"};
  Rule<GO> most_sparse_rows{3000000, "linear.most_sparse_rows",
                            "unknowns up to which a sparse factor is thought of [-]",
                            "its memory in the plane and in space"};
  Rule<int> first_iterations{15, "linear.first_iterations", "CG iterations before a factor is thought of [-]",
                             "(4.10)"};
  Rule<int> fair_iterations{30, "linear.fair_iterations",
                            "iterations of a solve to 1e-8 that are not lost, and that the mixed form takes [-]",
                            "(4.10), (4.10d)"};
  Rule<int> solves_with_contact{4, "linear.solves_with_contact", "solves to come with contact [-]", "random families"};
  Rule<double> part_to_tell{0.3, "linear.part_to_tell", "time of a factor before CG's rate is believed [-]",
                            "CG stalls at first, and is fast then, where layers are of unlike stiffness"};
  Rule<double> few_iterations{5.5, "linear.few_iterations", "iterations worth a band factor [-]", "(4.10e)"};

  // How CG goes on.
  Rule<int> window{20, "linear.window", "iterations that a rate is taken over [-]",
                   "CG stands still for ten now and then, (4.10a)"};
  Rule<double> large_error{
      1e-2, "linear.large_error",
      "error for one application of an exact factor, and at which a breakdown is that of rounding [-]",
      "with less a thin strip takes 16 Newton steps instead of 6"};
  Rule<int> gmres_vectors{50, "linear.gmres_vectors", "GMRES iterations before a restart [-]",
                          "with multigrid it takes fewer"};

  // The mixed form, (4.14), (4.15).
  Rule<int> iterations_of_pass{80, "linear.iterations_of_pass", "BiCGStab iterations before a restart [-]",
                               "its own residuals are no longer those of x by then"};
  Rule<double> degree_of_root{0.7, "linear.degree_of_root", "degree over the root of the condition number [-]",
                              "least time"};
  Rule<int> least_degree{4, "linear.least_degree", "degree for pressures at least [-]", "least time"};
  Rule<int> largest_degree{40, "linear.largest_degree", "degree for pressures at most [-]", "not measured"};

  // Multigrid on meshes, (4.7a) - (4.7c).
  Rule<int> smoother_degree{3, "linear.smoother_degree", "degree of the smoother [-]",
                            "least time, 15 iterations to 1e-8 in the plane, 20 in space"};
  Rule<double> smoother_ratio{10, "linear.smoother_ratio",
                              "largest over smallest damped eigenvalue, order 1, and MueLu's [-]", "the same"};
  Rule<double> smoother_ratio_order_two{16, "linear.smoother_ratio_order_two", "the same of order 2 [-]", "the same"};
  Rule<int> lanczos_steps{10, "linear.lanczos_steps", "steps for the largest eigenvalue [-]",
                          "they find it to a few per cent"};
  Rule<double> lanczos_margin{1.08, "linear.lanczos_margin", "factor on the eigenvalue found [-]",
                              "covers these per cent"};
  Rule<double> most_on_coarse_meshes{1, "linear.most_on_coarse_meshes",
                                     "contact on coarse meshes, and in MueLu's hierarchy, over own stiffness [-]",
                                     "with 1/4 or 4 CG takes a fourth more iterations"};
  Rule<double> slight_change{0.1, "linear.slight_change", "change over own stiffness that is left to CG [-]",
                             "a solver that misses points that close is useless, (4.12)"};
  Rule<double> changed_part{0.1, "linear.changed_part", "changed part of contact that renews MueLu below order 2 [-]",
                            "a renewal takes two CG iterations, the old one costs a step about as many"};

  // MueLu's hierarchy, (4.8), (4.9).
  Rule<int> layers{2, "linear.layers", "layers of a patch around changed nodes in 2D [-]",
                   "the second saves one CG iteration in ten; in 3D a layer saves as much for ten times the factor"};
  Rule<double> patch_work{3e3, "linear.patch_work", "multiplications of a patch's factor, a row of H [-]",
                          "a fraction of a set-up"};
  Rule<int> muelu_degree{2, "linear.muelu_degree", "degree of MueLu's smoother [-]", "not measured"};
  Rule<int> strong_degree{8, "linear.strong_degree", "degree of the stronger smoother [-]",
                          "Q2, nu = 0.49999 with Multigrid = mesh fails without it"};
  Rule<double> strong_ratio{50, "linear.strong_ratio", "ratio of the stronger smoother [-]", "the same"};
  Rule<GO> least_coarsening{4, "linear.least_coarsening", "rows over those of the last level on ranks [-]",
                            "what is solved directly has gone to one rank"};

  // Factors, (4.10) - (4.12).
  Rule<GO> most_rows_on_each_rank{
      5200, "linear.most_rows_on_each_rank",
      "rows up to which each rank has the whole factor, in Cuthill-McKee's order if it makes a narrow band, and the "
      "coarsest mesh is factored [-]",
      "a solve then takes one sum over the ranks"};
  Rule<int> first_iterations_of_factor{3, "linear.first_iterations_of_factor",
                                       "iterations before a factor is judged [-]", "(4.12)"};
  Rule<double> short_time{5e-3, "linear.short_time", "a factor made for the slightest change [s]", "not measured"};
  Rule<double> kept_of_free{0.25, "linear.kept_of_free",
                            "entries of an update, and of the model that chooses states, over the free memory [-]",
                            "not measured"};
};
inline constexpr_rules LinearRules linear_rules;

/// What things take, by constants of one core: a choice by them is the same in every run.
struct CostModel {
  // A CG iteration with multigrid.
  Rule<double> entry{8e-9, "cost.entry", "an entry of K in a CG iteration [s]", "iterations on one core"};
  Rule<double> repeated_entry{1e-9, "cost.repeated_entry", "such an entry where rows of K repeat [s]", "within a half"};
  Rule<double> repeated_row{70e-9, "cost.repeated_row", "a row of K where rows repeat [s]", "within a half"};
  Rule<double> entry_against_factor{
      2e-9, "cost.entry_against_factor", "a repeated entry against a factor in 2D [s]",
      "vectors count for more there; without it plane Q1 with nu = 0.4999 takes 2.5 times as long"};
  Rule<double> gpu{50, "cost.gpu", "times as fast on a GPU as on a core [-]", "an H100"};
  Rule<double> launches{2e-3, "cost.launches", "of a cycle on a GPU at least [s]", "an H100"};
  // MUMPS, of 1e7 to 1e11 multiplications: within 15 % of the times.
  Rule<double> analysis_of_row{5e-6, "cost.analysis_of_row", "of the analysis, a row [s]", "not measured"};
  Rule<double> dense{3.5e-11, "cost.dense", "of a multiplication [s]", "factors in the plane and in space"};
  Rule<double> factor_entry{3.1e-8, "cost.factor_entry", "of an entry of the factor [s]", "the same"};
  Rule<double> factor_entry_in_solve{3e-9, "cost.factor_entry_in_solve", "the same in a solve [s]", "the same"};
  Rule<double> columns_for_one{12, "cost.columns_for_one", "columns at contact nodes for one right side [-]",
                               "10 to 24"};
  Rule<double> gain{0.6, "cost.gain", "P ranks, or threads, are P to this power times as fast [-]", "two ranks"};
  // A band factor: LAPACK works by blocks where it is wide.
  Rule<double> wide{64, "cost.wide", "width of a wide band [-]", "LAPACK's blocks"};
  Rule<double> wide_band{1.5e-11, "cost.wide_band", "of a multiplication in a wide band [s]", "one core"};
  Rule<double> narrow_band{1e-10, "cost.narrow_band", "of a multiplication in a narrow band [s]", "one core"};
  Rule<double> band_entry{6e-9, "cost.band_entry", "of an entry of the band [s]", "one core"};
  Rule<double> band_row_in_solve{18e-9, "cost.band_row_in_solve", "of a row in a solve [s]", "one core"};
  Rule<double> band_entry_in_solve{1e-9, "cost.band_entry_in_solve", "of an entry in a solve [s]", "one core"};
};
inline constexpr_rules CostModel cost_model;

/// Newton's method, (4.2) - (4.6).
struct NewtonRules {
  Rule<double> forcing{5e-3, "newton.forcing",
                       "|r|/|F| while the Hessian changes, and what a step leaves of |F| at least [-]",
                       "a rough direction leads down as well as an exact one"};
  Rule<double> largest_residual{0.1, "newton.largest_residual",
                                "loosest linear solve: |r| over the right side; of the last one over the target "
                                "of |F| [-]",
                                "not measured"};
  Rule<double> cut_short{0.02, "newton.cut_short", "length of a step that ended at a kink [-]", "(4.6)"};
  Rule<double> to_the_minimum{1e-6, "newton.to_the_minimum", "|1 - length| of a step that has met no kink [-]",
                              "nothing is left to gain along it"};
  Rule<int> most_earlier_directions{9, "newton.most_earlier_directions",
                                    "directions to minimize within, besides the new one [-]",
                                    "5: a slender body takes 75 steps instead of 53; 20 add nothing"};
  Rule<int> most_inner_steps{
      50, "newton.most_inner_steps",
      "steps of an iteration within another one: interior path, choices by a coarser mesh, "
      "prediction, given bounds of friction, line search; returns to choices once Newton has begun [-]",
      "measurements.md, 2026-11-30: no bound from 20 to 50 was met"};
  Rule<int> most_halvings{10, "newton.most_halvings",
                          "of an interval, in the search for the pieces of a line function [-]", "not measured"};
  Rule<double> full_step{0.5, "newton.full_step",
                         "length of a step that counts as full; steps that are shorter in the mean are slow [-]",
                         "(5.9a)"};
  Rule<int> most_idle{2, "newton.most_idle", "full steps on one piece without a fall [-]", "not measured"};
};
inline constexpr_rules NewtonRules newton_rules;

/// Bounds of rounding errors. They steer nothing but what exact numbers would give.
struct Rounding {
  double sum = 1e-12;                                           ///< of sums over unknowns, relative
  double block = 1e-13;                                         ///< of entries of a matrix, over the node's own block
  double product = 10 * std::numeric_limits<double>::epsilon(); ///< of H x, over what the largest entry would give
};
inline constexpr Rounding rounding;

} // namespace rpc::solver
