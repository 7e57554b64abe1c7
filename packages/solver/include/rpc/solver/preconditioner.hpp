// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <string>

namespace rpc::solver
{

/// An approximation B of H^-1 for a Krylov method, with H = K + contact. B is linear. It stays as it is until prepare() brings it to
/// the present H. Symmetric and positive definite where H is. All members are collective.
class Preconditioner : public Operator
{
public:
  /// What prepare() did.
  enum class Prepared {
    unchanged, ///< nothing: B is that of the present H
    updated,   ///< B followed H by work near the contact nodes
    made       ///< B was set up, from nothing or from parts of the last one
  };
  /// Brings B to the present H, by its revision.
  /// @throws std::exception on all ranks where the set-up fails, such as of a singular matrix; then B must not be applied
  virtual Prepared prepare() = 0;
  /// Drops what is set up: the next prepare() starts from nothing.
  virtual void forget() = 0;
  /// Called after a solve with its iterations: B may decide to be set up anew for H.
  virtual void learn(int /*iterations*/, double /*seconds_of_iteration*/) {}
  /// Where B has followed changes of H, or reuses parts of an earlier B, these may be to blame for a solve that went badly: the next
  /// prepare() does without. @return whether that makes another B
  virtual bool renew() { return false; }
  /// For the summary, such as "algebraic".
  virtual std::string name() const = 0;
  /// The same with what was chosen and why, such as "meshes, 6 levels, thin in z: factored at 48 x 48 x 1 cells".
  std::string description() const override { return name(); }

  /// Where a Krylov method starts for a symmetric H: an x with its rest = b - H x. Null, null: from 0, with b.
  struct Start {
    RCP<Vector> x, rest;
  };
  /// Whether B = H^-1 but for rounding.
  virtual bool is_exact() const { return false; }
  /// The exact solution on a part of the unknowns, where the preconditioner has one.
  virtual Start start(const Vector &) const { return {}; }
  /// y <- B r for the residuals r that follow from this start only, where that takes less work.
  virtual void apply_to_residual(const MultiVector &r, MultiVector &y) const { apply(r, y); }
};

/// About F . H^-1 F, F . B F.
inline double inverse_energy(const Preconditioner &B, const Vector &F)
{
  Vector x(F.getMap());
  B.apply(F, x);
  return F.dot(x);
}

} // namespace rpc::solver
