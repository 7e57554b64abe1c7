#include "rpc/analysis/solve_step.hpp"
#include "rpc/core/error.hpp"

#include <algorithm>

namespace rpc::analysis
{

Teuchos::ParameterList valid_uzawa_parameters()
{
  Teuchos::ParameterList valid("Uzawa");
  valid.set(
      "Tolerance", 1e-8,
      "Bound on the four optimality residuals and on the stopping test, dimensionless, > 0. Below its default the "
      "active-set iteration accepts errors of the pressures up to 10 x Tolerance, relative to the largest "
      "pressure.");
  valid.set("Maximum Iterations", 50, "Multiplier updates at most, > 0.");
  valid.set("Stopping Test", "optimality",
            "`optimality`: stop as soon as contact law and equilibrium hold; `multiplier change`: the paper's test, "
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
  RPC_REQUIRE(test == "optimality" || test == "multiplier change",
              "deck: \"Uzawa->Stopping Test\" must be one of optimality, multiplier change, got \"" << test << "\"");
  options.test = test == "optimality" ? UzawaTest::optimality : UzawaTest::multiplier_change;
  return options;
}

Teuchos::ParameterList valid_prediction_parameters()
{
  Teuchos::ParameterList valid("Nested Iteration");
  valid.set("Enabled", true,
            "Whether a solution on a coarser mesh, itself predicted by one on a still coarser mesh, is the start: for "
            "boxes and "
            ".geo files of 500 nodes and more.");
  valid.set("Coarsening", 4.,
            "Ratio of cell lengths from one mesh to the next, in [1.5, 100]. Boxes of order 1 are halved until about "
            "so few nodes are left.");
  valid.set("Tolerance", 1e-4, "Bound on |F|_2/|load|_2 on the coarser meshes, in (0, 1).");
  return valid;
}

PredictionOptions prediction_options(const Teuchos::ParameterList &list)
{
  const PredictionOptions options{list.get<bool>("Enabled"), list.get<double>("Coarsening"),
                                  list.get<double>("Tolerance")};
  RPC_REQUIRE(options.coarsening >= 1.5 && options.coarsening <= 100,
              "deck: \"Nested Iteration->Coarsening\" must be in [1.5, 100], got " << options.coarsening);
  RPC_REQUIRE(options.tolerance > 0 && options.tolerance < 1,
              "deck: \"Nested Iteration->Tolerance\" must be in (0, 1), got " << options.tolerance);
  return options;
}

ActiveSetTolerances active_set_tolerances(const StepOptions &options)
{
  ActiveSetTolerances tolerances;
  // Newton's default is near what rounding leaves; who asks for more gets it.
  const double given = options.newton.residual_tolerance;
  tolerances.residual =
      given < solver::NewtonOptions().residual_tolerance ? given : std::max(given, tolerances.residual);
  tolerances.pressure = std::min(tolerances.pressure, 10 * options.uzawa.tolerance); // (5.10)
  return tolerances;
}

} // namespace rpc::analysis
