// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/analysis/memory.hpp"
#include "rpc/analysis/solve_step.hpp"

#include <functional>
#include <memory>

namespace rpc::analysis
{

/// The same scene on the next coarser mesh; null where there is none.
/// @param finer  the scene on the mesh before   @param level  1 for the mesh after the finest, 2 for the one after it, ...
using CoarserProblem = std::function<std::shared_ptr<const Problem>(const Problem &finer, int level)>;

/// Starts for the steps of a problem, the first one and later ones, from the same steps on a coarser mesh, which a still coarser one
/// predicts:
///
///     u = u_(n-1) + P (U_n - U_(n-1)),    lambda = lambda_(n-1) + P (Lambda_n - Lambda_(n-1))     doc/theory.md (5.11), (11.5)
///
/// with P the interpolation from the coarser mesh; before the first step all is 0. Nothing is lost where that fails. The coarser scenes
/// are kept for the next step.
class Predictor
{
public:
  /// @param linear  of the solves on the coarser meshes   @param level  of the next coarser mesh, see CoarserProblem
  Predictor(CoarserProblem coarser, StepOptions options, solver::LinearSolverOptions linear, int level = 1);
  Predictor(Predictor &&) noexcept;
  ~Predictor();

  /// Collective. @param last  what the step before has left; null: there was none
  Prediction predict(const Problem &fine, const Step &step, const Memory *last);
  /// The scene on the coarser mesh, if there is one by now, or null.
  std::shared_ptr<const Problem> made_coarser() const;
  /// Coarser scenes go; they are made anew where they are asked for.
  void forget();

private:
  struct Coarser;
  std::shared_ptr<const Problem> scene_of_choices() const;
  Prediction from_rest(const Problem &fine, const Step &step);
  Prediction from_last(const Problem &fine, const Step &step, const Memory &last);

  CoarserProblem coarser_problem_;
  StepOptions rough_;
  solver::LinearSolverOptions linear_;
  int level_;
  std::unique_ptr<Coarser> coarser_; // null until it is asked for
};

} // namespace rpc::analysis
