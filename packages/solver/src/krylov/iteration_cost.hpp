// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/stiffness_operator.hpp"

namespace rpc::solver
{

/// What a CG iteration with multigrid takes [s], by constants of one machine: a choice by them is the same in every run.
struct IterationSeconds {
  double counted = 0;     ///< what decisions for a factor use, (4.10): less than the true time where rows of K repeat
  double measured = 0;    ///< the true time, within half of it
  double on_one_rank = 0; ///< measured, times the number of ranks
};

/// Collective.
IterationSeconds seconds_of_iteration(const StiffnessOperator &K);

/// Whether a band factor takes no more time than a few CG iterations with multigrid, on hosts those of one rank: several ranks share an
/// iteration, but slender bodies need the more of them.                                                           (4.10e)
/// @param width  of the band below the diagonal
bool is_narrow(double unknowns, double width, const IterationSeconds &iteration);

} // namespace rpc::solver
