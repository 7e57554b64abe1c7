// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/memory.hpp"
#include "rpc/analysis/predictor.hpp"
#include "rpc/analysis/rules.hpp"
#include "rpc/analysis/solve_step.hpp"
#include "rpc/contact/contact_patches.hpp"
#include "rpc/contact/whole_step.hpp"
#include "rpc/core/headway.hpp"
#include "rpc/core/rules.hpp"
#include "rpc/fem/peaks.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace rpc::analysis
{

/// The deck's `Steps`.
struct StepsOptions {
  std::vector<double> times; ///< rising; empty: one step, at the deck's `Time`
  int write_every = 1;       ///< results have every n-th of the times, and the last; > 0
  int max_halvings = 6;      ///< of a step that does not converge, >= 0
  int checkpoint_every = 0;  ///< a checkpoint after every n-th step; 0: none
  int balance_halvings = 20; ///< of a step for its energy balance, >= 0
  /// A step whose energy balance is off by more than this share of the energies is halved, > 0.
  double energy_tolerance = std::numeric_limits<double>::infinity();
};

/// Parameters of the deck's `Steps` sublist.
Teuchos::ParameterList valid_steps_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
StepsOptions steps_options(const Teuchos::ParameterList &list);

/// By how much the energy balance of a step is off, over the largest energy before or after it: the trapezoidal rule for the work is
/// wrong where contact opens or closes within a step. NaN if it is not known.                doc/theory.md (11.3a)
double relative_imbalance(const Energies &before, const Energies &after);

/// A step in numbers. Of one that does not converge the energies are unknown, NaN: they are those of steps that do.
struct StepRecord {
  double time = 0;
  bool converged = false;
  std::string reason; ///< why it is not
  int parts = 1;      ///< steps that it took: more than one where it was halved
  int solves =
      0; ///< of its parts: more than these where points met other dents at the places to which a solve had led them
  bool from_rest = false; ///< StepSolution::from_rest of one of its parts
  Energies energies;
  contact::ContactSums contact;
  std::vector<std::array<double, 3>> side_forces; ///< contact::ContactSums::force of each contact side
  contact::PatchCount patches;                    ///< of all contact sides together; on rank 0
  fem::BodyPeaks body;
  std::vector<std::array<double, 3>> displacements;         ///< means over the place of each Dirichlet condition [m]
  std::vector<std::array<double, 3>> reactions;             ///< as in StepSolution
  std::vector<fem::SixNumbers> rigid_motions, rigid_forces; ///< as in StepSolution
  std::array<double, 3> obstacle{}; ///< how far the obstacle that a force moves is from where it was at t = 0 [m]
  int newton_iterations = 0, linear_solves = 0, linear_iterations = 0, preconditioner_setups = 0;
  double seconds = 0;
};

/// A step that an error has ended: what it took until then, and no other number.
/// @param t  of the step, or of the part of it that failed
StepRecord broken_off(const Model &model, StepRecord until_then, double t, const std::string &reason);

/// Steps one after another on one mesh: each starts from the one before, on the dents that it has left. One stiffness matrix and one
/// multigrid serve all of them, also where gaps and normals change.
///
/// All members are collective.
class LoadHistory
{
public:
  /// @param linear     of all solves
  /// @param predictor  of its steps; without coarser meshes there are no predictions
  LoadHistory(std::shared_ptr<const Problem> problem, StepOptions options, int max_halvings,
              const solver::LinearSolverOptions &linear, Predictor predictor);
  LoadHistory(std::shared_ptr<const Problem> problem, const StepOptions &options, int max_halvings,
              const solver::LinearSolverOptions &linear = {}, const CoarserProblem &coarser = {});
  /// The next step starts from a given memory, such as one interpolated from another mesh.
  /// @param memory  on the problem's mesh
  /// @param before  of the step before it, displacement and pressure, if there was one
  void go_on_from(Memory memory, std::optional<Memory> before = std::nullopt);
  /// Another state from which the next step may start, beside those of the steps before.
  /// @param obstacle  where it has the obstacle that a force moves: the step is first seen from there
  void offer(contact::ContactState start, const Point &obstacle = {})
  {
    offered_ = Offered{std::move(start), obstacle};
  }
  /// Has steps halved whose relative_imbalance() is larger than the energy tolerance, and their halves, until that of the whole step is no
  /// larger either, or halves are no better than the whole.
  void balance_energies(const StepsOptions &options)
  {
    energy_tolerance_ = options.energy_tolerance;
    balance_halvings_ = options.balance_halvings;
  }
  /// Makes multigrid anew, so that what follows depends on memory() and before() alone, bit for bit.
  void start_anew();

  /// The solution at t, later than all before it. A step that does not converge is halved.
  /// @param now       called with each (part of a) step that is about to be solved
  /// @return the solution at t; one that has not converged is not remembered, and may be of a part of the step: last().time
  StepSolution advance(double t, const Progress &progress = {},
                       const std::function<void(const Problem &, const Step &)> &now = {});
  /// The same as one step, whether it converges or not.
  StepSolution solve(double t, const StepOptions &options, const Progress &progress,
                     const std::function<void(const Problem &, const Step &)> &now);

  const Problem &problem() const { return *problem_; }
  const std::shared_ptr<const Problem> &shared_problem() const { return problem_; } ///< to keep it for longer
  /// The coarser scene that predicts this one's steps, if there is one by now, or null.
  std::shared_ptr<const Problem> made_coarser() const { return predictor_.made_coarser(); }
  const Memory *memory() const { return kept_.memory ? &*kept_.memory : nullptr; }
  const Memory *before() const { return kept_.before ? &*kept_.before : nullptr; } ///< of the step before
  const StepRecord &last() const { return last_; }                                 ///< of advance()
  /// The step that advance() has left with an error.
  StepRecord broken_off(const std::string &reason) const;

private:
  /// How often a part may be halved: where it does not converge, and for its energy balance.
  struct Halvings {
    int failures, balance, all;
    double tolerance; // of a part's energy balance
    Headway headway{
        {headway_rules.falls, step_rules.most_attempts}}; // of what the parts around this one miss of the balance [J]
  };
  struct Offered {
    contact::ContactState start;
    Point obstacle;
  };
  /// What is remembered between steps.
  struct Remembered {
    std::optional<Memory> memory, before; // of the last step, and of the one before it
    RCP<const Vector>
        last_forces; // on the body from all but the foundation, after the last step (owned dofs) [N]; null: not known
    contact::WholeStep whole_step; // of the parts that the step in work has so far
  };
  StepSolution advance_in_parts(double t, const Halvings &left, const Progress &progress,
                                const std::function<void(const Problem &, const Step &)> &now);
  double share_missed(const Energies &before, const StepSolution &s, double tolerance) const;
  Starts starts_of(const Step &step, std::optional<Offered> offered);
  void foresee(const MultiVector *met, Step &step, Starts &starts);
  contact::ContactState onto(const contact::ContactNodes &from, const contact::ContactNodes &to,
                             contact::ContactState state) const;
  void take_to_obstacle(const Point &way, StepSolution &s) const;
  void remember(double t, const std::vector<contact::ContactOptions> &sides, const Step &step, StepSolution &s);

  std::shared_ptr<const Problem> problem_;
  StepOptions options_;
  int max_halvings_;
  solver::LinearSolverOptions linear_;
  std::unique_ptr<SolverState> state_;
  Predictor predictor_;
  Remembered kept_;
  std::optional<Offered> offered_;
  StepRecord last_;
  double energy_tolerance_ = std::numeric_limits<double>::infinity();
  int balance_halvings_ = 0;
  double tried_ = 0; // t of the last (part of a) step that was begun
};

} // namespace rpc::analysis
