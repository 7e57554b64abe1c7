// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

namespace rpc
{

/// A reason for which a step ends without convergence (exit code 4).
struct Cause {
  const char *name;     ///< for tests and the table in doc/robustness.md
  const char *measured; ///< what the program has seen when it gives this reason
  const char *said;     ///< the reason, as a message has it
  const char *remedy;   ///< what helps, as the message goes on
};

/// The table of these reasons: all that the program says of why a step has not converged is one of them. doc/robustness.md has it for
/// users; test/regression/causes.py provokes each and follows its remedy.
namespace causes
{

// Of one minimization.
inline constexpr Cause linear_solver{"linear solver", "a linear solve stopped before its tolerance",
                                     "the linear solver gave no direction that Newton's method can take",
                                     "leave the list \"Linear Solver\" out, or raise its \"Maximum Iterations\""};
inline constexpr Cause breakdown{
    "breakdown",
    "a linear solve, or the set-up of its preconditioner, broke down; or the functional falls without end along "
    "Newton's direction; or rounding leaves a residual of 1 or more",
    "the matrix is singular but for rounding, or the linear solver does not suit it",
    "leave the list \"Linear Solver\" out; without one, bring the stiffnesses of the body and of its springs nearer to "
    "each other: double precision holds ratios of up to about 1e15"};
inline constexpr Cause no_descent{
    "no descent", "the functional's slope along Newton's direction is not negative",
    "the functional does not fall along Newton's direction",
    "leave the list \"Linear Solver\" out, whose solves must be good enough; without one, bring the stiffnesses of the "
    "body and of its springs nearer to each other, or raise \"Uzawa->Tolerance\" above the residuals that are left"};
inline constexpr Cause newton_steps{"Newton steps", "\"NOX->Maximum Iterations\" steps were made",
                                    "that is \"NOX->Maximum Iterations\"", "raise it, or leave the list \"NOX\" out"};
inline constexpr Cause status_tests{"status tests", "tests of the deck's \"NOX->Status Tests\" ended the minimization",
                                    "a test of \"NOX->Status Tests\" ended them", "leave that list out"};
inline constexpr Cause no_lower_step{
    "no lower step",
    "the deck's line search has found no step along Newton's direction that lowers the functional enough",
    "the line search found no step that lowers the functional enough, and took its recovery step",
    "leave \"NOX->Line Search\" out: the default, Exact, always finds one; or lower the smallest step that it tries"};
inline constexpr Cause circles{
    "circles", "without exact line search, Newton's steps lead back to contact states that they had left",
    "the steps go round in circles between contact states",
    "leave \"NOX->Line Search\" out: the functional falls with each step of the default, Exact, which ends that"};
inline constexpr Cause stagnation{
    "stagnation", "two more full steps in the same contact states have not lowered the residual",
    "full steps in the same contact states no longer lower the residual",
    "leave the list \"Linear Solver\" out, whose solves must be good enough, or raise \"Uzawa->Tolerance\" above the "
    "residuals that are left"};

// Of the Uzawa iteration.
inline constexpr Cause uzawa_iterations{"Uzawa iterations",
                                        "\"Uzawa->Maximum Iterations\" updates were made, the last ones with headway",
                                        "there was headway", "raise \"Uzawa->Maximum Iterations\""};
inline constexpr Cause rounding{
    "rounding", "forces are out of balance by at most ten times what the rounding of the displacements makes",
    "more iterations do not help, for what remains is rounding of the displacements",
    "raise \"Uzawa->Tolerance\" above the largest of these residuals: no better balance can be had in double "
    "precision"};
inline constexpr Cause stuck{
    "stuck", "an iteration left more than a tenth of the largest residual, and no penalty could be raised",
    "more iterations do not help", "raise \"Uzawa->Tolerance\" above the largest of these residuals"};
inline constexpr Cause stuck_by_friction{
    "stuck by friction", "six of friction's problems with given bounds left more than 0.8 of the largest residual",
    "more iterations do not help, for friction's states do not settle",
    "take less friction, for so much of it may leave no equilibrium, or several; or other load steps "
    "(\"Steps->Times\")"};
inline constexpr Cause want_of_friction{
    "want of friction", "nothing but friction that follows the pressures holds the body, and no equilibrium was found",
    "without friction that follows the pressures the load moves the body, and no pressures were found that hold it",
    "raise the friction or what presses the body on the foundation, lower the load, or prescribe a displacement"};

inline constexpr std::array all{linear_solver, breakdown,         no_descent,      newton_steps,     status_tests,
                                no_lower_step, circles,           stagnation,      uzawa_iterations, rounding,
                                stuck,         stuck_by_friction, want_of_friction};

} // namespace causes

/// "said (figures); remedy": the end of a message.
std::string because(const Cause &cause, const std::string &figures = "");

} // namespace rpc
