#pragma once

#include "rpc/algebra/updated_operator.hpp"
#include "rpc/solver/mesh_levels.hpp"

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
  std::string multigrid = "auto";        ///< from where the hierarchy comes: auto, mesh, algebraic
  std::string reuse = "tP";     ///< what of an algebraic hierarchy outlives a change of the matrix: none, tP, RP
  double damping = 4. / 3;      ///< of algebraic prolongators for the whole matrix, unless `muelu` says it
  Teuchos::ParameterList belos; ///< on top of the defaults
  Teuchos::ParameterList muelu; ///< on top of the defaults
};

/// Parameters of the deck's `Linear Solver` sublist; `Belos` and `MueLu` pass through.
Teuchos::ParameterList valid_linear_solver_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
LinearSolverOptions linear_solver_options(const Teuchos::ParameterList &list);

/// What was done, for the summary.
struct LinearSolverCounts {
  std::vector<int> iterations;   ///< per solve
  int preconditioner_setups = 0; ///< of multigrid, of any kind
  int local_corrections = 0;     ///< changes of contact that the preconditioner followed near the contact points only
  std::string fallback;          ///< why multigrid on coarser meshes was given up; empty if it was not
  double setup_seconds = 0;
  double solve_seconds = 0;
};

/// Belos with multigrid: on coarser meshes where there are some, mesh_levels.hpp, followed by an algebraic hierarchy where they do
/// not lead down to few unknowns; else smoothed aggregation by MueLu that knows the rigid body modes.
///
/// Either is set up at the first solve. On meshes it follows changes of the contact states in place, (4.7a). An algebraic hierarchy is
/// set up for contact nodes that are at most a little stiffer than the body. Exact solves around them bring in the rest of their
/// stiffness and follow changes of the contact states, doc/theory.md (4.8), (4.9). It is set up again, reusing what `reuse` allows,
/// when these get too large or CG says so, and from scratch where a solve fails. Where multigrid on meshes fails, the algebraic one
/// takes over. Of few unknowns the matrix is factored.
class LinearSolver
{
public:
  /// @param H            may change between solves
  /// @param coordinates  (nodes; dim)          @param null_space  (rows of A; rigid body modes)
  /// @param levels       makes the coarser meshes; may be null: there are none. Collective.
  LinearSolver(LinearSolverOptions options, const RCP<UpdatedOperator> &H, const RCP<MultiVector> &coordinates,
               const RCP<MultiVector> &null_space, MakeMeshLevels levels = {});
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
  void prepare_on_meshes();
  void set_up();
  void made_anew();
  bool factor(const RCP<CrsMatrix> &A);
  bool renew(const RCP<CrsMatrix> &A);
  double excess(double digits) const;
  void set_up_if_worn(double tolerance);
  bool strengthen();
  void judge_preconditioner(int iterations, double residual);
  double energy_error(const Vector &b, const Vector &residual);
  Result iterate(const Vector &b, Vector &x, double tolerance);
  Result iterate_to_the_end(const Vector &b, Vector &x, double tolerance);
  Result try_to_solve(const Vector &b, Vector &x, double tolerance);
  Result solve_by_meshes(const Vector &b, Vector &x, double tolerance);
  Result solve_algebraically(const Vector &b, Vector &x, double tolerance);

  struct Impl;
  LinearSolverOptions options_;
  LinearSolverCounts counts_;
  std::unique_ptr<Impl> impl_;
};

} // namespace rpc::solver
