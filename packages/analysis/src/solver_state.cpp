#include "rpc/analysis/solver_state.hpp"

#include "rpc/analysis/mesh_levels.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::analysis
{
namespace
{

// The same on stars of vertices, (4.7f).
constexpr double expected_on_stars = 15;

/// The CG iterations to 1e-8 that multigrid takes at least on a body of the largest nu of its blocks: smoothers of single nodes see no
/// functions without divergence.                                                                                 (4.10b)
///
///     4 (1 - 2 nu)^(-1/2)
double expected_iterations(const double nu)
{
  return 4 / std::sqrt(1 - 2 * nu);
}

/// Of what rough solves may leave: pressures err by more than displacements do where a body is nearly incompressible, and states are chosen
/// by them.                                                                                                       (5.9b)
///
///     ((1 - 2 nu) / 0.002)^(1/2),  1 at most
double rough_part(const double nu)
{
  return std::min(1., std::sqrt((1 - 2 * nu) / 0.002));
}

/// Prolongators of quadratic elements want more smoothing: 32 to 35 instead of 34 to 37 iterations on the beam (P2).
solver::LinearSolverOptions tuned(solver::LinearSolverOptions options, const fem::Discretization &d,
                                  const fem::Materials &materials)
{
  if (d.mesh->element.order == 2) options.damping = 1.6;
  if (d.kinematics == fem::Kinematics::plane_stress) return options; // nothing is nearly incompressible
  const double nu = largest_ratio(d, materials);
  options.expected_iterations = smooths_on_stars(d, materials) ? expected_on_stars : expected_iterations(nu);
  options.rough_part = rough_part(nu);
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
