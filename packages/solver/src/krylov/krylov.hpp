// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "krylov/interrupted.hpp"
#include "rpc/solver/accuracy.hpp"
#include "rpc/solver/linear_solver_options.hpp"
#include "rpc/solver/preconditioner.hpp"

#include <functional>
#include <memory>

namespace rpc::solver
{

/// What came out of one Krylov iteration.
struct KrylovResult {
  bool converged = false;
  bool broken = false;       ///< the method broke down, as on an indefinite or singular matrix
  bool given_up = false;     ///< GivesUp has asked for that
  int iterations = 0;        ///< 0 where it broke down: they are not to be had
  double residual = 1;       ///< |r|/|b| by the method's own account; NaN where it broke down
  double energy = 0;         ///< x . b, about |x|_H^2, where an error was asked for [J]
  std::string reason{};      ///< why it did not converge, if it did not
  RCP<const Vector> rough{}; ///< x from which Accuracy::goes_on has it go on; null: it has not
};

/// Asked before each iteration whether to end it: by how many there were, and what they have left, |r|/|b|. The same on all ranks. Of the
/// deck's own methods only CG asks.
using GivesUp = std::function<bool(int iterations, double residual)>;

/// Belos' Krylov methods for one operator, the preconditioner on the right; each solver manager is made once. The deck's method solves
/// for a symmetric H. Where H is not symmetric, and the method needs that, GMRES stands in for it. All members are collective.
class Krylov
{
public:
  Krylov(const LinearSolverOptions &options, const RCP<const Operator> &H);
  ~Krylov();

  /// x <- approximately H^-1 b, from the preconditioner's start, else from 0. Where rounding ends the iteration with a good x,
  /// it goes on from the residual, (4.9a). A breakdown is a result, with x as far as it came.
  /// @param B  prepared for H   @param b  not 0
  /// @param wanted  its error counts where the method is CG as rpc sets it up, and H is symmetric
  /// @param gives_up  null: never
  /// @throws Interrupted on all ranks
  KrylovResult solve(const Preconditioner &B, bool is_symmetric, const Vector &b, Vector &x, const Accuracy &wanted,
                     const GivesUp &gives_up = {});

private:
  class Applied;
  struct Method;
  Method &for_any_matrix();
  KrylovResult solve_once_more(const Preconditioner &B, bool is_symmetric, const Vector &b, Vector &x,
                               const Accuracy &wanted, const GivesUp &gives_up);
  KrylovResult iterate(Method &method, bool is_symmetric, const Preconditioner &B, const Vector &b, Vector &x,
                       const Accuracy &wanted, const GivesUp &gives_up);

  LinearSolverOptions options_;
  RCP<const Operator> H_;
  std::unique_ptr<Method> of_deck_, gmres_; // gmres_ is null until it is needed
  double rate_ = 1;                         // of EnergyError in the last solve that was asked for an error
};

} // namespace rpc::solver
