// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/active_set.hpp"

#include "rpc/analysis/rules.hpp"
#include "rpc/core/rules.hpp"
#include "rpc/solver/rules.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rpc::analysis
{

using solver::MinimizationSteps;

using Status = ActiveSetLoop::Status;

namespace
{

constexpr double rounding = 1e-13; // of the largest pressure: violations below change no state

/// Choices, of which so many may make no progress.
Headway within(const int most)
{
  return Headway({1, Headway::unlimited, most});
}

} // namespace

// The active set: chosen by the last pressures, until a choice confirms itself --------------------------------------------

ActiveSetLoop::ActiveSetLoop(contact::Iterate &iterate, const ActiveSetTolerances &tolerances, const Then then)
    : iterate_(iterate), scale_(iterate.force_scale()), target_(tolerances.residual * scale_),
      pressure_tolerance_(tolerances.pressure),
      most_overshoot_(tolerances.nearly_incompressible ? choice_rules.far_too_much_of_rubber
                                                       : choice_rules.far_too_much),
      start_(iterate.hessian()->getDomainMap()),
      rough_(iterate.points().num_total > iterate.points().num_fixed), // else there is no state to choose
      rubs_(iterate_.points().friction.anywhere), then_(then), headway_(within(choice_rules.most_idle)),
      confirmed_headway_({headway_rules.falls, 0}), trial_gap_(path_rules.trial)
{
  if (!rubs_) return;
  path_ = Path::behind; // it knows no friction
  turns_ = iterate_.points().dim == 3;
  confirmed_headway_ = Headway({headway_rules.falls, turns_ ? choice_rules.most_idle_turns : 0});
  headway_ = within(choice_rules.most_with_friction);
}

void ActiveSetLoop::starts_predicted(const FoundBy coarser, MakeCoarseChoice coarse_choice)
{
  predicted_ = rubs_ ? FoundBy::choices : coarser;
  if (!rubs_) make_coarse_ = std::move(coarse_choice);
}

FoundBy ActiveSetLoop::found_by() const
{
  if (!rubs_ && path_ != Path::ahead) return FoundBy::interior_path;
  if (newton_was_tried_) return FoundBy::newton;
  return coarse_choices_ > 0 ? FoundBy::coarse_choices : FoundBy::choices;
}

Status ActiveSetLoop::operator()(MinimizationSteps &steps)
{
  Status status = begin(steps);
  while (status == Status::goes_on) {
    if (method_ == Method::newton_from_start) back_to_start(steps);
    status = method_ == Method::choices         ? step_to_choice(steps)
             : method_ == Method::interior_path ? step_on_path(steps)
                                                : newton_step(steps);
  }
  return status;
}

/// With what has led to the states of a coarser mesh, or else a choice.
Status ActiveSetLoop::begin(MinimizationSteps &steps)
{
  const Vector &u = solver::tpetra(steps.at().getX());
  start_.assign(u);
  start_dual_ = iterate_.duals().values();
  if (make_coarse_ || !predicted_ || *predicted_ < FoundBy::newton) return judge(steps);
  if (*predicted_ == FoundBy::newton)
    method_ = Method::newton_from_start;
  else
    take_path(u);
  return Status::goes_on;
}

/// Chooses where a step has led to.
Status ActiveSetLoop::judge(MinimizationSteps &steps)
{
  const Verdict verdict = choose_at(steps.at());
  return verdict == Verdict::go_on ? steps.unless_last(Status::goes_on) : end_choices(steps, verdict);
}

ActiveSetLoop::Verdict ActiveSetLoop::choose_at(solver::NewtonGroup &at)
{
  const Vector &u = solver::tpetra(at.getX());
  if (steps_ > 0) {
    Vector F(u.getMap());
    iterate_.active_set_gradient(u, solver::tpetra(at.getF()), F); // (5.6)
    norm_ = F.norm2();
  }
  return choose(u);
}

/// Choices end: with the minimum, unless the deck's status tests are to tell that, or Newton goes on from here.
Status ActiveSetLoop::end_choices(MinimizationSteps &steps, const Verdict verdict)
{
  if (verdict == Verdict::over && then_ == Then::nothing) return Status::converged;
  if (verdict == Verdict::converged && !steps.user_decides()) return Status::converged;
  method_ = Method::newton;
  newton_ = {};
  return steps.newton_begins();
}

/// There is no step to make for the choice: Newton makes the next one.
Status ActiveSetLoop::leave_to_newton(MinimizationSteps &steps)
{
  method_ = Method::newton;
  newton_ = {};
  if (then_ == Then::newton) return Status::goes_on;
  const Status status = steps.stay();
  return status == Status::goes_on ? Status::converged : status;
}

Status ActiveSetLoop::newton_step(MinimizationSteps &steps)
{
  confirmed_ = false; // it was for the point that this step leaves
  const Status status = steps.newton_step();
  if (status != Status::goes_on || !newton_hands_over(steps) || method_ == Method::interior_path) return status;
  const Verdict verdict = choose_at(steps.at());
  if (verdict == Verdict::converged) return end_choices(steps, verdict);
  return verdict == Verdict::go_on ? Status::goes_on : leave_to_newton(steps);
}

/// Where Newton has settled, the states are to be confirmed there; where it is slow, the interior-point method is next, once.    (5.9a)
bool ActiveSetLoop::newton_hands_over(MinimizationSteps &steps)
{
  const Vector &u = solver::tpetra(steps.at().getX());
  const solver::NewtonContext &context = steps.context();
  ++newton_.steps;
  newton_.left *= std::max<double>(solver::newton_rules.forcing, std::abs(1 - context.step_length));
  const bool has_settled = std::abs(context.step_length - 1) <= solver::newton_rules.to_the_minimum &&
                           context.functional.piece(u) == context.piece;
  if (has_settled && !rubs_ && confirmations_ < solver::newton_rules.most_inner_steps) {
    ++confirmations_;
    take_over(u);
    return true;
  }
  const bool is_slow = newton_.steps > 1 && newton_.left > std::pow(1 - solver::newton_rules.full_step, newton_.steps);
  if (path_ != Path::ahead || !is_slow) return false;
  take_path(u);
  return true;
}

void ActiveSetLoop::take_path(const Vector &u)
{
  interior_.emplace(iterate_.interior_path(u));
  path_ = Path::begun;
  method_ = Method::interior_path;
}

/// Choices go on from a point where Newton has settled.
void ActiveSetLoop::take_over(const Vector &u)
{
  iterate_.update_hessian(u); // the states there
  start_.assign(u);
  start_dual_ = iterate_.duals().values();
  start_over({});
  updates_ = 0;
}

/// Choices start anew.
void ActiveSetLoop::start_over(std::optional<contact::ActiveSetChoice> choice)
{
  method_ = Method::choices;
  choice_ = std::move(choice);
  choices_ = 1; // the first one of all has no solve before it
  headway_ = within(path_rules.trial_changes);
  fewest_changes_ = 0;
  left_ = std::numeric_limits<double>::infinity();
  levers_ = {};
  norm_ = before_ = confirmed_norm_ = std::numeric_limits<double>::infinity();
  rough_ = false; // a small residual may be all of the bending
}

/// (5.8)
contact::ActiveSetChoice ActiveSetLoop::choose_next(const Vector &u) const
{
  return iterate_.choose_active_set(u, std::max(choice_rules.negligible * pressure_tolerance_, rounding));
}

/// What becomes of the iteration at a point, after the step that led there.
ActiveSetLoop::Verdict ActiveSetLoop::choose(const Vector &u)
{
  confirmed_ = false;
  choice_ = choose_next(u);
  // The active set does not change at first: one accurate solve, which keeps the energy balance to rounding.
  if (choice_->changes == 0 && steps_ == 0) rough_ = false;
  if (choice_->confirmed) {
    const bool solved_well = norm_ <= target_;
    confirmed_ = solved_well && (iterate_.pressure_error(u) <= pressure_tolerance_ ||
                                 ++updates_ > choice_rules.most_updates); // (5.10)
    // Rounding may end progress below: where the foundation's forces are many times the load, F grows and falls with each step.
    const bool tells = steps_ > 0 && !rough_ && !solved_well;
    const auto answer =
        tells ? confirmed_headway_.add(norm_, std::min(before_, confirmed_norm_)) : confirmed_headway_.take(true);
    if (!rough_) confirmed_norm_ = turns_ ? std::min(confirmed_norm_, norm_) : norm_; // slip may turn round and round
    if (confirmed_) return Verdict::converged;
    confirmed_ = rubs_ && !turns_ && answer == Headway::Answer::stuck; // what is left is rounding
    if (answer == Headway::Answer::stuck) return Verdict::over;
    rough_ = false;
  } else if (coarse_) {
    if (!choose_by_coarse_mesh(u)) return give_up(u);
  } else if (!is_new_choice() || !may_settle()) {
    return give_up(u); // in circles, or too slow
  } else if (is_for_coarse_mesh() && begin_coarse_choices(u)) {
    return Verdict::go_on;
  } else if (steps_ == 1) {
    rough_ = true; // the active set changes after all
  }
  return Verdict::go_on;
}

/// Whether the choice has not been taken before. With friction a part of the changes may be new where all of them are not.
bool ActiveSetLoop::is_new_choice()
{
  using Answer = Headway::Answer;
  if (headway_.visit(choice_->fingerprint, turns_ ? choice_rules.most_visits : 1) != Answer::cycle) return true;
  if (rubs_)
    for (const double part : {double(choice_rules.first_part), 1.}) {
      choice_ = iterate_.largest_changes(*choice_, part);
      if (choice_->changes > 0 && headway_.visit(choice_->fingerprint) == Answer::progress) return true;
    }
  // What rough solves leave may decide; by good ones hardly a point goes to and fro. Those have been tried before a Tresca problem.
  if (!rough_ || then_ == Then::nothing) return false;
  rough_ = false;
  headway_.forget_visits();
  headway_.visit(choice_->fingerprint);
  return true;
}

/// Whether the choices may come to an end soon.                                                                   (5.8a)
bool ActiveSetLoop::may_settle()
{
  const int before = choices_++;
  if (rubs_) return headway_.take(false) != Headway::Answer::stuck;
  const GO changes = choice_->changes;
  const double overshoot = choice_->overshoot, infinity = std::numeric_limits<double>::infinity();
  const double lever = overshoot < 1 ? overshoot / (1 - overshoot) : infinity;
  const bool creeps = lever > 0 && lever < levers_[1] && levers_[0] < levers_[2];
  const bool is_near = creeps && 2 * lever <= choice_rules.most_left * (levers_[1] - lever);
  levers_ = {lever, levers_[0], levers_[1]};
  if (before == 0) return true; // not by a solve, but by where it starts
  const auto number = static_cast<double>(changes), fewest = static_cast<double>(fewest_changes_);
  left_ = number < fewest ? std::log(number) / std::log(fewest / number) : infinity;
  const bool contracts = left_ <= choice_rules.most_left;
  fewest_changes_ = fewest_changes_ > 0 ? std::min(fewest_changes_, changes) : changes;
  const bool tells = predicted_ || before > 1;
  if (tells && changes > choice_rules.few_changes && overshoot > most_overshoot_) return false;
  if (creeps && !is_near && !contracts && before >= choice_rules.fewest_to_tell) return false;
  return headway_.take(contracts || is_near, overshoot > choice_rules.much ? 2 : 1) != Headway::Answer::stuck;
}

/// Whether it is time for choices by a coarser mesh.
bool ActiveSetLoop::is_for_coarse_mesh() const
{
  const bool was_needed = predicted_ && *predicted_ != FoundBy::choices; // more than choices by pressures, there
  return was_needed || (steps_ >= choice_rules.fewest_to_tell && left_ > 1) ||
         choice_->overshoot > choice_rules.much * most_overshoot_;
}

/// From here on a coarser mesh chooses, if there is one that can. @return whether it has chosen
bool ActiveSetLoop::begin_coarse_choices(const Vector &u)
{
  if (!make_coarse_ || steps_ == 0 || path_ != Path::ahead) return false;
  coarse_ = std::exchange(make_coarse_, {})(iterate_, solve_seconds_);
  return coarse_ && choose_by_coarse_mesh(u);
}

/// The next choice by the coarser mesh. Where it makes none, it chooses no more.
bool ActiveSetLoop::choose_by_coarse_mesh(const Vector &u)
{
  auto chosen = coarse_->choose(iterate_, *choice_, u);
  if (!chosen) {
    coarse_.reset();
    coarse_gave_up_ = true;
    return false;
  }
  choice_ = std::move(chosen);
  ++coarse_choices_;
  rough_ = true;
  return true;
}

/// The coarser mesh chooses, if it has not yet. Where it could not, the interior-point method follows from here, else Newton from the start.
/// Where that method has begun it goes on; where it has been, Newton does from here.
ActiveSetLoop::Verdict ActiveSetLoop::give_up(const Vector &u)
{
  if (begin_coarse_choices(u)) return Verdict::go_on;
  if (path_ == Path::behind) return Verdict::over;
  if (path_ != Path::ahead)
    method_ = Method::interior_path;
  else if (coarse_gave_up_)
    take_path(u);
  else
    method_ = Method::newton_from_start;
  return Verdict::go_on;
}

void ActiveSetLoop::back_to_start(MinimizationSteps &steps)
{
  method_ = Method::newton;
  newton_ = {};
  newton_was_tried_ = true;
  iterate_.duals().take(start_dual_);
  steps.move_to(rcp(new Vector(start_, Teuchos::Copy)));
}

/// What the next solve is to leave: roughly while states change; while slip turns the better the shorter the step is.
solver::Accuracy ActiveSetLoop::wanted() const
{
  double rough = 0;
  if (rough_ && coarse_) return {choice_rules.enough * target_ / norm_, choice_rules.coarse_error};
  if (rough_)
    rough = solver::newton_rules.forcing * std::min(scale_, norm_);
  else if (turns_)
    rough = std::min<double>(solver::newton_rules.forcing, norm_ / scale_) * norm_;
  return {std::max(choice_rules.enough * target_, rough) / norm_, rough_ ? choice_rules.rough_error : 0.};
}

/// Whether the active set would be confirmed, and its pressures good enough, at u - d.
bool ActiveSetLoop::confirms(const Vector &u, const Vector &d) const
{
  Vector at(u, Teuchos::Copy);
  at.update(-1., d, 1.);
  return choose_next(at).confirmed && iterate_.pressure_error(at) <= pressure_tolerance_;
}

/// A step to the minimum for the chosen active set.
Status ActiveSetLoop::step_to_choice(MinimizationSteps &steps)
{
  auto u = rcp(new Vector(solver::tpetra(steps.at().getX()), Teuchos::Copy));
  Vector F(u->getMap());
  while (true) {
    iterate_.take_active_set(*choice_, *u); // (5.7)
    choice_.reset();
    steps.move_to(u);
    iterate_.active_set_gradient(*u, solver::tpetra(steps.at().getF()), F);
    before_ = norm_ = F.norm2();
    if (norm_ > target_) break;
    const Verdict verdict = choose(*u); // nothing to solve for: the next choice
    if (verdict == Verdict::go_on && method_ == Method::choices) continue;
    if (verdict == Verdict::go_on) return Status::goes_on;
    if (verdict == Verdict::over) return leave_to_newton(steps);
    const Status status = steps.stay();
    return status == Status::goes_on ? end_choices(steps, verdict) : status;
  }
  const bool may_end =
      rough_ && rubs_ && then_ == Then::newton; // what follows Tresca problems goes back to where it began
  if (!rough_ || may_end) { // what is left is small against u: solving for it keeps its relative accuracy        (5.13)
    start_.update(-1., *u, 1.);
    iterate_.move_origin(*u);
    if (!rough_) {
      start_.putScalar(0);
      start_dual_ = iterate_.duals().values();
    }
    steps.move_to(u);
  }
  u = Teuchos::null; // a solve needs the memory

  const auto direction = rcp(new Vector(F.getMap()));
  solver::Accuracy asked = wanted(); // (5.9)
  const bool in_space = turns_ && then_ == Then::newton && solve_in_space(steps, asked, F, *direction);
  if (may_end && !turns_) {
    asked.goes_on = [&](const Vector &d) { return confirms(solver::tpetra(steps.at().getX()), d); };
    asked.further = choice_rules.enough * target_ / norm_;
  }
  solver::LinearSolver::Result solved;
  solved.converged = in_space;
  if (!in_space) solved = solver::solve_for_direction(steps.context(), F, *direction, asked);
  if (!solved.converged) { // an active set that leaves the body unheld, or an interrupt
    if (!solved.interrupted) {
      iterate_.duals().reset();
      steps.move_to(rcp(new Vector(start_, Teuchos::Copy)));
    }
    return leave_to_newton(steps);
  }
  if (make_coarse_) solve_seconds_ = steps.context().linear_solver.one_rank_seconds_of_last_solve();
  if (!in_space) direction->scale(-1.);
  ++steps.context().steps;
  ++steps_;
  const Status status = steps.take(direction);
  return status == Status::goes_on ? judge(steps) : status;
}

} // namespace rpc::analysis
