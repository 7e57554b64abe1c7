#include "rpc/analysis/uzawa.hpp"

#include "rpc/core/interrupt.hpp"

#include <cmath>
#include <sstream>

namespace rpc::analysis
{
namespace
{

constexpr double fast = 0.1;           // an update that leaves more of the largest residual calls for a higher penalty
constexpr double near_solution = 1e-3; // residuals below it can be rounding
constexpr double fast_with_bounds = 0.8; // the same of some updates of friction's bounds

std::string verdict(const UzawaResult &result, const UzawaOptions &options)
{
  std::ostringstream text;
  const contact::OptimalityResiduals &r = result.residuals;
  text << (result.converged ? "converged" : std::to_string(result.iterations) + " Uzawa iterations were not enough")
       << ": KKT residual " << r.kkt_residual << ", equilibrium residual " << r.equilibrium_residual
       << ", energy balance " << r.energy_balance << ", duality gap " << r.duality_gap << ", tolerance "
       << options.tolerance;
  return text.str();
}

} // namespace

bool is_over(UzawaResult &result, const Minimization &found, const double previous, const UzawaOptions &options,
             const Comm &comm, const std::function<bool()> &raise_penalty)
{
  const auto ends = [&](const bool converged, const std::string &reason) {
    result.converged = converged;
    result.reason = reason.empty() ? verdict(result, options) : reason;
    return true;
  };
  const bool holds = result.residuals.holds(options.tolerance);
  const bool changes = result.multiplier_change >= options.tolerance;
  if (holds && (options.test == UzawaTest::optimality || !changes)) return ends(true, "");
  const bool last = result.iterations == options.max_iterations;
  if (holds) return last && ends(false, "");
  if (interrupted(comm))
    return ends(false, interruption() + " in Uzawa iteration " + std::to_string(result.iterations));
  const double worst = result.residuals.worst();
  const bool slow = result.iterations > 1 && !(worst <= (found.bounds_follow ? fast_with_bounds : fast) * previous);
  const bool raised = slow && !found.bounds_follow && raise_penalty(); // (5.12)
  // A minimization that stopped at the rounding of an ill-conditioned scene is good enough to go on from, while that helps.
  if ((slow && !raised) || std::isnan(worst))
    return ends(false, found.converged ? verdict(result, options) + ": more iterations do not help" +
                                             (worst < near_solution ? ", what remains is rounding" : "")
                                       : found.reason);
  return last && ends(false, "");
}

} // namespace rpc::analysis
