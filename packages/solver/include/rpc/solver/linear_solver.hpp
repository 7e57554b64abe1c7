#pragma once

#include "rpc/core/tpetra.hpp"

#include <Teuchos_ParameterList.hpp>
#include <memory>
#include <string>
#include <vector>

namespace rpc::solver
{

/// Krylov method and preconditioner for symmetric positive definite systems.
struct LinearSolverOptions {
  std::string method = "Pseudoblock CG"; ///< name in Belos' solver factory
  double tolerance = 1e-8;               ///< |r| / |b|, dimensionless, > 0
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
  int preconditioner_setups = 0; ///< of any kind
  double setup_seconds = 0;
  double solve_seconds = 0;
};

/// Belos with a smoothed-aggregation MueLu hierarchy that knows the rigid body modes.
///
/// The hierarchy is set up at the first solve and again, reusing what `reuse` allows, at the first solve after
/// matrix_changed().
class LinearSolver
{
public:
  /// @param A            SPD; its values may change between solves, its graph not
  /// @param coordinates  (nodes; dim)          @param null_space  (rows of A; rigid body modes)
  /// Collective.
  LinearSolver(LinearSolverOptions options, RCP<CrsMatrix> A, RCP<MultiVector> coordinates,
               RCP<MultiVector> null_space);
  ~LinearSolver();

  struct Result {
    bool converged = false;
    bool broken = false; ///< x is no approximation of anything
    int iterations = 0;
    std::string reason; ///< why not, if not
  };
  /// x <- approximately A^-1 b, from x = 0; collective. Failure is a result, not an exception.
  /// @param tolerance  |r| / |b|; never taken below the options' one
  Result solve(const Vector &b, Vector &x, double tolerance);

  /// About F . A^-1 F: one multigrid cycle stands for A^-1. 0 where F is 0, NaN where the cycle breaks
  /// down; collective.
  double inverse_energy(const Vector &F);

  void matrix_changed();
  const LinearSolverCounts &counts() const { return counts_; }
  double tolerance() const { return options_.tolerance; }
  const MultiVector &coordinates() const; ///< (nodes; dim) [m]

private:
  void set_up();
  bool strengthen();
  Result try_to_solve(const Vector &b, Vector &x, double tolerance);

  struct Impl;
  LinearSolverOptions options_;
  LinearSolverCounts counts_;
  std::unique_ptr<Impl> impl_;
};

} // namespace rpc::solver
