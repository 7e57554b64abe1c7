// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/adapt/cycle.hpp"
#include "rpc/adapt/estimator.hpp"
#include "rpc/adapt/options.hpp"
#include "rpc/analysis/run.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <string>

namespace rpc::adapt
{

/// All that a run has found.
struct Solution : analysis::Solution {
  double pressure_norm = 0;   ///< L2 norm of the contact pressure [Pa m^(1/2)], in 3D [Pa m]; where meshes are adapted
  double pressure_change = 0; ///< the same of its change since the mesh before, if there was one
  double smallest_gap = std::numeric_limits<double>::infinity(); ///< see Cycle [m]; where meshes are adapted
  std::optional<ErrorEstimate> estimate;                         ///< where it is asked for
  std::optional<bound::EnergyBound> bound;                       ///< guaranteed, where it is asked for
  double largest_estimate =
      0; ///< of load steps so far, of the error in the energy norm [J^(1/2)], in 2D per m; NaN: not known
  LeftOpen earlier_misread;             ///< left_by_misreading(): the most of a load step before this one
  std::optional<Adaptation> adaptation; ///< where the mesh is adapted
};

/// What is still to be done for the target, as the last mesh tells.
struct Forecast {
  int meshes = 0;         ///< > 0
  double dofs = 0;        ///< of the next one
  double last_dofs = 0;   ///< of the last one, if the error falls as the order of the elements lets it
  double seconds = 0;     ///< for all of them, if each unknown takes as long as on the last mesh, from mesh to plan
  double told_before = 0; ///< last_dofs of the mesh before; 0: there was none that saw the contact
  bool misses_contact =
      false; ///< contact that no contact point sees is most of the error: last_dofs and seconds tell nothing
};

/// Reports during the run; empty functions are not called. All are called on all ranks. `solved` is not called: the error is
/// estimated there.
struct Listener : analysis::Listener {
  std::function<void(const Solution &)> estimate; ///< the error on one mesh of an adaptive run has been estimated
  std::function<void(const Forecast &)> forecast; ///< there will be another mesh
  std::function<void(Solution &)> cycle;          ///< one mesh of an adaptive run is solved
};

/// From a task to its solution. With a target for the error, on as many meshes as that takes: the solution is the last one's, or
/// where the target is not reached that with the least estimate. Collective on comm.
/// @throws rpc::Error on every rank if the model does not fit its mesh; failing to converge is in the result
Solution solve(const Task &task, const RCP<const Comm> &comm, const Listener &listener = {});

/// Whether all that was asked for came out.
bool succeeded(const Solution &solution);

/// Whether the strain energy is at rounding level: then the estimate is meaningless. False without an estimate.
bool only_rounding(const Solution &solution);
/// The estimated error in the energy norm over that of the solution, where there is an estimate; 0 where only_rounding().
double relative_estimate(const Solution &solution);
/// Errors of the results: as the sequence of meshes shows them, or of one mesh with an estimate that of J alone. Without an estimate all
/// are NaN. `unknown` tells why.
ObservedErrors errors_of(const Task &task, const Solution &solution);
/// Those of the components of its contact force, see contact_force_bars(); empty where they are not known.
std::vector<double> contact_force_bars(const Task &task, const Solution &solution);
/// The true relative error, sqrt(2 |J_h - J| / a(u_h, u_h)), where the deck has the exact J; else NaN.
double exact_error(const Task &task, const Solution &solution);

} // namespace rpc::adapt
