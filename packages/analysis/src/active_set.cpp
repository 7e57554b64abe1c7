// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/active_set.hpp"

#include "rpc/analysis/rules.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rpc::analysis
{

using solver::NewtonGroup;

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

ActiveSetStage::ActiveSetStage(contact::Iterate &iterate, const ActiveSetTolerances &tolerances, const Then then)
    : iterate_(iterate), scale_(iterate.force_scale()), target_(tolerances.residual * scale_),
      pressure_tolerance_(tolerances.pressure),
      most_overshoot_(tolerances.nearly_incompressible ? choice_rules.far_too_much_of_rubber
                                                       : choice_rules.far_too_much),
      start_(iterate.hessian()->getDomainMap()),
      rough_(iterate.points().num_total > iterate.points().num_fixed), // else there is no state to choose
      rubs_(iterate_.points().friction.anywhere), then_(then), headway_(within(choice_rules.most_idle)),
      confirmed_headway_({choice_rules.idle_residual, 0}), trial_gap_(path_rules.first_trial)
{
  if (!rubs_) return;
  path_ = Path::behind; // it knows no friction
  turns_ = iterate_.points().dim == 3;
  confirmed_headway_ = Headway({choice_rules.idle_residual, turns_ ? choice_rules.most_idle_turns : 0});
  headway_ = within(then == Then::nothing ? choice_rules.most_changes_tried : choice_rules.most_changes);
}

void ActiveSetStage::starts_predicted(const FoundBy coarser, MakeCoarseChoice coarse_choice)
{
  predicted_ = rubs_ ? FoundBy::choices : coarser;
  if (!rubs_) make_coarse_ = std::move(coarse_choice);
  newton_is_next_ = predicted_ == FoundBy::newton && !make_coarse_;
}

FoundBy ActiveSetStage::found_by() const
{
  if (!rubs_ && path_ != Path::ahead) return FoundBy::interior_path;
  if (newton_was_tried_) return FoundBy::newton;
  return coarse_choices_ > 0 ? FoundBy::coarse_choices : FoundBy::choices;
}

bool ActiveSetStage::resume(const NewtonGroup &from, const solver::NewtonProgress &newton)
{
  const Vector &u = solver::tpetra(from.getX());
  if (newton.settled && !rubs_ && confirmations_ < choice_rules.most_confirmations) {
    ++confirmations_;
    take_over(u, path_rules.trial_changes);
    return true;
  }
  const bool stands = newton.short_steps >= choice_rules.most_short_steps;
  const bool creeps = newton.steps > 1 && newton.left > std::pow(choice_rules.left_per_step, newton.steps);
  if (path_ == Path::ahead && (stands || creeps)) {
    take_path(u);
    return true;
  }
  if (!stands || std::exchange(resumed_, true)) return false;
  take_over(u, choice_rules.most_changes_resumed);
  return true;
}

void ActiveSetStage::take_path(const Vector &u)
{
  iterate_.start_interior_path(u);
  path_ = Path::on_it;
  decided_ = false;
}

/// Choices go on from a point of Newton's.
void ActiveSetStage::take_over(const Vector &u, const int most)
{
  iterate_.update_hessian(u); // the states there
  start_.assign(u);
  start_dual_ = iterate_.dual();
  start_over({}, most);
  updates_ = 0;
  decided_ = false;
}

/// Choices start anew.
void ActiveSetStage::start_over(std::optional<contact::ActiveSetChoice> choice, const int most)
{
  choice_ = std::move(choice);
  choices_ = 1; // the first one of all has no solve before it
  headway_ = within(most);
  fewest_changes_ = 0;
  left_ = std::numeric_limits<double>::infinity();
  levers_ = {};
  norm_ = before_ = confirmed_norm_ = std::numeric_limits<double>::infinity();
  rough_ = false; // a small residual may be all of the bending
}

/// What becomes of the iteration at a point, after the step that led there.
ActiveSetStage::Verdict ActiveSetStage::choose(const Vector &u)
{
  choice_ = iterate_.choose_active_set(u, std::max(choice_rules.negligible * pressure_tolerance_, rounding)); // (5.8)
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
    if (!rough_) confirmed_norm_ = norm_;
    if (confirmed_) return Verdict::converged;
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
bool ActiveSetStage::is_new_choice()
{
  using Answer = Headway::Answer;
  if (headway_.visit(choice_->fingerprint, turns_ ? choice_rules.most_visits : 1) != Answer::cycle) return true;
  if (!rubs_) { // what rough solves leave may decide; by good ones hardly a point goes to and fro
    if (!rough_) return false;
    rough_ = false;
    headway_.forget_visits();
    headway_.visit(choice_->fingerprint);
    return true;
  }
  for (const double part : {double(choice_rules.first_part), 1.}) {
    choice_ = iterate_.largest_changes(*choice_, part);
    if (choice_->changes > 0 && headway_.visit(choice_->fingerprint) == Answer::progress) return true;
  }
  return false;
}

/// Whether the choices may come to an end soon.                                                                   (5.8a)
bool ActiveSetStage::may_settle()
{
  const int before = choices_++;
  if (rubs_) return headway_.take(false) != Headway::Answer::stuck;
  const GO changes = choice_->changes;
  const double overshoot = choice_->overshoot, infinity = std::numeric_limits<double>::infinity();
  const double lever = overshoot < 1 ? overshoot / (1 - overshoot) : infinity;
  const bool creeps = lever > 0 && lever < levers_[1] && levers_[0] < levers_[2];
  const bool is_near = creeps && 2 * lever <= choice_rules.most_left_creeping * (levers_[1] - lever);
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
bool ActiveSetStage::is_for_coarse_mesh() const
{
  const bool was_needed = predicted_ && *predicted_ != FoundBy::choices; // more than choices by pressures, there
  return was_needed || (steps_ >= choice_rules.steps_before_coarse && left_ > choice_rules.one_more) ||
         choice_->overshoot > choice_rules.much * most_overshoot_;
}

/// From here on a coarser mesh chooses, if there is one that can. @return whether it has chosen
bool ActiveSetStage::begin_coarse_choices(const Vector &u)
{
  if (!make_coarse_ || steps_ == 0 || path_ != Path::ahead) return false;
  coarse_ = std::exchange(make_coarse_, {})(iterate_, solve_seconds_);
  return coarse_ && choose_by_coarse_mesh(u);
}

/// The next choice by the coarser mesh. Where it makes none, it chooses no more.
bool ActiveSetStage::choose_by_coarse_mesh(const Vector &u)
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
ActiveSetStage::Verdict ActiveSetStage::give_up(const Vector &u)
{
  if (begin_coarse_choices(u)) return Verdict::go_on;
  if (path_ == Path::behind) return Verdict::over;
  if (path_ != Path::ahead)
    path_ = Path::on_it;
  else if (coarse_gave_up_)
    take_path(u);
  else
    newton_is_next_ = true;
  return Verdict::go_on;
}

/// Goes back to the start, where Newton begins.
ActiveSetStage::Step ActiveSetStage::leave_to_newton(NewtonGroup &group)
{
  newton_is_next_ = false;
  newton_was_tried_ = true;
  iterate_.take_dual(start_dual_);
  group.setX(solver::NoxVector(rcp(new Vector(start_, Teuchos::Copy))));
  group.computeF();
  return Step::none;
}

/// Whether the states that the path leads to are to be tried, or taken; then they are the next choice.
bool ActiveSetStage::leaves_path()
{
  const auto &path = iterate_.interior_path();
  const bool ends = path.gap() <= path_rules.last_gap || path_steps_ >= path_rules.most_steps;
  if (!ends && !(path.settled() && path.gap() <= trial_gap_)) return false;
  path_ = ends ? Path::behind : Path::tried;
  trial_gap_ = path_rules.next_trial * path.gap();
  start_over(iterate_.end_of_interior_path(), path_rules.trial_changes); // (5.20)
  return true;
}

ActiveSetStage::Step ActiveSetStage::propose_interior(NewtonGroup &group, Vector &direction)
{
  const Vector &u = solver::tpetra(group.getX());
  if (!solve_interior(group.context(), u, direction)) {
    path_ = Path::behind;
    return Step::none;
  }
  const double t = iterate_.advance_interior(u, direction);
  if (!(t > 0)) return Step::none;
  direction.scale(t);
  ++path_steps_;
  ++group.context().steps;
  ++steps_;
  return Step::full;
}

/// The direction of a step of the path: predictor, and what it lacks of the correctors.             (5.18) to (5.19a)
/// @return whether it can be used
bool ActiveSetStage::solve_interior(solver::NewtonContext &context, const Vector &u, Vector &direction)
{
  double energy = 0; // of the predictor
  const auto solve = [&](const Vector &F, Vector &d, const double tolerance) {
    const auto solved = solver::solve_for_direction(context, F, d, {tolerance, path_rules.error, energy});
    energy = solved.energy;
    return !solved.broken && !solved.interrupted && std::isfinite(context.direction_norm);
  };
  // Brings d to -H^-1 F, by a solve for what it lacks; false where that fails.
  const auto improve = [&](const Vector &F, Vector &d) {
    Vector lacking(u.getMap());
    iterate_.hessian()->apply(d, lacking);
    lacking.update(1., F, 1.);
    const double wanted = path_rules.forcing * F.norm2(), missing = lacking.norm2();
    if (missing <= wanted) return true;
    const int iterations = context.linear_iterations;
    Vector correction(u.getMap());
    if (!solve(lacking, correction, wanted / missing)) return false;
    context.linear_iterations += iterations;
    d.update(-1., correction, 1.);
    return true;
  };
  Vector F(u.getMap());
  iterate_.linearize_interior(u, F);
  if (!solve(F, direction, path_rules.forcing)) return false;
  direction.scale(-1.);
  iterate_.correct_interior(u, direction, F);
  if (!improve(F, direction)) return false;
  double t = iterate_.longest_interior_step(u, direction);
  for (int times = 0; times < path_rules.most_centerings && t < path_rules.long_enough; ++times) {
    iterate_.center_interior(u, direction, F);
    Vector centered(direction, Teuchos::Copy);
    const double longer = improve(F, centered) ? iterate_.longest_interior_step(u, centered) : 0;
    if (longer > t)
      direction.assign(centered);
    else
      iterate_.take_back_interior();
    if (longer < t + path_rules.least_gain) break;
    t = longer;
  }
  return true;
}

/// What the next solve is to leave: roughly while states change; while slip turns the better the shorter the step is.
solver::Accuracy ActiveSetStage::wanted() const
{
  double rough = 0;
  if (rough_ && coarse_) return {choice_rules.enough * target_ / norm_, choice_rules.coarse_error};
  if (rough_)
    rough = choice_rules.forcing * std::min(scale_, norm_);
  else if (turns_)
    rough = std::min<double>(choice_rules.forcing, norm_ / scale_) * norm_;
  return {std::max(choice_rules.enough * target_, rough) / norm_, rough_ ? choice_rules.rough_error : 0.};
}

ActiveSetStage::Verdict ActiveSetStage::judge(const NewtonGroup &at)
{
  const Verdict verdict = judged(at);
  return verdict == Verdict::over && then_ == Then::nothing ? Verdict::converged : verdict;
}

ActiveSetStage::Step ActiveSetStage::propose(NewtonGroup &group, Vector &direction)
{
  const Step step = proposed(group, direction);
  if (step != Step::none || then_ == Then::newton) return step;
  decided_ = true;
  direction.putScalar(0);
  return Step::full;
}

ActiveSetStage::Verdict ActiveSetStage::judged(const NewtonGroup &at)
{
  if (decided_) return confirmed_ ? Verdict::converged : Verdict::over;
  if (path_ == Path::on_it) return Verdict::go_on;
  const Vector &u = solver::tpetra(at.getX());
  if (steps_ == 0) {
    start_.assign(u);
    start_dual_ = iterate_.dual();
    if (predicted_ == FoundBy::interior_path && !make_coarse_ && path_ == Path::ahead) take_path(u);
    if (newton_is_next_ || path_ == Path::on_it) return Verdict::go_on;
  } else {
    Vector F(u.getMap());
    iterate_.active_set_gradient(u, solver::tpetra(at.getF()), F); // (5.6)
    norm_ = F.norm2();
  }
  return choose(u);
}

ActiveSetStage::Step ActiveSetStage::proposed(NewtonGroup &group, Vector &direction)
{
  if (path_ == Path::on_it && !leaves_path()) return propose_interior(group, direction);
  if (!choice_ && judged(group) != Verdict::go_on)
    return Step::none; // a user's status tests do not ask for the verdict
  if (newton_is_next_) return leave_to_newton(group);
  if (path_ == Path::on_it) return propose_interior(group, direction);
  auto u = rcp(new Vector(solver::tpetra(group.getX()), Teuchos::Copy));
  const auto move_to = [&] {
    group.setX(solver::NoxVector(u));
    group.computeF();
  };
  Vector F(u->getMap());
  while (true) {
    iterate_.take_active_set(*choice_, *u); // (5.7)
    choice_.reset();
    move_to();
    iterate_.active_set_gradient(*u, solver::tpetra(group.getF()), F);
    before_ = norm_ = F.norm2();
    if (norm_ > target_) break;
    const Verdict verdict = choose(*u); // nothing to solve for: the next choice
    if (newton_is_next_) return leave_to_newton(group);
    if (path_ == Path::on_it) return propose_interior(group, direction);
    if (verdict == Verdict::go_on) continue;
    decided_ = true;
    direction.putScalar(0);
    if (verdict != Verdict::converged) return Step::none;
    ++steps_; // of length 0
    return Step::full;
  }
  if (!rough_) { // the remaining correction is small against u: solving for it keeps its relative accuracy       (5.13)
    iterate_.move_origin(*u);
    start_.putScalar(0);
    start_dual_ = iterate_.dual();
    move_to();
  }
  u = Teuchos::null; // a solve needs the memory

  const auto solved = solver::solve_for_direction(group.context(), F, direction, wanted()); // (5.9)
  if (!solved.converged) { // an active set that leaves the body unheld, or an interrupt
    if (!solved.interrupted) {
      u = rcp(new Vector(start_, Teuchos::Copy));
      iterate_.reset_multipliers();
      move_to();
    }
    return Step::none;
  }
  if (make_coarse_) solve_seconds_ = group.context().linear_solver.seconds_of_last_solve();
  direction.scale(-1.);
  ++group.context().steps;
  ++steps_;
  return Step::full;
}

} // namespace rpc::analysis
