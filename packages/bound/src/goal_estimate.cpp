// SPDX-License-Identifier: BSD-3-Clause
#include "goal_estimate.hpp"

#include "rpc/contact/iterate.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/fem/stress.hpp"

#include <cmath>
#include <limits>

namespace rpc::bound
{
namespace
{

/// |R s - s|^2 of the stress s of a displacement and the recovered one.                                      (10.2)
double squared_distance(const analysis::Problem &problem, const Vector &u)
{
  const fem::Discretization &d = problem.discretization();
  const auto of_cell = fem::RecoveredStress(d, problem.model().materials, u).squared_difference();
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::bound::squared_distance", device_range(d.mesh->num_owned_cells),
      KOKKOS_LAMBDA(const LO c, double &part) { part += of_cell(c); }, sum);
  return sum_all(d.mesh->comm(), sum);
}

} // namespace

double estimated_error(const analysis::Problem &problem, const analysis::StepSolution &s,
                       const solver::LinearSolverOptions &options, const Vector &Q)
{
  analysis::SolverState state(problem, options);
  contact::Iterate iterate(s.step.elastic, s.step.contact, state.hessian());
  Vector u(*s.step.elastic.dirichlet.value, Teuchos::Copy);
  iterate.start_from(s.state, u);
  iterate.update_hessian(u);
  constexpr double accuracy = 1e-6; // of the solve: the estimate's own error is larger
  Vector load(Q, Teuchos::Copy), z(Q.getMap());
  fem::clear_prescribed(s.step.elastic.dirichlet, load);
  if (!state.linear().solve(load, z, accuracy).converged) return std::numeric_limits<double>::quiet_NaN();
  const auto norm = [&](const Vector &x) {
    return std::sqrt(fem::internal_work(problem.discretization(), problem.model().materials, x).energy_norm_squared);
  };
  const double of_z = norm(z), of_u = norm(*s.u);
  if (!(of_z > 0 && of_u > 0)) return 0;
  const double scale = of_u / of_z; // sums of alike size
  Vector sum(*s.u, Teuchos::Copy), difference(*s.u, Teuchos::Copy);
  sum.update(scale, z, 1);
  difference.update(-scale, z, 1);
  return (squared_distance(problem, sum) - squared_distance(problem, difference)) / (4 * scale);
}

} // namespace rpc::bound
