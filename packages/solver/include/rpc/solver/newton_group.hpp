// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/convex_functional.hpp"
#include "rpc/solver/linear_solver.hpp"
#include "rpc/solver/nox_vector.hpp"

#include <NOX_Abstract_Group.H>
#include <cstdint>
#include <memory>
#include <string>

namespace rpc::solver
{

/// What the groups of one minimization share: the functional, the linear solver, and a record of the last step.
struct NewtonContext {
  ConvexFunctional &functional;
  LinearSolver &linear_solver;
  double target_residual = 0;   ///< |F|_2 at which Newton stops; no linear solve need be better than this
  RCP<const Vector> given = {}; ///< the next step's direction; null: Newton's

  int steps = 0, newton_steps = 0; ///< that took a linear solve, and of these Newton's
  std::uint64_t piece = 0;         ///< of the functional, at Newton's last direction

  // Last step
  double direction_norm = 0; ///< |d|_2 of the full step
  double step_length = 1;
  bool full_step = false; ///< the line search takes the direction as it is
  std::unique_ptr<LineFunction> searched =
      {}; ///< while a line search of NOX's is at work: the functional along its direction
  int linear_iterations = 0;
  GO changes = 0;           ///< places where the last Hessian changed
  std::string failure = {}; ///< of the linear solver or the line search

  // All steps
  int searches = 0, failed_searches = 0; ///< by a line search of NOX's
  int returns = 0;                       ///< steps to a piece of the functional that had been left
  bool stagnates = false;                ///< full steps on one piece of the functional no longer lower the residual
};

/// A point of the Newton iteration: u, F(u) and the Newton direction. NOX holds two of them. doc/theory.md (4.2)
class NewtonGroup : public NOX::Abstract::Group
{
public:
  NewtonGroup(RCP<NewtonContext> context, const RCP<rpc::Vector> &u);
  NewtonGroup(const NewtonGroup &source, NOX::CopyType type);

  NewtonGroup(const NewtonGroup &) = delete;
  NewtonGroup &operator=(const NewtonGroup &source);
  NOX::Abstract::Group &operator=(const NOX::Abstract::Group &source) override;
  void setX(const NOX::Abstract::Vector &y) override;
  void computeX(const NOX::Abstract::Group &from, const NOX::Abstract::Vector &d, double step) override;
  ReturnType computeF() override;
  ReturnType computeJacobian() override;
  ReturnType computeNewton(Teuchos::ParameterList &) override;

  bool isF() const override { return has_F_; }
  bool isJacobian() const override { return has_jacobian_; }
  bool isNewton() const override { return has_newton_; }
  const NOX::Abstract::Vector &getX() const override { return u_; }
  const NOX::Abstract::Vector &getF() const override { return F_; }
  double getNormF() const override { return norm_F_; }
  const NOX::Abstract::Vector &getNewton() const override { return *newton_; }
  const NOX::Abstract::Vector &getGradient() const override
  {
    return F_;
  } // of the functional; NOX's own would be J^T F
  RCP<const NOX::Abstract::Vector> getXPtr() const override { return Teuchos::rcpFromRef(u_); }
  RCP<const NOX::Abstract::Vector> getFPtr() const override { return Teuchos::rcpFromRef(F_); }
  RCP<const NOX::Abstract::Vector> getNewtonPtr() const override { return newton_; }
  ReturnType computeGradient() override { return computeF(); }
  bool isGradient() const override { return has_F_; }
  RCP<const NOX::Abstract::Vector> getGradientPtr() const override { return getFPtr(); }
  RCP<NOX::Abstract::Group> clone(NOX::CopyType type) const override;

  NewtonContext &context() const { return *context_; }
  /// Where the point lies on the line of the last computeX(); 0 after all else that sets it.
  double step() const { return step_; }

private:
  void invalidate();

  RCP<NewtonContext> context_;
  NoxVector u_, F_;
  RCP<NoxVector> newton_; // null until it is asked for
  double norm_F_ = 0, step_ = 0;
  bool has_F_ = false, has_jacobian_ = false, has_newton_ = false;
};

/// Solves with the functional's Hessian, and records iterations and the direction's length; collective.
/// @param[out] d  about H^-1 F
/// @param wanted  its residual is taken no larger than 0.1 where no error counts
LinearSolver::Result solve_for_direction(NewtonContext &context, const Vector &F, Vector &d, const Accuracy &wanted);

} // namespace rpc::solver
