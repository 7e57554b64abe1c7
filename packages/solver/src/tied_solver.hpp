// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/tied_stiffness.hpp"
#include "rpc/solver/linear_solver.hpp"

#include <functional>
#include <vector>

namespace rpc::solver
{

/// Solves with groups of tied unknowns z beside the others, by a Schur complement: one more solve for each group, with the same operator
/// and preconditioner. All members are collective.                                                  doc/theory.md (4.17)
///
///     x = H^-1 b_F - Y z,    Y = H^-1 C,    (D - C^T Y) z = b_Z - C^T H^-1 b_F
///
/// Y is kept, and brought to a changed H as well as the present solve needs it.
class TiedSolver
{
public:
  /// A solve with the tied unknowns held. @param b  0 at members
  using Held = std::function<LinearSolver::Result(const Vector &b, Vector &x, const Accuracy &wanted)>;

  TiedSolver(RCP<const TiedStiffness> stiffness, RCP<const UpdatedOperator> H);

  LinearSolver::Result solve(const Held &held, const Vector &b, Vector &x, const Accuracy &wanted);
  /// About F . A^-1 F.
  double inverse_energy(const std::function<double(const Vector &)> &held, const Vector &F) const;
  /// (groups, groups) (D - C^T Y)^-1, column after column; empty where it is singular, and before a solve, which finds Y.
  std::vector<double> softness() const;

private:
  std::vector<double> complement() const;
  RCP<Vector> rest(int group) const;
  Vector without_members(const Vector &b) const;
  void balance(const Vector &b, Vector &x) const;

  RCP<const TiedStiffness> stiffness_;
  RCP<const UpdatedOperator> H_;
  std::vector<RCP<Vector>> response_; // Y
  bool solved_ = false;
};

} // namespace rpc::solver
