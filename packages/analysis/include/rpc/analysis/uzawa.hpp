// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/contact/optimality_residuals.hpp"

#include <Teuchos_ParameterList.hpp>
#include <functional>
#include <string>
#include <vector>

namespace rpc::analysis
{

/// What ends the Uzawa iteration.
enum class UzawaTest {
  optimality,       ///< contact law and equilibrium hold: no solve is spent on confirming it
  multiplier_change ///< that of the paper's section 4: relative change of the multipliers
};

struct UzawaOptions {
  double tolerance = 1e-8; ///< of the test, and of the optimality residuals, dimensionless, > 0
  int max_iterations = 50; ///< > 0
  UzawaTest test = UzawaTest::optimality;
};

/// Parameters of the deck's `Uzawa` sublist.
Teuchos::ParameterList valid_uzawa_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
UzawaOptions uzawa_options(const Teuchos::ParameterList &list);

/// What found the states of contact: choices of states by pressures, after these choices by a coarser mesh, after those Newton's method, or
/// after that the interior-point method. With friction it says choices.
enum class FoundBy { choices, coarse_choices, newton, interior_path };

/// What came out of one minimization of the smoothed functional.
struct Minimization {
  bool converged = false;
  int steps = 0;                     ///< each one linear solve
  std::string reason;                ///< why not, if not
  bool active_set_confirmed = false; ///< u is the minimum for the iterate's active set, whose pressures obey the law
  int line_search_steps = 0;         ///< of the steps, those of Newton's with its line search
  int coarse_choices = 0;            ///< steps to states that a coarser mesh chose
  bool bounds_follow =
      false; ///< friction's bounds were those of the iteration before: Coulomb's law by Tresca problems
  FoundBy found_by = FoundBy::choices;
};

/// How the Uzawa iteration went, so far or to its end.
struct UzawaResult {
  bool converged = false; ///< the optimality residuals are small enough
  std::string reason;
  bool reason_has_residuals = false; ///< the reason tells the residuals
  bool friction_unsettled = false;   ///< it ended while friction's bounds followed the pressures, without convergence
  int iterations = 0;
  std::vector<int> newton_iterations; ///< per Uzawa iteration
  double multiplier_change = 0;       ///< of the last one, relative
  contact::OptimalityResiduals residuals;
};

/// Whether an Uzawa iteration was the last one: it has converged, may not go on, or does not get any further even
/// with higher penalties, doc/theory.md (5.12). Writes `converged` and `reason` then.
/// @param result    with the residuals of this iteration   @param found  its minimization
/// @param previous  largest residual of the iteration before, or of some iterations before where friction's bounds follow; infinite: there
///                  was none
/// @param raise_penalty  asked for where an iteration was slow; returns whether anything could be raised. Collective
/// @param rounding       asked for where nothing helps: see contact::residual_of_rounding(). Collective
bool is_over(UzawaResult &result, const Minimization &found, double previous, const UzawaOptions &options,
             const Comm &comm, const std::function<bool()> &raise_penalty, const std::function<double()> &rounding);

} // namespace rpc::analysis
