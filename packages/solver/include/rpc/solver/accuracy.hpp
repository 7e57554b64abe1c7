// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <functional>

namespace rpc::solver
{

/// What a linear solve for x = H^-1 b is to leave: one of the two is enough. The residual says little of the error where a body bends: its
/// norm is that of the stiff modes, and displacements are those of the soft ones.
struct Accuracy {
  /// Implicit, for a number is the accuracy of a residual.
  /// @param residual_part  > 0   @param error_part  >= 0   @param energy_before  >= 0 [J]
  Accuracy(const double residual_part, const double error_part = 0, const double energy_before = 0)
      : residual(residual_part), error(error_part), energy(energy_before)
  {
  }

  /// |b - H x| / |b|
  double residual;
  /// |H^-1 b - x|_H over (|x|_H^2 + energy)^(1/2), as CG estimates it; 0: that does not count.
  double error;
  /// |y|_H^2 of a solution y that was found just before, with the same H, and that x corrects; 0: there is none [J].
  double energy;

  /// Asked once, where x is as good as that: whether the same iteration goes on, in its Krylov space, until |b - H x| / |b| is `further`. Not
  /// every method asks, and the result does not tell whether `further` was reached. Collective; null: it ends there.
  std::function<bool(const Vector &x)> goes_on = {};
  double further = 0; ///< < residual
};

} // namespace rpc::solver
