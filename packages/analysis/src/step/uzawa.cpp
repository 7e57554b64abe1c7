// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/uzawa.hpp"

#include "rpc/analysis/rules.hpp"
#include "rpc/core/causes.hpp"
#include "rpc/core/headway.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/rules.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace rpc::analysis
{
namespace
{

std::string verdict(const UzawaResult &result, const UzawaOptions &options)
{
  std::ostringstream text;
  const contact::OptimalityResiduals &r = result.residuals;
  text << std::setprecision(2)
       << (result.converged ? "converged" : std::to_string(result.iterations) + " Uzawa iterations were not enough")
       << ": KKT residual " << r.kkt_residual << ", equilibrium residual " << r.equilibrium_residual
       << ", energy balance " << r.energy_balance << ", duality gap " << r.duality_gap << ", tolerance "
       << std::setprecision(6) << options.tolerance;
  return text.str();
}

} // namespace

bool is_over(UzawaResult &result, const Minimization &found, const double previous, const UzawaOptions &options,
             const Comm &comm, const std::function<bool()> &raise_penalty, const std::function<double()> &rounding)
{
  const auto ends = [&](const bool converged, const std::string &cause) {
    result.converged = converged;
    result.friction_unsettled = !converged && found.bounds_follow;
    result.reason = verdict(result, options);
    result.reason_has_residuals = true;
    if (!cause.empty()) result.reason += ": " + cause;
    return true;
  };
  const auto ends_with = [&](const Cause &cause) {
    ends(false, because(cause));
    if (!found.converged && !found.reason.empty()) {
      result.reason = found.reason;
      result.reason_has_residuals = false;
    }
    return true;
  };
  const bool holds = result.residuals.holds(options.tolerance);
  const bool changes = result.multiplier_change >= options.tolerance;
  if (holds && (options.test == UzawaTest::optimality || !changes)) return ends(true, "");
  const bool last = result.iterations == options.max_iterations;
  if (holds) return last && ends(false, because(causes::uzawa_iterations));
  if (interrupted(comm)) {
    result.reason = interruption() + " in Uzawa iteration " + std::to_string(result.iterations);
    return true;
  }
  const double worst = result.residuals.worst();
  const double good = found.bounds_follow ? headway_rules.falls : step_rules.fast;
  const bool slow = result.iterations > 1 && Headway({good, 0}).add(worst, previous) == Headway::Answer::stuck;
  const bool raised = slow && !found.bounds_follow && raise_penalty(); // (5.12)
  // A minimization that stopped at the rounding of an ill-conditioned scene is good enough to go on from, while that helps.
  if ((slow && !raised) || std::isnan(worst)) {
    const double unbalanced = result.residuals.equilibrium_residual;
    if (unbalanced > options.tolerance && unbalanced <= step_rules.of_rounding * rounding())
      return ends(false, because(worst < 1 ? causes::rounding : causes::breakdown)); // a tolerance is below 1
    return ends_with(found.bounds_follow ? causes::stuck_by_friction : causes::stuck);
  }
  return last && ends_with(causes::uzawa_iterations);
}

} // namespace rpc::analysis
