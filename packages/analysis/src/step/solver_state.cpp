// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/solver_state.hpp"

#include "rpc/analysis/mesh_levels.hpp"
#include "rpc/analysis/rules.hpp"
#include "rpc/mesh/rules.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rpc::analysis
{
namespace
{

/// The CG iterations to 1e-8 that multigrid takes at least on a body of the largest nu of its blocks: smoothers of single nodes see no
/// functions without divergence.                                                                                 (4.10b)
///
///     4 (1 - 2 nu)^(-1/2),  of P1 6 (1 - 2 nu)^(-1/2),  in stretched cells 3 (1 - 2 nu)^(-3/4) if that is more
double expected_iterations(const mesh::Mesh &mesh, const double nu)
{
  const double to_go = 1 - 2 * nu;
  if (mesh.element.order > 1 || mesh.element.shape != mesh::Shape::simplex)
    return linear_rules.expected * std::pow(to_go, -0.5);
  const double square = linear_rules.expected_of_p1 * std::pow(to_go, -0.5);
  return mesh.box && mesh::stretch(*mesh.box) > mesh::coarsening_rules.equally_long
             ? std::max(square, linear_rules.expected_of_stretched * std::pow(to_go, -0.75))
             : square;
}

/// The iterations of the mixed form. Of order 1, in the plane and on meshes from files, CG iterations are counted that take the same time: a
/// sparse factor may take less.                                                                                  (4.10d)
double expected_of_mixed_form(const mesh::Mesh &mesh, const double nu)
{
  if (mesh.element.order == 2 || (mesh.dim() == 3 && mesh.box)) return solver::linear_rules.fair_iterations;
  return solver::linear_rules.fair_iterations *
         (1 + linear_rules.cost_of_step * solver::degree_for_pressures(1 / (1 - 2 * nu)));
}

/// The share of their tolerances that inexact solves get: in a nearly incompressible body pressures, which choose states, err by more than
/// displacements do.                                                                                                       (5.9b)
///
///     ((1 - 2 nu) / 0.002)^(1/2),  1 at most
double rough_part(const double nu)
{
  return std::min(1., std::sqrt((1 - 2 * nu) / linear_rules.rough_incompressible));
}

solver::LinearSolverOptions tuned(solver::LinearSolverOptions options, const Problem &problem, const bool is_mixed)
{
  const fem::Discretization &d = problem.discretization();
  const fem::Materials &materials = problem.model().materials;
  if (d.kinematics == fem::Kinematics::plane_stress) return options; // nothing is nearly incompressible
  const double nu = largest_ratio(d, materials);
  options.expected_iterations = expected_iterations(*d.mesh, nu);
  if (is_mixed) options.expected_iterations = expected_of_mixed_form(*d.mesh, nu);
  options.rough_part = rough_part(nu);
  return options;
}

} // namespace

SolverState::SolverState(const Problem &problem, const solver::LinearSolverOptions &options)
    : options_(options), hessian_(rcp(new UpdatedOperator(problem.stiffness(), problem.contact_candidates())))
{
  auto mixed = problem.mixed_form();
  const auto for_this = tuned(options, problem, static_cast<bool>(mixed));
  linear_ = std::make_unique<solver::LinearSolver>(for_this, hessian_, body_of(problem.discretization()),
                                                   problem.mesh_levels(), std::move(mixed));
  if (!problem.stiffness_of_tied().is_null()) linear_->move_as_one(problem.stiffness_of_tied(), hessian_);
}

} // namespace rpc::analysis
