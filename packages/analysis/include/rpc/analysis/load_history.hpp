#pragma once

#include "rpc/analysis/solve_step.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace rpc::analysis
{

/// The deck's `Steps`.
struct StepsOptions {
  std::vector<double> times; ///< rising; empty: one step, at the deck's `Time`
  int write_every = 1;       ///< every so many of the times one goes into the results, and the last; > 0
  int max_halvings = 6;      ///< of a step that does not converge, >= 0
  int checkpoint_every = 0;  ///< a checkpoint after every so many steps; 0: none
};

/// Parameters of the deck's `Steps` sublist.
Teuchos::ParameterList valid_steps_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
StepsOptions steps_options(const Teuchos::ParameterList &list);

/// Energies since the first step began [J], in 2D per m. doc/theory.md (11.3)
struct Energies {
  double strain = 0; ///< a(u, u)/2
  double foundation =
      0; ///< in the foundation's springs, sum of w c p^2/2; where dents do not stay all that denting took
  double dissipated = 0; ///< sum of w int (xi + H w) dw
  double work = 0; ///< of loads, prescribed displacements and the foundation's own motion, by the trapezoidal rule

  /// What the trapezoidal rule, and nothing else, misses: work - strain - foundation - dissipated.
  double imbalance() const { return work - strain - foundation - dissipated; }
};

/// What a step leaves for the next one: plain data on its mesh. doc/theory.md, section 11
struct Memory {
  double time = 0;
  RCP<const Vector> displacement;  ///< (owned dofs) from 0 [m]
  RCP<const MultiVector> pressure; ///< (owned nodes; sides) [Pa]
  RCP<const MultiVector>
      dent; ///< (owned nodes; sides) w, 0 where a side does not remember [m]; of a side whose dents move with
            ///< the foundation, at the nodes' places in the mesh, see contact/moving_dents.hpp
  RCP<const MultiVector> gap; ///< (owned nodes; sides) g, to the surface without dents; where points move along dents,
                              ///< to the surface with those that they stand on [m]
  Energies energies;
};

/// A step in numbers.
struct StepRecord {
  double time = 0;
  bool converged = false;
  int parts = 1; ///< steps that it took: more than one where it was halved
  int solves =
      0; ///< of its parts: more than these where points met other dents at the places to which a solve had led them
  Energies energies;
  contact::ContactSums contact;
  std::vector<std::array<double, 3>> displacements; ///< mean prescribed ones of each Dirichlet condition [m]
  std::vector<std::array<double, 3>> reactions;     ///< as in StepSolution
  int newton_iterations = 0, linear_solves = 0, linear_iterations = 0, preconditioner_setups = 0;
  double seconds = 0;
};

/// Steps one after another on one mesh: each starts from the one before, on the dents that it has left. One stiffness matrix and one
/// multigrid serve all of them.
///
/// All members are collective.
class LoadHistory
{
public:
  /// @param coarser  meshes that predict steps
  LoadHistory(std::shared_ptr<const Problem> problem, StepOptions options, int max_halvings,
              CoarserProblem coarser = {});
  /// The same, going on from what is remembered: dents of other meshes interpolated, for example.
  /// @param memory  on the problem's mesh
  /// @param before  of the step before it, displacement and pressure, if there was one
  void go_on_from(Memory memory, std::optional<Memory> before = std::nullopt);
  /// Another state from which the next step may start, beside those of the steps before.
  void offer(contact::ContactState start) { offered_.push_back(std::move(start)); }
  /// Makes matrix and multigrid anew, so that what follows depends on memory() and before() alone, bit for bit.
  void start_anew();

  /// The solution at t, later than all before it. A step that does not converge is halved.
  /// @param now       called with each (part of a) step that is about to be solved
  /// @return the solution at t; one that has not converged is not remembered
  StepSolution advance(double t, const Progress &progress = {},
                       const std::function<void(const Problem &, const Step &)> &now = {});

  const Problem &problem() const { return *problem_; }
  const Memory *memory() const { return memory_ ? &*memory_ : nullptr; }
  const Memory *before() const { return before_ ? &*before_ : nullptr; } ///< of the step before
  const StepRecord &last() const { return last_; }                       ///< of advance()
  /// Where rows repeat, K is assembled only if an algebraic preconditioner asks for it.
  int matrix_assemblies() const { return assembled_before_ + problem_->stiffness().has_matrix(); }

private:
  struct Coarser;
  /// Where the same step leads on a coarser mesh; none where there is none or it fails.
  /// @param work  becomes that on this mesh and coarser ones, from the coarsest
  std::optional<contact::ContactState> predicted(const Step &step, std::vector<LevelWork> &work);
  StepSolution solve(double t, const Progress &progress, const std::function<void(const Problem &, const Step &)> &now);
  StepSolution advance_in_parts(double t, int halvings, const Progress &progress,
                                const std::function<void(const Problem &, const Step &)> &now);

  std::shared_ptr<const Problem> problem_;
  StepOptions options_;
  int max_halvings_;
  CoarserProblem coarser_;
  std::shared_ptr<Coarser> on_coarser_mesh_; // the same history; null until it is asked for
  std::optional<Memory> memory_, before_;    // of the last step, and of the one before it
  RCP<const Vector>
      last_forces_; // on the body from all but the foundation, after the last step (owned dofs) [N]; null: not known
  std::vector<contact::ContactState> offered_;
  StepRecord last_;
  int assembled_before_ = 0; // for earlier problems
};

/// What is remembered, on another mesh of the same body: by interpolation; dents stay >= 0. Collective.
Memory interpolated(const Memory &memory, const fem::Discretization &from, const fem::Discretization &to);
/// @param interpolation  see fem::interpolation()
Memory interpolated(const Memory &memory, const CrsMatrix &interpolation, const fem::Discretization &to);

} // namespace rpc::analysis
