#pragma once

#include "rpc/core/updated_operator.hpp"

#include <Teuchos_ParameterList.hpp>
#include <memory>
#include <string>
#include <vector>

namespace rpc::solver
{

/// Krylov method and preconditioner for symmetric positive definite systems.
struct LinearSolverOptions {
  std::string method = "Pseudoblock CG"; ///< name in Belos' solver factory
  double tolerance = 1e-11;              ///< |r| / |b|, dimensionless, > 0
  int max_iterations = 500;              ///< > 0
  std::string reuse = "tP";              ///< what of a hierarchy outlives a change of the matrix: none, tP, RP
  Teuchos::ParameterList belos;          ///< on top of the defaults
  Teuchos::ParameterList muelu;          ///< on top of the defaults
};

/// Parameters of the deck's `Linear Solver` sublist; `Belos` and `MueLu` pass through.
Teuchos::ParameterList valid_linear_solver_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
LinearSolverOptions linear_solver_options(const Teuchos::ParameterList &list);

/// What was done, for the summary.
struct LinearSolverCounts {
  std::vector<int> iterations;   ///< per solve
  int preconditioner_setups = 0; ///< of multigrid, of any kind
  int local_corrections = 0;     ///< changes of contact that did with a correction of the preconditioner
  double setup_seconds = 0;
  double solve_seconds = 0;
};

/// Belos with a smoothed-aggregation MueLu hierarchy that knows the rigid body modes.
///
/// The hierarchy is set up at the first solve, for contact nodes that are at most a little stiffer than the body. Exact solves
/// around them bring in the rest of their stiffness and follow changes of the contact states, doc/theory.md (4.8), (4.9). The
/// hierarchy is set up again, reusing what `reuse` allows, when these get too large or CG says so, and from scratch where a
/// solve fails.
class LinearSolver
{
public:
  /// @param H            may change between solves; its matrix is written when the hierarchy is set up
  /// @param coordinates  (nodes; dim)          @param null_space  (rows of A; rigid body modes)
  /// Collective.
  LinearSolver(LinearSolverOptions options, const RCP<UpdatedOperator> &H, const RCP<MultiVector> &coordinates,
               const RCP<MultiVector> &null_space);
  ~LinearSolver();

  struct Result {
    bool converged = false;
    bool broken = false; ///< x is no approximation of anything
    bool interrupted = false;
    int iterations = 0;
    std::string reason; ///< why not, if not
  };
  /// x <- approximately H^-1 b, from x = 0; collective. Failure is a result, not an exception.
  /// @param tolerance  |r| / |b|; never taken below the options' one
  Result solve(const Vector &b, Vector &x, double tolerance);

  /// About F . H^-1 F: one multigrid cycle stands for H^-1. 0 where F is 0, NaN where the cycle breaks
  /// down; collective.
  double inverse_energy(const Vector &F);

  const LinearSolverCounts &counts() const { return counts_; }
  const MultiVector &coordinates() const; ///< (nodes; dim) [m]

private:
  void prepare();
  void set_up();
  bool renew(const RCP<CrsMatrix> &A);
  double excess(double digits) const;
  void set_up_if_worn(double tolerance);
  bool strengthen();
  void judge_preconditioner(int iterations, double residual);
  Result try_to_solve(const Vector &b, Vector &x, double tolerance);

  struct Impl;
  LinearSolverOptions options_;
  LinearSolverCounts counts_;
  std::unique_ptr<Impl> impl_;
};

} // namespace rpc::solver
