#include "rpc/analysis/solver_state.hpp"

#include "rpc/analysis/mesh_levels.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::analysis
{
namespace
{

/// The CG iterations to 1e-8 that multigrid takes at least on a body of the largest nu of its blocks: smoothers of single nodes see no
/// functions without divergence.                                                                                 (4.10b)
///
///     4 (1 - 2 nu)^(-1/2)
///
/// In plane stress nothing is nearly incompressible: 0, not known.
double expected_iterations(const fem::Discretization &d, const fem::Materials &materials)
{
  if (d.kinematics == fem::Kinematics::plane_stress) return 0;
  double nu = 0;
  for (const std::string &block : d.mesh->blocks) nu = std::max(nu, materials.of(block).poissons_ratio);
  return 4 / std::sqrt(1 - 2 * nu);
}

/// Prolongators of quadratic elements want more smoothing: 32 to 35 instead of 34 to 37 iterations on the beam (P2).
solver::LinearSolverOptions tuned(solver::LinearSolverOptions options, const fem::Discretization &d,
                                  const fem::Materials &materials)
{
  if (d.mesh->element.order == 2) options.damping = 1.6;
  options.expected_iterations = expected_iterations(d, materials);
  return options;
}

} // namespace

SolverState::SolverState(const Problem &problem, const solver::LinearSolverOptions &options)
    : options_(options), hessian_(rcp(new UpdatedOperator(problem.stiffness(), problem.contact_candidates())))
{
  const fem::Discretization &d = problem.discretization();
  linear_ = std::make_unique<solver::LinearSolver>(tuned(options, d, problem.model().materials), hessian_, body_of(d),
                                                   problem.mesh_levels());
}

} // namespace rpc::analysis
