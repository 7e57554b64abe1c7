#pragma once

#include "rpc/adapt/error_estimate.hpp"
#include "rpc/adapt/refinement.hpp"
#include "rpc/analysis/load_history.hpp"
#include "rpc/mesh/make_mesh.hpp"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rpc::adapt
{

/// What is to be solved: a scene on its meshes at one time.
struct Task {
  mesh::MeshOptions mesh;
  double time = 1; ///< at which the scene is solved
  analysis::Model model;
  analysis::StepOptions step;
  analysis::StepsOptions steps; ///< load steps; without times one, at `time`
  solver::LinearSolverOptions linear_solver;
  AdaptOptions adapt;
};

/// Wall-clock time of a run's phases [s], of an adaptive one on all meshes.
struct PhaseSeconds {
  double mesh = 0, assembly = 0, prediction = 0, setup = 0, solve = 0, estimate = 0, output = 0, total = 0;

  PhaseSeconds &operator+=(const PhaseSeconds &other);
};

/// One mesh of an adaptive run.
struct Cycle {
  std::size_t dofs = 0;
  double estimate = 0;                   ///< of the error in the energy norm, over that of the solution
  double energy = 0;                     ///< J [J]
  std::array<double, 3> contact_force{}; ///< [N], in 2D per m
  double max_pressure = 0;               ///< [Pa]
  double contact_length = 0;             ///< [m]
  double pressure_change = 0;            ///< of the contact pressure since the mesh before, over its norm, both in L2
  double recovered_pressure = 0;         ///< what that of the recovered stress differs by, over its norm, both in L2
  double recovered_max_pressure = 0;     ///< the same of the largest pressures [Pa]
  PressurePeak peak;
  double contact_ends = 0; ///< of facets that are partly open, half of them [m]
  int newton_iterations = 0;
  std::vector<int> linear_iterations; ///< per solve
  double seconds = 0;
};

/// Errors of results as the sequence of meshes shows them, and for pressures the recovered stress if that shows more; each
/// like the number that it belongs to. NaN where the meshes do not tell, as from one alone. doc/theory.md (10.7), (10.8)
struct ObservedErrors {
  double energy = 0;                          ///< J [J]
  double contact_force = 0;                   ///< 2-norm [N]
  double max_pressure = 0;                    ///< [Pa]
  double contact_pressure = 0;                ///< L2 norm over the contact sides, over that of the pressure
  double contact_length = 0;                  ///< [m]
  std::map<std::string, std::string> unknown; ///< why, by the name in the summary, for those that are NaN
};

/// What became of "Adapt".
struct Adaptation {
  bool reached = false;      ///< the target
  std::string reason;        ///< why not, or why the target counts as reached where nothing is strained; else empty
  std::vector<Cycle> cycles; ///< from the first mesh
  ObservedErrors errors;     ///< of the one whose results these are
};

/// All that a run has found.
struct Solution : analysis::StepSolution {
  fem::Discretization discretization;
  double pressure_norm = 0;   ///< L2 norm of the contact pressure [Pa m^(1/2)], in 3D [Pa m]; where meshes are adapted
  double pressure_change = 0; ///< the same of its change since the mesh before, if there was one
  std::vector<std::string> skipped;      ///< what the scene allowed to leave out, and why
  std::optional<ErrorEstimate> estimate; ///< where it is asked for
  std::optional<Adaptation> adaptation;  ///< where the mesh is adapted
  double time = 1;                       ///< at which it is the solution
  std::optional<analysis::Memory>
      memory;                     ///< what the next load step starts from, where there are several and it converged
  mesh::MeshOptions mesh_options; ///< of its mesh
  std::vector<analysis::StepRecord> history; ///< of load steps, up to this one
  int matrix_assemblies = 0;
  PhaseSeconds seconds;
};

/// All that the next load step needs.
struct HistoryState {
  analysis::Memory last;
  std::optional<analysis::Memory> before; ///< displacement and pressure of the step before the last one
  std::vector<analysis::StepRecord> records;
  int matrix_assemblies = 0;
};

/// What is told on the way; empty functions tell nothing. All are called on all ranks.
struct Listener {
  std::function<void(const fem::Discretization &, const contact::ContactNodes &)> mesh; ///< one has been made
  analysis::Progress step;
  std::function<void(const Solution &)> estimate; ///< the error has been estimated
  std::function<void(const std::string &)> note;  ///< for the user
  std::function<void(Solution &)> cycle;          ///< one mesh of an adaptive run is solved
  std::function<void(Solution &)> load_step; ///< one of several load steps is solved; its record is the history's last
  /// The state to go on from, if it is not the first step.
  std::function<std::optional<HistoryState>(const fem::Discretization &)> resume;
  /// To be kept. The run itself goes on from here as from the checkpoint: with a new matrix and a new multigrid.
  std::function<void(const HistoryState &, const fem::Discretization &)> checkpoint;
};

/// Mesh, assembly, and solve_step(), for each load step: from a task to its solution. With a target for the error, on as many meshes as that takes; the
/// solution is the last one's, or where the target is not reached that with the least estimate. Collective on comm.
/// @throws rpc::Error on every rank if the model does not fit its mesh; failing to converge is in the result
Solution solve(const Task &task, const RCP<const Comm> &comm, const Listener &listener = {});

/// The load steps of a task on its mesh, each from the one before; the solution is the last one's, or the first one's that does not
/// converge.
Solution solve_steps(const Task &task, const RCP<const Comm> &comm, const Listener &listener = {});

/// The same on one mesh, whatever the target for the error is.
/// @param mesh      to be made, in place of the task's
/// @param previous  solution on another mesh to start from; null: coarser meshes predict it
/// @param earlier   solution of the load step before; without a previous mesh its mesh is taken. Null: there is none
Solution solve_on(const Task &task, const mesh::MeshOptions &mesh, const Solution *previous, const Solution *earlier,
                  const RCP<const Comm> &comm, const Listener &listener);

/// Whether all that was asked for came out.
bool succeeded(const Solution &solution);

/// Whether an estimate tells that the strain energy is rounding: nothing is strained.
bool only_rounding(const Solution &solution);
/// The estimated error in the energy norm over that of the solution, where there is an estimate; 0 if nothing is strained.
double relative_estimate(const Solution &solution);
/// What it really is, sqrt(2 |J_h - J| / a(u_h, u_h)), where the deck tells the exact J; else NaN.
double exact_error(const Task &task, const Solution &solution);

} // namespace rpc::adapt
