#include "rpc/analysis/solver_state.hpp"

namespace rpc::analysis
{
namespace
{

/// Prolongators of quadratic elements want more smoothing: 32 to 35 instead of 34 to 37 iterations on the beam (P2).
solver::LinearSolverOptions tuned(solver::LinearSolverOptions options, const mesh::Element &element)
{
  if (element.order == 2) options.damping = 1.6;
  return options;
}

} // namespace

SolverState::SolverState(const Problem &problem, const solver::LinearSolverOptions &options)
    : options_(options), hessian_(rcp(new UpdatedOperator(problem.stiffness(), problem.contact_candidates())))
{
  const fem::Discretization &d = problem.discretization();
  linear_ = std::make_unique<solver::LinearSolver>(tuned(options, d.mesh->element), hessian_, fem::node_coordinates(d),
                                                   fem::rigid_body_modes(d), problem.mesh_levels());
}

} // namespace rpc::analysis
