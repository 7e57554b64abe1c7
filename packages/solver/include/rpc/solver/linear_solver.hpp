// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/tied_stiffness.hpp"
#include "rpc/algebra/updated_operator.hpp"
#include "rpc/solver/accuracy.hpp"
#include "rpc/solver/linear_solver_options.hpp"
#include "rpc/solver/mesh_levels.hpp"
#include "rpc/solver/mixed_form.hpp"
#include "rpc/solver/preconditioner.hpp"

#include <memory>
#include <string>
#include <vector>

namespace rpc::solver
{

/// A preconditioner that a linear solver may use.
struct CandidateCounts {
  std::string name; ///< such as "meshes"
  bool tried = false;
  int setups = 0, solves = 0, iterations = 0;
  std::string left; ///< why another one took its place, or why it cannot be had; empty: neither
};

/// Whether an iteration takes its least time on a GPU, that of its launches, so that one on a coarser mesh takes no less; never on hosts. Collective.
bool is_bound_by_launches(const StiffnessOperator &K);

class TiedSolver;

/// What was done, for the summary.
struct LinearSolverCounts {
  std::vector<int> iterations;   ///< per solve
  int preconditioner_setups = 0; ///< of multigrid, of any kind
  int local_corrections = 0;     ///< changes of contact that the preconditioner followed near the contact points only
  std::string fallback;          ///< why multigrid on coarser meshes was given up; empty if it was not
  /// Preconditioners in the order in which they took over, each with what made it necessary; each entry once.
  std::vector<std::string> path;
  std::string description; ///< what the last solve was preconditioned with, and why; empty before the first one
  double setup_seconds = 0;
  double solve_seconds = 0;
  std::vector<CandidateCounts> candidates; ///< in the order in which they are considered, since the mesh was made
};

/// What was chosen and why, as one line: the description, and the path where it has led past others.
std::string chosen_solver(const LinearSolverCounts &counts);

/// The path as one line, such as "meshes -> sparse factor: given up after 15 CG iterations"; empty before the first solve.
std::string solver_path(const LinearSolverCounts &counts);

/// A Krylov method of Belos with multigrid: on coarser meshes where there are some, mesh_levels.hpp, followed by an algebraic
/// hierarchy where they do not lead down to few unknowns; else smoothed aggregation by MueLu that knows the rigid body modes. Of few
/// unknowns the matrix is factored. Where the stiffness is given in two parts, BiCGStab solves for pressures too, mixed_form.hpp.
///
/// These are candidates, in an order: the first one that applies is used, set up at the first solve, and follows H when H has changed. The
/// next one takes over where it fails or breaks down, and a sparse factor where CG takes longer by the cost model. Any right side may be
/// solved for: with the same H nothing is set up again, but after a failure.
class LinearSolver
{
public:
  /// @param H       may change between solves
  /// @param body    whose stiffness H is
  /// @param levels  makes the coarser meshes; may be null: there are none. Collective.
  /// @param mixed   splits the stiffness of a nearly incompressible body; may be null: it stays whole
  LinearSolver(LinearSolverOptions options, const RCP<UpdatedOperator> &H, Body body, MakeMeshLevels levels = {},
               MakeMixedForm mixed = {});
  ~LinearSolver();
  /// From here on b and x have groups of tied unknowns, beside H, which takes them as prescribed.                    (4.11)
  void move_as_one(const RCP<const TiedStiffness> &stiffness, const RCP<const UpdatedOperator> &H);

  struct Result {
    bool converged = false;
    bool broken = false; ///< x is no approximation of anything
    bool interrupted = false;
    int iterations = 0;
    double energy = 0;  ///< x . b, about |x|_H^2, where an error was asked for of CG or of the mixed form [J]
    std::string reason; ///< why not, if not
  };
  /// x <- approximately H^-1 b, from x = 0, for any b, which the mixed form takes to be 0 at prescribed unknowns; collective. Failure is a result, not an exception. x is 0 where b is.
  /// @param wanted  a number is |r| / |b|; never taken below the options' one
  Result solve(const Vector &b, Vector &x, const Accuracy &wanted);

  /// The preconditioner in use, brought to H, for a Krylov method of the caller's own: see KrylovSpace. Null where solve() does more than
  /// that: with tied unknowns, in the mixed form, with a method or a list of the deck's, after a set-up that failed. Collective.
  const Preconditioner *preconditioner();
  /// Counts such a solve.
  void count(int iterations, double seconds);

  /// About F . H^-1 F: one multigrid cycle stands for H^-1. 0 where F is 0, NaN where the cycle breaks
  /// down; collective.
  double inverse_energy(const Vector &F);
  /// (groups, groups) By how much forces move the tied unknowns, each with all others as they like, with H of the last solve; empty where there
  /// are none, nothing holds them, or there was no solve. Collective.                                                                    (4.17)
  std::vector<double> softness_of_tied() const;

  const LinearSolverCounts &counts() const;
  /// About what the last solve takes on one rank [s], by constants of one machine: a choice by it is about the same in every run, on any number
  /// of ranks. Collective.
  double one_rank_seconds_of_last_solve() const;
  const Body &body() const;

private:
  Result solve_held(const Vector &b, Vector &x, const Accuracy &wanted);
  double inverse_energy_held(const Vector &F);

  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::shared_ptr<TiedSolver> tied_; // null: there are no tied unknowns
};

} // namespace rpc::solver
