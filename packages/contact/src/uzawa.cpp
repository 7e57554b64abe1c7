#include "rpc/contact/uzawa.hpp"

#include "rpc/core/error.hpp"

#include <sstream>

namespace rpc::contact
{

Teuchos::ParameterList valid_uzawa_parameters()
{
  Teuchos::ParameterList valid("Uzawa");
  valid.set("Tolerance", 1e-8,
            "Bound on the certificate (KKT and equilibrium residual) and on the stopping test, dimensionless, > 0.");
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
  options.test = test == "certificate" ? UzawaTest::certificate : UzawaTest::multiplier_change;
  return options;
}

UzawaResult uzawa(SmoothedFunctional &functional, Vector &u, const std::function<MinimizeResult(int)> &minimize,
                  const double stiffness_scale, const UzawaOptions &options,
                  const std::function<void(const UzawaResult &)> &report)
{
  UzawaResult result;
  bool stop = false;
  while (!stop && result.iterations < options.max_iterations) {
    const MinimizeResult inner = minimize(result.iterations + 1);
    result.newton_iterations.push_back(inner.newton_iterations);
    ++result.iterations;
    result.multiplier_change = functional.update_multipliers(u);
    result.certificate = {functional.equilibrium_residual(u), functional.contact_law_residual(u, stiffness_scale)};
    const bool holds = result.certificate.holds(options.tolerance);
    const bool changes = result.multiplier_change >= options.tolerance;
    stop = holds && (options.test == UzawaTest::certificate || !changes);
    report(result);
    // A minimization that stopped at the rounding of an ill-conditioned scene is good enough to go on from.
    if (!inner.converged && !(result.certificate.equilibrium_residual <= options.tolerance)) {
      result.reason = inner.reason;
      return result;
    }
  }
  result.converged = stop;
  std::ostringstream reason;
  if (stop)
    reason << "contact law and equilibrium hold to " << options.tolerance;
  else
    reason << options.max_iterations << " Uzawa iterations were not enough: KKT residual "
           << result.certificate.kkt_residual << ", equilibrium residual " << result.certificate.equilibrium_residual
           << ", tolerance " << options.tolerance;
  result.reason = reason.str();
  return result;
}

} // namespace rpc::contact
