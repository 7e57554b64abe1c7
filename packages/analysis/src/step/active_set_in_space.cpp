// SPDX-License-Identifier: BSD-3-Clause
/// Solves with friction in space as a part of ActiveSetLoop: the direction of slip follows within the Krylov iteration. (12.15), (12.17)
#include "rpc/analysis/active_set.hpp"

#include "rpc/analysis/rules.hpp"
#include "rpc/core/interrupt.hpp"
#include "rpc/core/rules.hpp"
#include "rpc/solver/krylov_space.hpp"
#include "rpc/solver/rules.hpp"

#include <Teuchos_Time.hpp>
#include <algorithm>

namespace rpc::analysis
{
namespace
{

/// The equations of an active set about a point, solved in one Krylov space.
class SolveInSpace
{
public:
  SolveInSpace(contact::Iterate &iterate, solver::LinearSolver &linear, const double pressure_tolerance,
               const Vector &F, Vector &d)
      : iterate_(iterate), linear_(linear), pressure_tolerance_(pressure_tolerance), space_(iterate.hessian()),
        F_(F, Teuchos::Copy), d_(d), to_(F.getMap()), F_to_(F.getMap()), of_functional_(F.getMap()), norm_(F.norm2()),
        B_(linear.preconditioner())
  {
    d_.putScalar(0);
  }

  bool has_preconditioner() const { return B_ != nullptr; }
  double norm() const { return norm_; }
  int vectors() const { return space_.size(); }

  /// Solves the linear equations at the start to |F| <= enough. @return whether that was reached
  bool solve_linear(const double enough)
  {
    while (norm_ > enough) {
      if (!extend()) return false;
      const double before = norm_;
      norm_ = space_.minimize(to_, F_);
      d_.update(1., to_, 1.);
      if (!(norm_ < before)) return false;
    }
    return true;
  }

  /// Goes on from there with the equations themselves, and a preconditioner for where they are.
  void begin_nonlinear()
  {
    take(d_);
    B_ = linear_.preconditioner();
  }

  /// Until |F| <= enough, or one more vector of the space leaves more than `falls` of it.
  void solve(const double enough, const double falls)
  {
    bool is_new = space_.size() == 0;
    while (norm_ > enough) {
      if (is_new && !extend()) return;
      const double before = norm_;
      space_.find_least(F_, to_);
      to_.update(1., d_, 1.);
      if (residual(to_, F_to_) < norm_) take(to_);
      if (is_new && !(norm_ < falls * before)) return;
      is_new = true;
    }
  }

private:
  double residual(const Vector &at, Vector &F)
  {
    iterate_.gradient(at, of_functional_);
    iterate_.active_set_gradient(at, of_functional_, F); // (5.6)
    return F.norm2();
  }

  bool extend()
  {
    return B_ && space_.size() < solver::linear_rules.gmres_vectors && !interrupted(*F_.getMap()->getComm()) &&
           space_.extend(*B_, F_);
  }

  /// Goes to a point, and linearizes there.
  void take(const Vector &at)
  {
    d_.update(1., at, 0.);
    if (iterate_.pressure_error(d_) > pressure_tolerance_) iterate_.rest_on_multipliers(d_);
    iterate_.turn_slip(d_);
    norm_ = residual(d_, F_);
  }

  contact::Iterate &iterate_;
  solver::LinearSolver &linear_;
  double pressure_tolerance_;
  solver::KrylovSpace space_;
  Vector F_, &d_;
  Vector to_, F_to_, of_functional_; // kept: vectors cost more to make on a GPU than a product with them
  double norm_;
  const solver::Preconditioner *B_;
};

} // namespace

/// By a linear solve at first, while states change; where it confirms them the same iteration goes on to the end.
/// @param[out] d  to the solution   @return false: it is not; d is 0, or says nothing, and a linear solve is to follow
bool ActiveSetLoop::solve_in_space(solver::MinimizationSteps &steps, const solver::Accuracy &rough, const Vector &F,
                                   Vector &d)
{
  if (space_fails_) return false;
  const double start = Teuchos::Time::wallTime();
  solver::NewtonContext &context = steps.context();
  SolveInSpace solve(iterate_, context.linear_solver, pressure_tolerance_, F, d);
  bool solved = solve.has_preconditioner(), ends = !rough_;
  if (solved && rough_) {
    solved = solve.solve_linear(rough.residual * norm_);
    ends = solved && choose_next(d).confirmed;
    if (ends) { // what is left is small against d                                                                 (5.13)
      start_.update(-1., d, 1.);
      iterate_.move_origin(d);
      steps.move_to(rcp(new Vector(d, Teuchos::Copy)));
      solve.begin_nonlinear();
    }
  }
  if (solved && ends) {
    // Where `Uzawa->Tolerance` is small, pressure_tolerance_ is ten times that, (5.10). A residual above it would be solved for once more.
    const double of_run = pressure_tolerance_ / 10 * scale_;
    solve.solve(choice_rules.enough * std::min(target_, of_run), headway_rules.falls);
    solved = rough_ || solve.norm() < norm_;
  }
  space_fails_ = !solved;
  if (solve.vectors() > 0) context.linear_solver.count(solve.vectors(), Teuchos::Time::wallTime() - start);
  context.linear_iterations = solve.vectors();
  context.direction_norm = d.norm2();
  return solved;
}

} // namespace rpc::analysis
