// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>

namespace rpc::solver
{

/// Krylov method and preconditioner. Where H is not symmetric, GMRES takes the place of methods that ask for symmetry.
struct LinearSolverOptions {
  std::string method = "Pseudoblock CG"; ///< name in Belos' solver factory
  double tolerance = 1e-11;              ///< |r| / |b|, dimensionless, > 0
  int max_iterations = 500;              ///< > 0
  std::string multigrid = "auto";        ///< from where the hierarchy comes: auto, mesh, algebraic
  std::string reuse = "tP";              ///< parts of an algebraic hierarchy kept when the matrix changes: none, tP, RP
  double damping = 4. / 3;               ///< of algebraic prolongators for the whole matrix, unless `muelu` says it
  double expected_iterations =
      0; ///< of CG to 1e-8 with multigrid, where the body lets expect many; 0: not known. No parameter.
  double rough_part =
      1; ///< rough solves (Accuracy::error > 0) leave this part of what they are asked to leave, in (0, 1]. No parameter.
  Teuchos::ParameterList belos; ///< on top of the defaults
  Teuchos::ParameterList muelu; ///< on top of the defaults
};

/// Parameters of the deck's `Linear Solver` sublist; `Belos` and `MueLu` pass through.
Teuchos::ParameterList valid_linear_solver_parameters();
/// @throws rpc::Error (bad_input) on anything out of range
LinearSolverOptions linear_solver_options(const Teuchos::ParameterList &list);

} // namespace rpc::solver
