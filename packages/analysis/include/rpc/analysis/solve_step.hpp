#pragma once

#include "rpc/analysis/active_set.hpp"
#include "rpc/analysis/problem.hpp"
#include "rpc/analysis/uzawa.hpp"
#include "rpc/contact/result.hpp"
#include "rpc/solver/newton.hpp"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rpc::analysis
{

/// Solutions on coarser meshes to start from.
struct PredictionOptions {
  bool enabled = true;
  double coarsening = 4;   ///< ratio of cell lengths from one mesh to the next, > 1
  double tolerance = 1e-4; ///< |F|_2 / |load|_2 there
};

/// Parameters of the deck's `Nested Iteration` sublist.
Teuchos::ParameterList valid_prediction_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
PredictionOptions prediction_options(const Teuchos::ParameterList &list);

struct StepOptions {
  UzawaOptions uzawa;
  solver::NewtonOptions newton;
  PredictionOptions prediction;
};

/// When the active-set iteration is content, by the options for Newton and Uzawa. (5.10)
ActiveSetTolerances active_set_tolerances(const StepOptions &options);

/// The same scene on the next coarser mesh; null where there is none.
/// @param finer  the scene on the mesh before   @param level  1 for the mesh after the finest, 2 for the one after it, ...
using CoarserProblem = std::function<std::shared_ptr<const Problem>(const Problem &finer, int level)>;

/// Why no coarser mesh is to predict the solution on this one; empty if one is.
std::string no_prediction(const fem::Discretization &d, const contact::ContactNodes &contact,
                          const PredictionOptions &options);

/// What is told while a step is solved; empty functions tell nothing.
struct Progress {
  /// @param uzawa  number of the Uzawa iteration, from 1
  std::function<void(int uzawa, const solver::NewtonStep &, const contact::StateCounts &)> newton;
  std::function<void(const UzawaResult &)> uzawa;
};

/// What was done on a coarser mesh.
struct LevelWork {
  std::size_t dofs = 0;
  int newton_iterations = 0;
  std::vector<int> linear_iterations; ///< per solve
  int preconditioner_setups = 0;
  double seconds = 0; ///< with all coarser ones
};

/// The solution of one step, and how it was found. Plain data: it outlives its problem.
struct StepSolution {
  Step step;                   ///< what was solved: loads, prescribed displacements, contact points
  RCP<Vector> u;               ///< (owned dofs) displacement from 0 [m]
  contact::ContactState state; ///< to start the next step from; its displacement is u
  UzawaResult uzawa;
  contact::ContactResult contact;
  double energy = 0;                            ///< J(u) [J], in 2D per m
  double energy_norm_squared = 0;               ///< a(u, u) [J], in 2D per m
  std::vector<std::array<double, 3>> reactions; ///< of each Dirichlet condition on the body [N], in 2D per m

  solver::LinearSolverCounts linear;                ///< of this step
  int line_search_steps = 0;                        ///< Newton's, where the active-set iteration was not enough
  std::vector<LevelWork> levels;                    ///< coarser meshes that predicted the solution, from the coarsest
  std::string not_predicted;                        ///< why no coarser mesh did; empty if one did
  double prediction_seconds = 0, solve_seconds = 0; ///< solve: without set-ups of multigrid
};

/// Where a step may start from.
struct Starts {
  /// Such as that of the step before or of another mesh: the nearest to equilibrium is taken.
  std::vector<contact::ContactState> states;
  /// Asked where that is far from equilibrium; empty, or returns none, where there is no better start. Collective.
  /// @param work  becomes that on coarser meshes, from the coarsest
  std::function<std::optional<contact::ContactState>(std::vector<LevelWork> &work)> predicted;
};

/// The algorithm: predict, choose the active set, Newton with exact line search, Uzawa, optimality residuals. Collective.
/// @param starts   without states coarser meshes predict one
/// @param coarser  empty: there are no coarser meshes
/// @throws rpc::Error (bad_input) where NOX refuses its options; failing to converge is in the result
StepSolution solve_step(const Problem &problem, const Step &step, const StepOptions &options, const Starts &starts = {},
                        const CoarserProblem &coarser = {}, const Progress &progress = {});

} // namespace rpc::analysis
