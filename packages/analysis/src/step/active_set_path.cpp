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
  start_over(path.choice(), path_rules.trial_changes); // (5.20)
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

/// The direction of a step of the path: predictor, and what it lacks of the correctors.             (5.18) to (5.19a)
/// @return whether it can be used
bool ActiveSetLoop::solve_interior(solver::NewtonContext &context, const Vector &u, Vector &direction)
{
  double energy = 0; // of the predictor
  const auto solve = [&](const Vector &F, Vector &d, const double tolerance) {
    const auto solved = solver::solve_for_direction(context, F, d, {tolerance, path_rules.error, energy});
    energy = solved.energy;
    return !solved.broken && !solved.interrupted && std::isfinite(context.direction_norm);
  };
  // Brings d to -H^-1 F, by a solve for what it lacks; false where that fails.
  const auto improve = [&](const Vector &F, Vector &d) {
    Vector lacking(u.getMap());
    iterate_.apply_hessian(d, lacking);
    lacking.update(1., F, 1.);
    const double wanted = path_rules.forcing * F.norm2(), missing = lacking.norm2();
    if (missing <= wanted) return true;
    const int iterations = context.linear_iterations;
    Vector correction(u.getMap());
    if (!solve(lacking, correction, wanted / missing)) return false;
    context.linear_iterations += iterations;
    d.update(-1., correction, 1.);
    return true;
  };
  Vector F(u.getMap());
  interior_->linearize(u, F);
  if (!solve(F, direction, path_rules.forcing)) return false;
  direction.scale(-1.);
  interior_->correct(u, direction, F);
  if (!improve(F, direction)) return false;
  double t = interior_->longest_step(u, direction);
  for (int times = 0; times < path_rules.most_centerings && t < path_rules.long_enough; ++times) {
    interior_->center(u, direction, F);
    Vector centered(direction, Teuchos::Copy);
    const double longer = improve(F, centered) ? interior_->longest_step(u, centered) : 0;
    if (longer > t)
      direction.assign(centered);
    else
      interior_->take_back();
    if (longer < t + path_rules.least_gain) break;
    t = longer;
  }
  return true;
}

} // namespace rpc::analysis
