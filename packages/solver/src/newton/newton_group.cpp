// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/solver/newton_group.hpp"

#include "rpc/core/causes.hpp"
#include "rpc/core/finite.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::solver
{

NewtonGroup::NewtonGroup(RCP<NewtonContext> context, const RCP<rpc::Vector> &u)
    : context_(std::move(context)), u_(u), F_(u_, NOX::ShapeCopy)
{
}

NewtonGroup::NewtonGroup(const NewtonGroup &source, const NOX::CopyType type)
    : context_(source.context_), u_(source.u_, type), F_(source.F_, NOX::ShapeCopy)
{
  if (type == NOX::DeepCopy) *this = source;
}

void NewtonGroup::invalidate()
{
  has_F_ = has_jacobian_ = has_newton_ = false;
  step_ = 0;
}

NOX::Abstract::Group &NewtonGroup::operator=(const NOX::Abstract::Group &source)
{
  return *this = dynamic_cast<const NewtonGroup &>(source);
}

NewtonGroup &NewtonGroup::operator=(const NewtonGroup &source)
{
  invalidate();
  u_ = source.u_;
  if (source.has_F_) {
    F_ = source.F_;
    norm_F_ = source.norm_F_;
    has_F_ = true;
  }
  return *this; // the direction stays where it was computed: NOX hands it on by itself
}

void NewtonGroup::setX(const NOX::Abstract::Vector &y)
{
  invalidate();
  u_ = y;
}

void NewtonGroup::computeX(const NOX::Abstract::Group &from, const NOX::Abstract::Vector &d, const double step)
{
  invalidate();
  u_.update(1., from.getX(), step, d, 0.);
  context_->step_length = step_ = step; // of a line search the last one
}

NOX::Abstract::Group::ReturnType NewtonGroup::computeF()
{
  if (has_F_) return Ok;
  context_->functional.gradient(u_.data(), F_.data());
  norm_F_ = F_.data().norm2();
  if (!std::isfinite(norm_F_) && context_->failure.empty())
    context_->failure = describe_not_finite("the forces on the nodes, those of the functional included", F_.data(),
                                            *context_->linear_solver.body().coordinates());
  has_F_ = true;
  return Ok;
}

NOX::Abstract::Group::ReturnType NewtonGroup::computeJacobian()
{
  context_->changes = context_->functional.update_hessian(u_.data());
  has_jacobian_ = true;
  return Ok;
}

NOX::Abstract::Group::ReturnType NewtonGroup::computeNewton(Teuchos::ParameterList &)
{
  if (has_newton_) return Ok;
  if (!has_F_ || !has_jacobian_) return BadDependency;
  const double rough = context_->changes > 0 ? newton_rules.forcing : 0.;
  if (newton_.is_null()) newton_ = rcp(new NoxVector(u_, NOX::ShapeCopy));
  const auto result =
      solve_for_direction(*context_, F_.data(), newton_->data(),
                          std::max(rough, newton_rules.largest_residual * context_->target_residual / norm_F_));
  ++context_->steps;
  ++context_->newton_steps;
  newton_->scale(-1.);
  const bool has_cause = !result.interrupted && std::isfinite(context_->direction_norm);
  context_->failure = result.reason;
  if (has_cause && !result.reason.empty())
    context_->failure = because(result.broken ? causes::breakdown : causes::linear_solver, result.reason);
  has_newton_ = true;
  return std::isfinite(context_->direction_norm) && !result.broken ? (result.converged ? Ok : NotConverged) : Failed;
}

LinearSolver::Result solve_for_direction(NewtonContext &context, const Vector &F, Vector &d, const Accuracy &wanted)
{
  Accuracy asked = wanted;
  if (wanted.error == 0) asked.residual = std::min<double>(newton_rules.largest_residual, wanted.residual);
  const auto result = context.linear_solver.solve(F, d, asked);
  context.linear_iterations = result.iterations;
  context.direction_norm = d.norm2();
  return result;
}

RCP<NOX::Abstract::Group> NewtonGroup::clone(const NOX::CopyType type) const
{
  return rcp(new NewtonGroup(*this, type));
}

} // namespace rpc::solver
