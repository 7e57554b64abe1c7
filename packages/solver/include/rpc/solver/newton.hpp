#pragma once

#include "rpc/contact/uzawa.hpp"
#include "rpc/solver/linear_solver.hpp"

#include <Teuchos_ParameterList.hpp>
#include <functional>

namespace rpc::solver
{

/// The generalized Newton iteration as NOX runs it.
struct NewtonOptions {
  double step_tolerance = 1e-10;     ///< |d|_2 / |u|_2 of a full Newton step, > 0: the paper's test
  double residual_tolerance = 1e-11; ///< |F|_2 / |load|_2, > 0
  double start_tolerance = 1e-10;    ///< |F|_2 / |load|_2 at which the search for states is content, > 0
  double pressure_tolerance = 1e-7;  ///< error of pressures, over the largest, at which that search is content, > 0
  int max_iterations = 200;          ///< > 0
  bool active_set_start = true;      ///< look for the contact states first, see find_states()
  Teuchos::ParameterList nox;        ///< sublists for NOX, on top of the defaults
};

/// Parameters of the deck's `NOX` sublist. Its sublists pass through; "Line Search" -> "Method" also knows "Exact", the
/// default.
Teuchos::ParameterList valid_newton_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
NewtonOptions newton_options(const Teuchos::ParameterList &list);

/// One Newton step, for the console.
struct NewtonStep {
  int iteration = 0;   ///< 0 is the start
  double residual = 0; ///< |F|_2 / |load|_2
  double step_length = 0;
  int linear_iterations = 0;
  contact::StateCounts states;
};

/// Lets NOX read its part of the deck, which a scene may not come to; collective.
/// @throws rpc::Error (bad_input) if NOX refuses it
void check_nox_parameters(contact::SmoothedFunctional &functional, LinearSolver &linear_solver, const RCP<Vector> &u,
                          const NewtonOptions &options);

/// Minimizes the smoothed functional over u, in place; collective. Failure is a result, not an exception.
/// @param same_states  start with a step on the piece that the last minimization ended on, doc/theory.md (5.4): after a
///                     multiplier update its states are a better guess than those of lambda + r v at the old v
/// @param report       called after each step
contact::MinimizeResult minimize(contact::SmoothedFunctional &functional, LinearSolver &linear_solver,
                                 const RCP<Vector> &u, const NewtonOptions &options, bool same_states,
                                 const std::function<void(const NewtonStep &)> &report);

} // namespace rpc::solver
