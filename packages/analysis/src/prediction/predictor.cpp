// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/analysis/predictor.hpp"

#include "body/obstacle_force.hpp"
#include "rpc/analysis/load_history.hpp"
#include "rpc/analysis/rules.hpp"
#include "rpc/core/error.hpp"
#include "rpc/fem/interpolation.hpp"
#include "rpc/solver/linear_solver.hpp"
#include "rpc/solver/rules.hpp"

#include <Teuchos_Time.hpp>
#include <algorithm>
#include <numeric>
#include <utility>

namespace rpc::analysis
{
namespace
{

/// Why no coarser mesh is to predict a step on this one; empty if one is. With friction a solution takes more steps than without, and so does a
/// search for an obstacle that a force moves; a prediction saves most of them on the smallest mesh, too.
std::string no_prediction(const Problem &fine, const contact::ContactNodes &contact, const bool enabled)
{
  if (contact.num_total == contact.num_fixed) return "no node can touch";
  if (!enabled) return "switched off";
  const bool takes_more = contact.friction.anywhere || pressed_by_force(fine.model()) != nullptr;
  if (!takes_more && fine.discretization().owned_dofs->getGlobalNumElements() <=
                         static_cast<Tpetra::global_size_t>(solver::linear_rules.few_rows))
    return "the mesh is small";
  if (solver::is_bound_by_launches(*fine.stiffness())) return "a GPU takes no less time for a coarser mesh";
  return "";
}

StepOptions rough(StepOptions options)
{
  options.newton.residual_tolerance = options.uzawa.tolerance = options.prediction.tolerance;
  options.newton.max_iterations = std::min<int>(options.newton.max_iterations, solver::newton_rules.most_inner_steps);
  options.looks_between_nodes = false;
  return options;
}

/// now - then.
template <class Values>
RCP<Values> difference(const Values &now, const Values &then)
{
  const auto result = rcp(new Values(now, Teuchos::Copy));
  result->update(-1., then, 1.);
  return result;
}

} // namespace

/// The scene on a coarser mesh, with the interpolations between the meshes.
struct Predictor::Coarser {
  LoadHistory history;
  RCP<const Operator> to_fine;
  RCP<const Operator> to_coarse; // null until it is asked for
};

Predictor::Predictor(CoarserProblem coarser, StepOptions options, solver::LinearSolverOptions linear, const int level)
    : coarser_problem_(std::move(coarser)), rough_(rough(std::move(options))), linear_(std::move(linear)), level_(level)
{
}
Predictor::Predictor(Predictor &&) noexcept = default;
Predictor::~Predictor() = default;

void Predictor::forget()
{
  coarser_.reset();
}

std::shared_ptr<const Problem> Predictor::made_coarser() const
{
  return coarser_ ? coarser_->history.shared_problem() : nullptr;
}

Prediction Predictor::predict(const Problem &fine, const Step &step, const Memory *const last)
{
  Prediction prediction;
  prediction.reason = no_prediction(fine, step.contact, rough_.prediction.enabled);
  if (!prediction.reason.empty()) return prediction;
  try {
    if (!coarser_) {
      const auto problem = coarser_problem_ ? coarser_problem_(fine, level_) : nullptr;
      if (!problem) {
        coarser_problem_ = {}; // nor will there be one
        prediction.reason = "there is no coarser mesh of this body";
        return prediction;
      }
      coarser_ = std::make_unique<Coarser>(
          Coarser{LoadHistory(problem, rough_, 0, linear_, Predictor(coarser_problem_, rough_, linear_, level_ + 1)),
                  interpolation(problem->mesh(), fine.mesh()), Teuchos::null});
    }
    return last ? from_last(fine, step, *last) : from_rest(fine, step);
  } catch (const Error &failure) { // an interrupt too: the finest mesh is where a run stops with what it has found
    forget();
    prediction.reason = one_line(failure.what());
    return prediction;
  }
}

/// The coarser scene, or the next one if it has been made, that is small enough to choose states by; else null.
std::shared_ptr<const Problem> Predictor::scene_of_choices() const
{
  const LoadHistory &history = coarser_->history;
  for (const auto &scene : {history.shared_problem(), history.made_coarser()})
    if (scene && CoarseChoice::is_small(*scene)) return scene;
  return nullptr;
}

namespace
{

/// What a coarser mesh's solution tells of the way on this one, and choices of its states by a coarser scene.
/// @param scene  of choices, may be null
PredictedBy told_by(const StepSolution &solution, const std::shared_ptr<const Problem> &scene, const int level,
                    const Problem &fine)
{
  PredictedBy by;
  if (level == 1 && solution.step.contact.num_total >= step_rules.fewest_points_telling)
    by.found_by = solution.found_by;
  if (scene && scene->stiffness_of_tied().is_null()) // its model knows no tied unknowns
    by.coarse_choice = [scene, time = solution.step.time, &fine](const contact::Iterate &iterate,
                                                                 const double solve_seconds) {
      return CoarseChoice::make(*scene, scene->dirichlet(time), fine.discretization(), iterate, solve_seconds);
    };
  return by;
}

/// What a solution on a coarser mesh took, after what still coarser ones did.
std::vector<LevelWork> work_of(const StepSolution &s, const double start)
{
  std::vector<LevelWork> work = s.levels;
  work.push_back({s.u->getGlobalLength(),
                  std::accumulate(s.uzawa.newton_iterations.begin(), s.uzawa.newton_iterations.end(), 0),
                  s.linear.iterations, s.linear.preconditioner_setups, Teuchos::Time::wallTime() - start});
  return work;
}

} // namespace

/// The first step: one minimization there is enough, converged or not.                                    (5.11)
Prediction Predictor::from_rest(const Problem &fine, const Step &step)
{
  const double start = Teuchos::Time::wallTime();
  LoadHistory &history = coarser_->history;
  StepOptions once = rough_;
  if (pressed_by_force(fine.model()) == nullptr) once.uzawa.max_iterations = 1; // else it is to find the obstacle
  const StepSolution coarse = history.solve(step.time, once, {}, {});
  const Problem &problem = history.problem();
  const auto state =
      contact::with_weightless(coarse.state, coarse.step.contact, problem.discretization(), problem.contact_sides());
  return {contact::interpolated(*coarser_->to_fine, coarse.step.contact, state, step.contact,
                                fine.discretization().owned_dofs),
          "",
          told_by(coarse, scene_of_choices(), level_, fine),
          work_of(coarse, start),
          0,
          coarse.step.obstacle};
}

/// A later step: what it changes.                                                                                (11.5)
Prediction Predictor::from_last(const Problem &fine, const Step &step, const Memory &last)
{
  const double start = Teuchos::Time::wallTime();
  auto &[history, to_fine, to_coarse] = *coarser_;
  const fem::Discretization &d = fine.discretization(), &coarse_d = history.problem().discretization();
  Prediction none;
  none.reason = "the step does not converge on the coarser mesh";
  if (!history.memory() || history.memory()->time != last.time) { // brings it to where the fine one is
    if (to_coarse.is_null()) to_coarse = fem::interpolation(d, coarse_d);
    history.go_on_from(interpolated(last, *to_coarse, coarse_d));
    if (!history.solve(last.time, rough_, {}, {}).uzawa.converged) return none;
  }
  const Memory before = *history.memory();
  const StepSolution coarse = history.solve(step.time, rough_, {}, {});
  if (!coarse.uzawa.converged) return none;
  const Memory &now = *history.memory();
  Memory predicted = last;
  const auto u =
      fem::interpolated(*to_fine, *difference(*now.displacement, *before.displacement), d.dim(), d.owned_dofs);
  u->update(1., *last.displacement, 1.);
  predicted.displacement = u;
  const auto changed = [&, &to_fine = to_fine](const MultiVector &there_now, const MultiVector &there_before,
                                               const MultiVector &here) {
    const auto result = rcp(new MultiVector(here, Teuchos::Copy));
    to_fine->apply(*difference(there_now, there_before), *result, Teuchos::NO_TRANS, 1., 1.);
    return result;
  };
  predicted.pressure = changed(*now.pressure, *before.pressure, *last.pressure);
  const bool has_friction = // a coarser mesh may have none at its points
      !last.tangential.is_null() && !before.tangential.is_null() && !now.tangential.is_null();
  if (has_friction) predicted.tangential = changed(*now.tangential, *before.tangential, *last.tangential);
  Point obstacle = last.obstacle;
  for (int c = 0; c < 3; ++c) obstacle[c] += now.obstacle[c] - before.obstacle[c];
  return {state_of(step.contact, predicted),
          "",
          told_by(coarse, scene_of_choices(), level_, fine),
          work_of(coarse, start),
          0,
          obstacle};
}

} // namespace rpc::analysis
