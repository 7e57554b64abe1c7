// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/load_history.hpp"

#include <string>
#include <vector>

namespace rpc::analysis
{

/// Steps in which work and energies differ by more than a share of the largest energy. doc/theory.md (11.3a)
struct OutOfBalance {
  int steps = 0;    ///< their number
  double share = 0; ///< the largest one
  double at = 0;    ///< t of that step
  int parts = 1;    ///< in which it was solved
};

/// @param history   from the first step; those that have not converged do not count
/// @param share     > 0
/// @param rounding  what differences of energies may be without a meaning [J], in 2D per m
OutOfBalance out_of_balance(const std::vector<StepRecord> &history, double share, double rounding = 0);

/// Why a run has not kept its energy tolerance; empty if it has.
/// @param steps  of the run
std::string not_kept(const OutOfBalance &off, double tolerance, std::size_t steps);

} // namespace rpc::analysis
