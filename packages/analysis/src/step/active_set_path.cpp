// SPDX-License-Identifier: BSD-3-Clause
/// The interior-point method as a part of ActiveSetLoop.
#include "rpc/analysis/active_set.hpp"

#include "rpc/analysis/rules.hpp"
#include "rpc/solver/rules.hpp"

#include <cmath>

namespace rpc::analysis
{

using solver::MinimizationSteps;

/// Whether the states that the path leads to are to be tried, or taken; then they are the next choice.
bool ActiveSetLoop::leaves_path()
{
  const contact::InteriorPath &path = *interior_;
  const bool ends = path.gap() <= path_rules.last_gap || path_steps_ >= solver::newton_rules.most_inner_steps;
  if (!ends && !(path.settled() && path.gap() <= trial_gap_)) return false;
  if (ends) path_ = Path::behind;
  trial_gap_ = path_rules.trial * path.gap();
  start_over(path.choice()); // (5.20)
  return true;
}

ActiveSetLoop::Status ActiveSetLoop::step_on_path(MinimizationSteps &steps)
{
  if (leaves_path()) return Status::goes_on;
  const Vector &u = solver::tpetra(steps.at().getX());
  const auto direction = rcp(new Vector(u.getMap()));
  const double t = solve_interior(steps.context(), u, *direction) ? interior_->advance(u, *direction) : 0;
  if (!(t > 0)) {
    path_ = Path::behind;
    return leave_to_newton(steps);
  }
  direction->scale(t);
  ++path_steps_;
  ++steps.context().steps;
  ++steps_;
  const Status status = steps.take(direction);
  return status == Status::goes_on ? steps.unless_last(status) : status;
}

/// The direction of a step of the path: predictor, and what it lacks of the correctors.              (5.18), (5.19)
/// @return whether it can be used
bool ActiveSetLoop::solve_interior(solver::NewtonContext &context, const Vector &u, Vector &direction)
{
  double energy = 0; // of the predictor
  const auto solve = [&](const Vector &F, Vector &d, const double tolerance) {
    const auto solved = solver::solve_for_direction(context, F, d, {tolerance, path_rules.error, energy});
    energy = solved.energy;
    return !solved.broken && !solved.interrupted && std::isfinite(context.direction_norm);
  };
  Vector F(u.getMap());
  interior_->linearize(u, F);
  if (!solve(F, direction, path_rules.forcing)) return false;
  direction.scale(-1.);
  interior_->correct(u, direction, F);
  Vector lacking(u.getMap()); // by a solve for what the predictor lacks
  iterate_.apply_hessian(direction, lacking);
  lacking.update(1., F, 1.);
  const double wanted = path_rules.forcing * F.norm2(), missing = lacking.norm2();
  if (missing <= wanted) return true;
  const int iterations = context.linear_iterations;
  Vector correction(u.getMap());
  if (!solve(lacking, correction, wanted / missing)) return false;
  context.linear_iterations += iterations;
  direction.update(-1., correction, 1.);
  return true;
}

} // namespace rpc::analysis
