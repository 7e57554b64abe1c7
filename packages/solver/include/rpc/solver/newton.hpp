// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/solver/minimization_steps.hpp"

#include <Teuchos_ParameterList.hpp>
#include <functional>

namespace rpc::solver
{

/// The generalized Newton iteration as NOX runs it.
struct NewtonOptions {
  double step_tolerance = 1e-10;     ///< |d|_2 / |u|_2 of a full Newton step, > 0: the paper's test
  double residual_tolerance = 1e-11; ///< |F|_2 / |load|_2, > 0
  int max_iterations = 200;          ///< > 0
  Teuchos::ParameterList nox;        ///< sublists for NOX, on top of the defaults
};

/// Parameters of the deck's `NOX` sublist. Its sublists pass through; "Line Search" -> "Method" also knows "Exact" and
/// "Direction" -> "Method" also knows "Active Set" and "Sweep"; the first of each is the default.
Teuchos::ParameterList valid_newton_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
NewtonOptions newton_options(const Teuchos::ParameterList &list);

/// One step of the iteration, for the console.
struct NewtonStep {
  int iteration = 0;   ///< 0 is the start
  double residual = 0; ///< |F|_2 / |load|_2
  double step_length = 0;
  int linear_iterations = 0;
};
using NewtonReport = std::function<void(const NewtonStep &, const Vector &u)>;

/// What came out of one minimization.
struct MinimizeResult {
  bool converged = false;
  int steps = 0;        ///< each one linear solve
  int newton_steps = 0; ///< of these, those of Newton's method
  std::string reason;   ///< why not, if not
};

/// Lets NOX read its part of the deck, which a scene may not come to; collective.
/// @throws rpc::Error (bad_input) if NOX refuses it
void check_nox_parameters(ConvexFunctional &functional, LinearSolver &linear_solver, const RCP<Vector> &u,
                          const NewtonOptions &options);

/// Whether the deck's "Direction" -> "Method" lets a loop take other steps than Newton's.
bool takes_loop(const NewtonOptions &options);

/// Minimizes a functional over u, in place; collective. Failure is a result, not an exception.
/// @param scale   of forces, to which residuals are relative
/// @param loop    chooses the steps, where "Direction" -> "Method" is "Active Set"; empty: all are Newton's
/// @param report  called at the start and after each step
MinimizeResult minimize(ConvexFunctional &functional, LinearSolver &linear_solver, const RCP<Vector> &u, double scale,
                        const NewtonOptions &options, const MinimizationLoop &loop, const NewtonReport &report);

} // namespace rpc::solver
