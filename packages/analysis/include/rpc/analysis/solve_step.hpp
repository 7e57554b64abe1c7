// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/coarse_choice.hpp"
#include "rpc/analysis/solver_state.hpp"
#include "rpc/analysis/uzawa.hpp"
#include "rpc/contact/iterate.hpp"
#include "rpc/contact/result.hpp"
#include "rpc/solver/newton.hpp"

#include <array>
#include <functional>
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
  bool from_rest =
      true; ///< where friction's states do not converge, the step is tried once more from the last of the given starts
  bool low_penalties =
      false; ///< where friction's states do not converge, the step is tried once more with low penalties (12.12a)
  bool starts_near =
      false;             ///< from the solution for another place of the obstacle: the first solve is accurate (3.17c)
  double on_the_way = 0; ///< tolerance that is enough where the obstacle is led on to another place; 0: none is (3.17c)
  bool looks_between_nodes = true; ///< for contact that no node has (3.15): of users' meshes, not of those that predict
};

struct StepSolution;

/// Reports while a step is solved; empty functions are not called.
struct Progress {
  /// A step is about to be solved: all that needs no solve has been done. What this throws, on all ranks, ends the run.
  std::function<void(const Problem &, const Step &)> start;
  /// @param uzawa  number of the Uzawa iteration, from 1
  std::function<void(int uzawa, const solver::NewtonStep &, const contact::StateCounts &)> newton;
  std::function<void(const UzawaResult &)> uzawa;
  std::function<void(const Problem &, const StepSolution &)>
      part; ///< a part of a step is solved that another one follows
};

/// What was done on a coarser mesh.
struct LevelWork {
  std::size_t dofs = 0;
  int newton_iterations = 0;
  std::vector<int> linear_iterations; ///< per solve
  int preconditioner_setups = 0;
  double seconds = 0; ///< with all coarser ones
};

/// What a coarser mesh that predicted the start tells of the way from there.
struct PredictedBy {
  FoundBy found_by = FoundBy::choices; ///< its states: what will be needed on the finer mesh
  MakeCoarseChoice coarse_choice;      ///< by that mesh or the next coarser one, which it keeps; empty: there is none
};

/// A start that coarser meshes predict.
struct Prediction {
  std::optional<contact::ContactState> start;
  std::string reason; ///< why there is none
  PredictedBy by;
  std::vector<LevelWork> work; ///< on the meshes that were asked, from the coarsest
  std::size_t nearest = 0;     ///< which of the given states is nearest to equilibrium
  Point obstacle{};            ///< how far a force has moved its obstacle there [m]
};

/// Where a step may start from.
struct Starts {
  /// Such as that of the step before or of another mesh: the nearest to equilibrium is taken.
  std::vector<contact::ContactState> states;
  /// Asked where there is none, or the nearest is far from equilibrium; empty: there are no coarser meshes. Collective.
  std::function<Prediction()> predict;
  bool may_rest =
      false;          ///< the obstacle that a force moves, where the solution leads it to                       (3.17d)
  Point led_before{}; ///< by the search before, of the same step [m]; 0: there was none
};

/// By how much forces of 1 N along unknown motions, or moments that 1 N has at the root mean square of a rigid side's arms, move what forces
/// move, with the contact states as they are: 2-norms over these forces. Infinite where no solve has shown it, or
/// nothing holds what forces move.                                                                                 (4.17)
struct Softness {
  std::vector<double> displacement; ///< of each Dirichlet condition [m/N], in 2D per m
  std::vector<double> rotation;     ///< of each rigid side [rad/N], in 2D per m
  double obstacle = 0;              ///< that a force moves [m/N], in 2D per m
};

/// The solution of one step, and how it was found. Plain data: it outlives its problem.
struct StepSolution {
  Step step;                   ///< what was solved: loads, prescribed displacements, contact points
  RCP<const Vector> u;         ///< (owned dofs) displacement from 0 [m]
  contact::ContactState state; ///< to start the next step from; its displacement is u
  UzawaResult uzawa;
  contact::ContactResult contact;
  double energy = 0;                            ///< J(u) [J], in 2D per m
  double energy_norm_squared = 0;               ///< a(u, u) [J], in 2D per m
  std::vector<std::array<double, 3>> reactions; ///< of each Dirichlet condition on the body [N], in 2D per m
  /// Of the side of each Dirichlet condition, its mean, of a rigid one that of its reference point [m]; empty where no force moves a side.
  std::vector<std::array<double, 3>> displacements;
  std::vector<fem::SixNumbers> rigid_motions; ///< of each rigid side
  std::vector<fem::SixNumbers> rigid_forces;  ///< with which what holds it acts on the body, about its reference point
  Softness softness;

  solver::LinearSolverCounts linear; ///< of this step
  FoundBy found_by = FoundBy::choices;
  int line_search_steps = 0;     ///< Newton's, where the active-set iteration was not enough
  int coarse_choices = 0;        ///< steps to states that a coarser mesh chose
  std::size_t start = 0;         ///< which of the given states it has started from, if one of them
  bool from_rest = false;        ///< friction's states converged from the last of the given starts only
  GO raised_penalties = 0;       ///< contact points whose penalty was too weak for friction
  std::vector<LevelWork> levels; ///< coarser meshes that predicted the solution, from the coarsest
  std::string not_predicted;     ///< why no coarser mesh did; empty if one did
  double prediction_seconds = 0, solve_seconds = 0; ///< solve: without set-ups of multigrid
};

/// s <- what another attempt at the same step took, too.
void add_work(const StepSolution &other, StepSolution &s);

/// The algorithm: predict; repeat { choose states; solve; update multipliers }; judge. Collective.
/// @param state  the problem's, which may come from steps before
/// @throws rpc::Error (bad_input) where NOX refuses its options; failing to converge is in the result
StepSolution solve_step(const Problem &problem, const Step &step, SolverState &state, const StepOptions &options,
                        const Starts &starts = {}, const Progress &progress = {});

} // namespace rpc::analysis
