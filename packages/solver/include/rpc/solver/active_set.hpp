#pragma once

#include "rpc/solver/newton.hpp"

namespace rpc::solver
{

/// What came of a search for contact states.
struct ActiveSetResult {
  int steps = 0;          ///< each one linear solve
  bool confirmed = false; ///< the states are those of the solution, and the residual is below the tolerance
};

/// Finds contact states to start the generalized Newton iteration from, and the displacement and multipliers that belong
/// to them, by a primal-dual active-set iteration with rough solves while states change; collective. doc/theory.md (5.6),
/// (5.7), (5.13)
///
/// Ends when a choice of states confirms the last one, which is then the solution up to what the penalty leaves to a
/// multiplier update; or, unconfirmed, after some steps or when states come back: nothing is lost then, for Newton with
/// its line search goes on from wherever this ends.
/// @param report  called after each step
ActiveSetResult find_states(contact::SmoothedFunctional &functional, LinearSolver &linear_solver, Vector &u,
                            const NewtonOptions &options, const std::function<void(const NewtonStep &)> &report);

} // namespace rpc::solver
