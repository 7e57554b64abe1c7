// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/energy_tolerance.hpp"

#include <cmath>
#include <sstream>

namespace rpc::analysis
{

OutOfBalance out_of_balance(const std::vector<StepRecord> &history, const double share, const double rounding)
{
  OutOfBalance off;
  Energies before;
  for (const StepRecord &step : history) {
    if (!step.converged) break;
    const double of_step = relative_imbalance(before, step.energies);
    const double change = std::abs(step.energies.imbalance - before.imbalance);
    before = step.energies;
    if (!(of_step > share) || change <= rounding) continue;
    ++off.steps;
    if (of_step <= off.share) continue;
    off.share = of_step;
    off.at = step.time;
    off.parts = step.parts;
  }
  return off;
}

std::string not_kept(const OutOfBalance &off, const double tolerance, const std::size_t steps)
{
  if (off.steps == 0) return "";
  std::ostringstream text;
  text << "in " << off.steps << " of " << steps << " steps work and energies differ by more than "
       << "\"Steps->Energy Tolerance\" = " << tolerance << " of the largest energy, by " << off.share
       << " at t = " << off.at << " in " << off.parts << (off.parts == 1 ? " part" : " parts")
       << ". A field that jumps in t, such as the place of an obstacle, does so in steps of any length, and so does "
          "one that "
          "puts the body into the foundation at the start: let it change over some time. Else give \"Steps->Times\" "
          "that are closer to each other there, more \"Steps->Max "
          "Halvings\", or a larger tolerance";
  return text.str();
}

} // namespace rpc::analysis
