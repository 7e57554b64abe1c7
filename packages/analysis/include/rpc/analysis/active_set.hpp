// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/coarse_choice.hpp"
#include "rpc/analysis/solve_step.hpp"
#include "rpc/contact/iterate.hpp"
#include "rpc/core/headway.hpp"
#include "rpc/solver/minimization_steps.hpp"

#include <array>
#include <limits>
#include <optional>

namespace rpc::analysis
{

/// When the active-set iteration is content.
struct ActiveSetTolerances {
  double residual = 1e-10;            ///< |F|_2 / |load|_2, > 0
  double pressure = 1e-7;             ///< error of pressures, over the largest, > 0
  bool nearly_incompressible = false; ///< the body is: pressures err by more than displacements
};

/// By the options for Newton and Uzawa. (5.10)
ActiveSetTolerances active_set_tolerances(const StepOptions &options);

/// The loop of a minimization: choose the active set, solve for it, until a choice confirms itself. doc/theory.md (5.7) to (5.9)
///
/// The active set is chosen by the last pressures, and the step goes to the minimum for it, by a rough solve while the active set changes. It
/// converges where a choice confirms the last active set, which is then the solution's, up to the share k/r that the penalty leaves to a
/// multiplier update. Where choices make no progress another method is next, see Method.
class ActiveSetLoop
{
public:
  /// What follows where no choice is confirmed.
  enum class Then {
    newton, ///< Newton's directions with their line search
    nothing ///< the minimization ends, as if converged; few changes are tried
  };
  using Status = solver::MinimizationSteps::Status;
  ActiveSetLoop(contact::Iterate &iterate, const ActiveSetTolerances &tolerances, Then then = Then::newton);

  /// The start is a coarser mesh's solution. What led to its states makes the first steps, or choices by the coarser mesh where
  /// pressures were not enough; except with friction.
  /// @param coarse_choice  empty: there are no such choices
  void starts_predicted(FoundBy coarser, MakeCoarseChoice coarse_choice = {});
  /// The start solves a problem near this one: solves are accurate at once, and rough only once states change.
  void starts_near() { rough_ = false; }
  Status operator()(solver::MinimizationSteps &steps);

  FoundBy found_by() const;                     ///< what has been at work
  bool confirmed() const { return confirmed_; } ///< the active set is the solution's
  int steps() const { return steps_; }          ///< but for Newton's
  int coarse_choices() const { return coarse_choices_; }

private:
  /// The method of the next step, and when it is taken:
  ///
  ///     choices            at the start; where the path's states or Newton's have settled
  ///     interior_path      once, without friction: where choices by a coarser mesh fail, or Newton is slow (5.9a)
  ///     newton_from_start  where choices by pressures make no progress (5.8a), before the path
  ///     newton             where they make none with friction or after the path; where the path or a linear solve fails
  enum class Method { choices, interior_path, newton_from_start, newton };
  enum class Verdict { go_on, converged, over };
  /// How Newton's steps have gone, one after the other.
  struct NewtonProgress {
    int steps = 0;
    double left = 1; ///< product of |1 - t|, of each not too little: part of the way that is left, were there no kinks
  };

  Status begin(solver::MinimizationSteps &steps);
  Status judge(solver::MinimizationSteps &steps);
  Status end_choices(solver::MinimizationSteps &steps, Verdict verdict);
  Status leave_to_newton(solver::MinimizationSteps &steps);
  Status step_to_choice(solver::MinimizationSteps &steps);
  bool solve_in_space(solver::MinimizationSteps &steps, const solver::Accuracy &rough, const Vector &F, Vector &d);
  Status step_on_path(solver::MinimizationSteps &steps);
  Status newton_step(solver::MinimizationSteps &steps);
  bool newton_hands_over(solver::MinimizationSteps &steps);
  void back_to_start(solver::MinimizationSteps &steps);
  Verdict choose_at(solver::NewtonGroup &at);
  contact::ActiveSetChoice choose_next(const Vector &u) const;
  bool confirms(const Vector &u, const Vector &d) const;
  Verdict choose(const Vector &u);
  bool is_new_choice();
  bool may_settle();
  bool is_for_coarse_mesh() const;
  bool begin_coarse_choices(const Vector &u);
  bool choose_by_coarse_mesh(const Vector &u);
  solver::Accuracy wanted() const;
  Verdict give_up(const Vector &u);
  void take_path(const Vector &u);
  void take_over(const Vector &u);
  void start_over(std::optional<contact::ActiveSetChoice> choice);
  bool leaves_path();
  bool solve_interior(solver::NewtonContext &context, const Vector &u, Vector &direction);

  contact::Iterate &iterate_;
  double scale_, target_;                          // of forces, and |F|_2 that is small enough [N]
  double pressure_tolerance_;                      // over the largest pressure
  double most_overshoot_;                          // of forces, before choices end
  std::optional<contact::ActiveSetChoice> choice_; // at the present point
  Vector start_;                                   // to go back to, with
  contact::DualVariables::Values start_dual_;      // its multipliers
  bool rough_;                                     // solves are, while the active set changes
  bool rubs_;                                      // there is friction
  bool turns_ = false;                             // and in space: the branches of an active set are not linear
  bool space_fails_ = false;                       // a solve that follows them has not come nearer: linear ones follow
  bool confirmed_ = false;
  std::optional<FoundBy> predicted_;     // what to begin with where a coarser mesh predicts the start
  MakeCoarseChoice make_coarse_;         // empty: there are none, or they have begun
  std::unique_ptr<CoarseChoice> coarse_; // null: pressures choose
  bool coarse_gave_up_ = false;          // there were none that settled
  int coarse_choices_ = 0;
  Method method_ = Method::choices;
  NewtonProgress newton_;
  bool newton_was_tried_ = false; // from the start
  int confirmations_ = 0;         // of where Newton has settled
  Then then_;
  double norm_ = std::numeric_limits<double>::infinity(),
         before_ = norm_,      // |F|_2 for the active set, after and before the step
      confirmed_norm_ = norm_; // and after the last one that confirmed the active set
  double solve_seconds_ = 0;   // about what the last solve takes on one rank
  int steps_ = 0;
  int updates_ = 0;           // of the multipliers alone, the active set being confirmed
  int choices_ = 0;           // since the start, or since the path
  Headway headway_;           // of these; those with much overshoot count twice
  Headway confirmed_headway_; // of steps of a confirmed active set
  GO fewest_changes_ = 0;     // fewest points that one of them has changed; 0: there was none
  double left_ = std::numeric_limits<double>::infinity(); // so many more would follow at this rate
  std::array<double, 3> levers_{}; // of the last ones, the last one first: overshoot o as o / (1 - o)
  enum class Path { ahead, begun, behind } path_ = Path::ahead; // the interior-point method,
  std::optional<contact::InteriorPath> interior_;               // which is there when it has begun
  int path_steps_ = 0;
  double trial_gap_; // of the path, at which the states that it leads to are tried
};

} // namespace rpc::analysis
