// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "krylov/krylov.hpp"
#include "preconditioner/meshes.hpp"
#include "rpc/solver/mixed_form.hpp"

#include <memory>

namespace rpc::solver
{

/// Solves for a nearly incompressible H = K_0 + Z^T diag(s) Z + contact with the pressures as unknowns of their own, whose equations do
/// not grow stiff with s:                                                                        doc/theory.md (4.14)
///
///     [ H_0   Z^T     ] [u]   [b]
///     [ Z    -diag(s)^-1 ] [p] = [0],     H_0 = K_0 + contact.
///
/// BiCGStab solves them, preconditioned by multigrid on meshes for H_0. Where a solve does not end well, another preconditioner of H has to
/// take over.
class Mixed : public Preconditioner
{
public:
  /// @param make  not null
  Mixed(RCP<const UpdatedOperator> H, MakeMixedForm make, LinearSolverOptions options);
  ~Mixed() override;

  Prepared prepare() override;
  void forget() override;
  std::string name() const override { return "mixed"; }
  std::string description() const override;

  /// x <- approximately H^-1 b, after prepare(); collective.
  /// @param b  not 0, but 0 at prescribed unknowns: K and K_0 differ there   @param wanted  its residual counts, that of H x = b
  /// @param gives_up  null: never   @throws Interrupted on all ranks
  KrylovResult solve(const Vector &b, Vector &x, const Accuracy &wanted, const GivesUp &gives_up) const;

  void learn(int iterations, double seconds_of_iteration) override;

  /// y <- (V - V Z^T diag(1/s + 1/bulk modulus)^-1 Z V) x, V the multigrid for H_0: positive definite as long as V <= H_0^-1.  (4.16)
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  RCP<const Map> getDomainMap() const override { return H_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return H_->getRangeMap(); }

private:
  struct System;

  RCP<const UpdatedOperator> H_;
  MakeMixedForm make_;
  LinearSolverOptions options_;
  std::unique_ptr<System> system_; // null: to be made
};

} // namespace rpc::solver
