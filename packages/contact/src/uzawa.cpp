#include "rpc/contact/uzawa.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/interrupt.hpp"

#include <cmath>
#include <sstream>

namespace rpc::contact
{
namespace
{

constexpr double enough = 0.1; ///< an update that leaves more of the violation calls for a higher penalty

std::string verdict(const UzawaResult &result, const UzawaOptions &options)
{
  std::ostringstream text;
  const OptimalityResiduals &c = result.residuals;
  if (result.converged)
    text << "contact law, equilibrium and energies hold to " << options.tolerance;
  else
    text << result.iterations << " Uzawa iterations were not enough: KKT residual " << c.kkt_residual
         << ", equilibrium residual " << c.equilibrium_residual << ", energy balance " << c.energy_balance
         << ", duality gap " << c.duality_gap << ", tolerance " << options.tolerance;
  return text.str();
}

} // namespace

Teuchos::ParameterList valid_uzawa_parameters()
{
  Teuchos::ParameterList valid("Uzawa");
  valid.set(
      "Tolerance", 1e-8,
      "Bound on the certificate (its four parts) and on the stopping test, dimensionless, > 0. Below its "
      "default the pressures follow: an active-set start aims at ten times that, of the largest, for their errors.");
  valid.set("Maximum Iterations", 50, "Multiplier updates at most, > 0.");
  valid.set("Stopping Test", "certificate",
            "`certificate`: stop as soon as contact law and equilibrium hold; `multiplier change`: the paper's test, "
            "|change of l|/|l| < Tolerance.");
  return valid;
}

UzawaOptions uzawa_options(const Teuchos::ParameterList &list)
{
  UzawaOptions options;
  options.tolerance = list.get<double>("Tolerance");
  options.max_iterations = list.get<int>("Maximum Iterations");
  const auto &test = list.get<std::string>("Stopping Test");
  RPC_REQUIRE(options.tolerance > 0 && options.tolerance < 1,
              "deck: \"Uzawa->Tolerance\" must be in (0, 1), got " << options.tolerance);
  RPC_REQUIRE(options.max_iterations > 0,
              "deck: \"Uzawa->Maximum Iterations\" must be > 0, got " << options.max_iterations);
  RPC_REQUIRE(test == "certificate" || test == "multiplier change",
              "deck: \"Uzawa->Stopping Test\" must be one of certificate, multiplier change, got \"" << test << "\"");
  options.test = test == "certificate" ? UzawaTest::optimality : UzawaTest::multiplier_change;
  return options;
}

UzawaResult uzawa(SmoothedFunctional &functional, Vector &u, const std::function<MinimizeResult(int)> &minimize,
                  const std::function<OptimalityResiduals(const Vector &)> &optimality_residuals,
                  const UzawaOptions &options, const std::function<void(const UzawaResult &)> &report)
{
  UzawaResult result;
  bool stop = false;
  while (!stop && result.iterations < options.max_iterations) {
    if (result.iterations > 0) functional.move_origin(u); // what is left is small, and wants its digits
    const MinimizeResult inner = minimize(result.iterations + 1);
    result.newton_iterations.push_back(inner.newton_iterations);
    ++result.iterations;
    result.multiplier_change =
        inner.states_confirmed ? functional.take_piece_pressures(u) : functional.update_multipliers(u);
    const OptimalityResiduals previous = result.residuals;
    result.residuals = optimality_residuals(functional.displacement(u));
    const bool holds = result.residuals.holds(options.tolerance);
    const bool changes = result.multiplier_change >= options.tolerance;
    stop = holds && (options.test == UzawaTest::optimality || !changes);
    report(result);
    if (holds) continue;
    if (interrupted(*u.getMap()->getComm())) {
      result.reason = interruption() + " in Uzawa iteration " + std::to_string(result.iterations);
      break;
    }
    const bool slow = result.iterations > 1 && !(result.residuals.worst() <= enough * previous.worst());
    const bool raised = slow && functional.raise_penalty();
    // A minimization that stopped at the rounding of an ill-conditioned scene is good enough to go on from, while that helps.
    if ((slow && !raised) || std::isnan(result.residuals.worst())) {
      result.reason = inner.converged
                          ? verdict(result, options) + ": more iterations do not help, it is rounding that is left"
                          : inner.reason;
      break;
    }
  }
  u.assign(functional.displacement(u));
  result.converged = stop;
  if (stop || result.reason.empty()) result.reason = verdict(result, options);
  return result;
}

} // namespace rpc::contact
