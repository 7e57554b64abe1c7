#pragma once

#include "rpc/solver/linear_solver_options.hpp"
#include "rpc/solver/preconditioner.hpp"

#include <memory>

namespace rpc::solver
{

/// Thrown through Belos on all ranks where the run has been asked to stop; no std::exception, of which Belos would tell the console.
struct Interrupted {
};

/// What came out of one Krylov iteration.
struct KrylovResult {
  bool converged = false;
  bool broken = false;  ///< the method broke down, as on an indefinite or singular matrix
  int iterations = 0;   ///< 0 where it broke down: they are not to be had
  double residual = 1;  ///< |r|/|b| by the method's own account; NaN where it broke down
  std::string reason{}; ///< why it did not converge, if it did not
};

/// Belos' Krylov methods for one operator, the preconditioner on the right; each solver manager is made once. The deck's method solves
/// for a symmetric H. Where H is not symmetric, and the method needs that, GMRES stands in for it. All members are collective.
class Krylov
{
public:
  Krylov(const LinearSolverOptions &options, const RCP<const Operator> &H);
  ~Krylov();

  /// x <- approximately H^-1 b, from the preconditioner's start, else from 0. Where rounding ends the iteration with a good x,
  /// it goes on from the residual, (4.9a). A breakdown is a result, with x as far as it came.
  /// @param B  prepared for H   @param b  not 0   @param tolerance  |r| / |b|
  /// @throws Interrupted on all ranks
  KrylovResult solve(const Preconditioner &B, bool is_symmetric, const Vector &b, Vector &x, double tolerance);

private:
  class Applied;
  struct Method;
  Method &for_any_matrix();
  KrylovResult iterate(Method &method, bool is_symmetric, const Preconditioner &B, const Vector &b, Vector &x,
                       double tolerance);

  LinearSolverOptions options_;
  RCP<const Operator> H_;
  std::unique_ptr<Method> of_deck_, gmres_; // gmres_ is null until it is needed
};

} // namespace rpc::solver
