// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/active_set.hpp"
#include "rpc/analysis/load_history.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"

#include <Teuchos_Array.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace rpc::analysis
{
namespace
{

constexpr double unset = std::numeric_limits<double>::quiet_NaN();
constexpr double most_times = 1e6;

} // namespace

Teuchos::ParameterList valid_uzawa_parameters()
{
  Teuchos::ParameterList valid("Uzawa");
  valid.set(
      "Tolerance", 1e-8,
      "Bound on the four optimality residuals and on the stopping test, dimensionless, > 0. Below its default the "
      "active-set iteration accepts errors of the pressures up to 10 x Tolerance, relative to the largest "
      "pressure.");
  valid.set("Maximum Iterations", 50, "Multiplier updates at most, > 0.");
  set_words(
      valid, "Stopping Test", {"optimality", "multiplier change"},
      "`optimality`: stop as soon as contact law and equilibrium hold; `multiplier change`: the paper's test too, "
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
            "boxes, files of gmsh and refined meshes of more than 1000 unknowns, of any size with friction, but for "
            "quadrilaterals and hexahedra of a .msh that do not lie in layers.");
  valid.set("Coarsening", 4.,
            "Ratio of cell lengths from one mesh to the next, in [1.5, 100]. Boxes of order 1 are halved until the "
            "direction with most cells has so few; refined meshes and those of a .msh go to their parents, in space by "
            "half of it, and for the tetrahedra of a .msh by one mesh more.");
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

Teuchos::ParameterList valid_steps_parameters()
{
  Teuchos::ParameterList valid("Steps");
  valid.set(
      "Times", Teuchos::Array<double>(),
      "Times t of the load steps, rising: the foundation keeps the dents of each for the next. Empty: one step, at "
      "`Time`.");
  valid.set("From", unset, "First of times in equal distances, in place of `Times`, with `To` and `Step`.");
  valid.set("To", unset, "Last of them, > `From`.");
  valid.set("Step", unset, "Their distance, > 0. The last may be shorter.");
  valid.set("Write Every", 1, "Every N-th of the times goes into the Exodus file, and the last one; N > 0.");
  valid.set("Max Halvings", 6,
            "A step that does not converge is halved, and its halves, so many times at most, >= 0. Where it is given, "
            "halvings for `Energy Tolerance` count too; else these are 20 at most.");
  valid.set(
      "Energy Tolerance", unset,
      "A step is halved where work less energies changes in it by more than this share of the largest energy, > "
      "0: the work is "
      "wrong where contact opens or closes within a step. A run that does not keep it to the end of a step goes on, "
      "and ends with exit code 4. nan, which is to leave it out: no step is.");
  valid.set("Checkpoint Every", 0,
            "After every N-th step a checkpoint is written, <deck>.checkpoint-NUMBER.e, from which --restart goes on; "
            "0: none.");
  return valid;
}

namespace
{

/// From, From + Step, ..., To.
std::vector<double> equal_times(const Teuchos::ParameterList &list)
{
  const double from = list.get<double>("From"), to = list.get<double>("To"), step = list.get<double>("Step");
  const auto given = [](const double value) { return !std::isnan(value); };
  if (!given(from) && !given(to) && !given(step)) return {};
  RPC_REQUIRE(given(from) && given(to) && given(step),
              "deck: \"Steps->From\", \"To\" and \"Step\" belong together, got " << from << ", " << to << " and "
                                                                                 << step);
  RPC_REQUIRE(list.get<Teuchos::Array<double>>("Times").empty(),
              "deck: \"Steps\" has \"Times\" and \"From\"; one of them gives the times");
  RPC_REQUIRE(std::isfinite(from) && std::isfinite(to) && to > from,
              "deck: \"Steps->To\" must be finite and > \"From\" = " << from << ", got " << to);
  RPC_REQUIRE(step > 0 && (to - from) / step <= most_times,
              "deck: \"Steps->Step\" must be > 0 and give at most " << most_times << " times, got " << step);
  std::vector<double> times;
  const double close = 1e-9 * step; // a multiple of the step, but for rounding
  for (int k = 0; from + k * step < to - close; ++k) times.push_back(from + k * step);
  times.push_back(to);
  return times;
}

} // namespace

StepsOptions steps_options(const Teuchos::ParameterList &list)
{
  const auto &listed = list.get<Teuchos::Array<double>>("Times");
  std::vector<double> times = equal_times(list);
  times.insert(times.end(), listed.begin(), listed.end());
  StepsOptions options{std::move(times), list.get<int>("Write Every"), list.get<int>("Max Halvings"),
                       list.get<int>("Checkpoint Every")};
  for (std::size_t k = 0; k < options.times.size(); ++k) {
    RPC_REQUIRE(std::isfinite(options.times[k]), "deck: \"Steps->Times\" must be finite, got " << options.times[k]);
    RPC_REQUIRE(k == 0 || options.times[k] > options.times[k - 1],
                "deck: \"Steps->Times\" must rise, got " << options.times[k] << " after " << options.times[k - 1]);
  }
  RPC_REQUIRE(options.write_every > 0, "deck: \"Steps->Write Every\" must be > 0, got " << options.write_every);
  RPC_REQUIRE(options.max_halvings >= 0 && options.max_halvings <= 30,
              "deck: \"Steps->Max Halvings\" must be in [0, 30], got " << options.max_halvings);
  if (const double tolerance = list.get<double>("Energy Tolerance"); !std::isnan(tolerance)) {
    RPC_REQUIRE(tolerance > 0, "deck: \"Steps->Energy Tolerance\" must be > 0, got " << tolerance);
    options.energy_tolerance = tolerance;
  }
  if (!list.getEntryPtr("Max Halvings")->isDefault()) options.balance_halvings = options.max_halvings;
  RPC_REQUIRE(options.checkpoint_every >= 0,
              "deck: \"Steps->Checkpoint Every\" must be >= 0, got " << options.checkpoint_every);
  return options;
}

ActiveSetTolerances active_set_tolerances(const StepOptions &options)
{
  ActiveSetTolerances tolerances;
  // Newton's default is near the rounding; smaller tolerances of a deck are taken as they are.
  const double given = options.newton.residual_tolerance;
  tolerances.residual =
      given < solver::NewtonOptions().residual_tolerance ? given : std::max(given, tolerances.residual);
  tolerances.pressure =
      std::max(std::min(tolerances.pressure, 10 * options.uzawa.tolerance), options.on_the_way); // (5.10)
  return tolerances;
}

} // namespace rpc::analysis
