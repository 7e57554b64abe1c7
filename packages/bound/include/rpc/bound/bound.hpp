// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/run.hpp"
#include "rpc/bound/goals.hpp"

#include <memory>
#include <string>
#include <vector>

namespace rpc::bound
{

/// Bounds of the force of a contact side along its normal, the integral of its pressure [N], in 2D per m.             (13.15)
struct ForceBound {
  double lower = 0, upper = 0;
  std::string missing; ///< why there is none; empty if there is one
};

/// Bounds of the energy of the exact solution and of the error of a discrete one, without a constant that would have to be estimated.
///                                                                                                              doc/bounds.md
struct EnergyBound {
  /// What J counts: with friction its work s |e| too, and for Coulomb's law with the limits s of this solution.            (13.12)
  enum class Of { energy, energy_and_friction, energy_and_fixed_friction } of = Of::energy;
  double lower = 0, upper = 0; ///< of J(u) [J], in 2D per m
  double energy_norm = 0;      ///< |u - u_h| is not larger [J^(1/2)], in 2D per m
  double moved = 0;            ///< |u^ - u_h|, by how much u_h was moved out of the foundation [J^(1/2)]
  std::vector<double> steps;   ///< J(u^) - D(sigma) after 0, 1, ... steps of conjugate gradients on tractions [J]
  std::vector<ForceBound> contact_force; ///< by contact side
  std::vector<GoalBound> goals;          ///< as they were given
  DeviceView<double *> squared;          ///< (owned cells) the parts of energy_norm^2 [J], in 2D per m
  double imbalance = 0;      ///< largest force that is out of balance on a cell, over the largest on a side of one
  int linear_iterations = 0; ///< of the elastic solve
  double solve_seconds = 0;  ///< that it took, with what it sets up
  double seconds = 0;        ///< of all
  std::string missing;       ///< why there is no bound; empty if there is one
};

/// How results name what J counts.
const char *name_of(EnergyBound::Of of);

/// Whether the bound is known for a task; needs no mesh.
/// @throws rpc::Error (bad_input) naming what is covered, if not
void require_covered(const analysis::Task &task, const std::vector<Goal> &goals);
/// The facets of the mesh that bounds in space go by; in the plane null.
struct SpaceFacets;
using FacetsOfMesh = std::shared_ptr<const SpaceFacets>;
/// The same of a step on its mesh; collective. @return for energy_bound()
/// @throws rpc::Error (bad_input)
FacetsOfMesh require_covered(const analysis::Problem &problem, const analysis::Step &step,
                             const std::vector<Goal> &goals);

/// Collective. @param solution  of a step that require_covered() admits   @param facets  that it has found; null: they are to be found
/// @param steps  of conjugate gradients, see bound_rules; in space twice as many, of hexahedra four times
EnergyBound energy_bound(const analysis::Problem &problem, const analysis::StepSolution &solution,
                         const solver::LinearSolverOptions &options, int steps, const FacetsOfMesh &facets,
                         const std::vector<Goal> &goals = {});

} // namespace rpc::bound
