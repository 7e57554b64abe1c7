// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/energy_tolerance.hpp"
#include "rpc/analysis/load_history.hpp"
#include "rpc/analysis/quantities.hpp"
#include "rpc/core/error.hpp"
#include "rpc/mesh/make_mesh.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Runs on a given mesh: from a task to its solution, with load steps and checkpoints.
namespace rpc::analysis
{

/// What is to be solved: a scene on its mesh.
struct Task {
  mesh::MeshOptions mesh;
  double time = 1; ///< at which the scene is solved
  Model model;
  StepOptions step;
  StepsOptions steps; ///< load steps; without times one, at `time`
  solver::LinearSolverOptions linear_solver;

  bool has_steps() const { return !steps.times.empty(); }
};

/// The motion of obstacles along the side counts from where they are at t = 0, whatever mesh or checkpoint a run is on.
/// @throws rpc::Error (bad_input) where that is nowhere and something depends on it: friction, or dents that move with the foundation
void set_obstacle_origins(Task &task);

/// What has ended a run with load steps before its last time.
struct Failure {
  double time; ///< of the step, or of the part of it, that failed
  std::string reason;
  ExitCode code;
};

/// What a run on one mesh has found.
struct Solution : StepSolution {
  fem::Discretization discretization;
  std::vector<std::string>
      skipped; ///< parts of the algorithm that this run skipped, with reasons, see doc/input/results.md
  std::vector<std::string> notes; ///< what the user should know of it besides its numbers, see doc/input/results.md
  double time = 1;                ///< at which it is the solution
  fem::BodyPeaks body;
  /// (owned cells) Squares of the estimated error in the energy norm [J], in 2D per m; empty where it is not asked for. `solved` adds them.
  DeviceView<double *> squared_errors;
  std::optional<Memory> memory; ///< what the next load step starts from, where there are several and it converged
  /// (contact points) Pressure that the solution on the previous mesh gave as a start [Pa]; none without a previous mesh.
  std::optional<DeviceView<double *>> start_pressure;
  mesh::MeshOptions mesh_options;  ///< of its mesh
  std::vector<StepRecord> history; ///< of load steps, up to this one; after a failure that step too
  /// A later load step has not converged, or an error has ended it: the solution is that of the step before.
  std::optional<Failure> failure;
  int matrix_assemblies = 0;
  PhaseSeconds seconds;
  double energy_rounding = 0;                 ///< see energy_rounding(); largest of the steps so far
  std::optional<OutOfBalance> out_of_balance; ///< of a run with an energy tolerance, at its end

  /// Whether its numbers and fields are a solution's. Else they are the last iterate, which nobody gets to see: numbers are NaN.
  bool has_results() const { return uzawa.converged; }
};

/// Makes NaN of the numbers of a solution that has not converged, but for residuals and counts.
void take_back_results(Solution &solution);

/// All that the next load step needs.
struct HistoryState {
  fem::Discretization discretization; ///< of the mesh that all this is on
  mesh::MeshOptions mesh_options;     ///< by which it was made
  Memory last;
  std::optional<Memory> before; ///< displacement and pressure of the step before the last one
  std::vector<StepRecord> records;
  int matrix_assemblies = 0;
  /// Of errors in the energy norm, of all steps on adapted meshes [J^(1/2)], in 2D per m; NaN of a run on one mesh, which keeps none.
  double largest_estimate = std::numeric_limits<double>::quiet_NaN();
  /// The most that reading the gap at nodes has left open in one of them [N], [J], in 2D per m, [m].     doc/theory.md (3.16a)
  double misread_force = 0, misread_energy = 0, misread_penetration = 0;
};

/// Reports during the run; empty functions are not called. All are called on all ranks.
struct Listener {
  std::function<void(const fem::Discretization &, const contact::ContactNodes &)> mesh; ///< one has been made
  Progress step;
  /// Called with each solution before it is reported: adds numbers such as its error.
  std::function<void(const Problem &, Solution &)> solved;
  std::function<void(Solution &)> load_step; ///< one of several load steps is solved; its record is the history's last
  std::function<void(const std::string &)> note; ///< for the user
  /// The state to go on from, if it is not the first step.
  std::function<std::optional<HistoryState>()> resume;
  /// To be kept. The run itself goes on from here as from the checkpoint: with a new multigrid. Where it throws, the user is told
  /// (`note`), and it is called again after the next step.
  std::function<void(const HistoryState &)> checkpoint;
};

/// The state that a run with load steps goes on from, if it is not the first step. Collective.
/// @param[inout] seconds  of phases: that of the mesh grows
std::optional<HistoryState> resumed(const Listener &listener, PhaseSeconds &seconds);
/// Has a state kept; where that fails the user is told. Collective.
/// @return whether it was
bool keep_checkpoint(const HistoryState &state, const Listener &listener);
/// "at t = 2: ", as messages begin.
std::string at_time(double t);
/// The error of a load step that ends a run without results, as the user gets to see it.
/// @param first  whether no step went before: then what is wrong with the deck or the mesh has no time, a load has
Error error_at(double t, const Error &error, bool first);

/// What differences of the energies of a step that is solved may be without a meaning, by rounding and the accuracy of solves [J], in 2D
/// per m; 0 without an energy tolerance. Collective.
double energy_rounding(const Task &task, const Solution &solution);
/// Tells which steps have not kept the energy tolerance, if there is one.
void judge_balance(const Task &task, Solution &solution);

/// Mesh, assembly and solve_step(), for each load step: from a task to its solution. Collective on comm.
/// @throws rpc::Error on every rank if the model does not fit its mesh; failing to converge is in the result
Solution solve(const Task &task, const RCP<const Comm> &comm, const Listener &listener = {});

/// The load steps of a task on its mesh, each from the one before; the solution is the last one's, or where a later step does not converge
/// or an error ends it the one before it, with its `failure`. A first step that does not converge leaves a solution without results. An
/// interrupted run leaves a checkpoint.
Solution solve_steps(const Task &task, const RCP<const Comm> &comm, const Listener &listener = {});

/// A mesh with the options by which it was made.
struct MadeMesh {
  mesh::MeshOptions options;
  std::shared_ptr<const mesh::Mesh> mesh;
  double seconds = 0; ///< that making it took [s]
};

/// Collective on comm.
/// @throws rpc::Error on every rank, as mesh::make_mesh() does, and where the run is interrupted
MadeMesh made_mesh(const mesh::MeshOptions &options, const RCP<const Comm> &comm);

/// One step of a task on one mesh. Collective on the mesh's comm.
/// @param made      in place of the task's mesh
/// @param previous  solution on another mesh to start from; null: coarser meshes predict it
/// @param earlier   solution of the load step before, on this mesh or another one; null: there is none
Solution solve_on(const Task &task, const MadeMesh &made, const Solution *previous, const Solution *earlier,
                  const Listener &listener);

} // namespace rpc::analysis
