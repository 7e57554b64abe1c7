// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "factor/local_correction.hpp"
#include "multigrid/multigrid.hpp"
#include "rpc/algebra/updated_operator.hpp"
#include "rpc/solver/body.hpp"
#include "rpc/solver/linear_solver_options.hpp"
#include "rpc/solver/preconditioner.hpp"

#include <optional>

namespace rpc::solver
{

/// MueLu's hierarchy for a matrix that is softer than H, with exact solves on a patch around the contact nodes that bring in the rest
/// of H and its later changes, doc/theory.md (4.8), (4.9). It is set up again, keeping what `Reuse` allows, where the patch would be
/// too large. Of an update that is
/// not symmetric it takes the symmetric part.
class Algebraic : public Preconditioner
{
public:
  Algebraic(RCP<const UpdatedOperator> H, Body body, const LinearSolverOptions &options);

  Prepared prepare() override;
  void forget() override;
  std::string name() const override { return strengthened_ ? "stronger algebraic" : "algebraic"; }

  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  Start start(const Vector &b) const override; ///< x = Q b
  void apply_to_residual(const MultiVector &r, MultiVector &y) const override;
  RCP<const Map> getDomainMap() const override { return H_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return H_->getRangeMap(); }

  bool renew() override;
  /// A stronger smoother, for nearly incompressible or badly shaped cells, where aggregation misses slow modes and a factor would be too
  /// large. At most once, and not against what the deck asks for.
  /// @return whether it is another preconditioner now, to be made from nothing
  bool strengthen();

private:
  void set_up();
  void write(const DeviceView<double ***> &update);

  RCP<const UpdatedOperator> H_;
  Body body_;
  Teuchos::ParameterList muelu_;
  bool may_strengthen_; // the deck leaves coarse size and smoother to rpc

  RCP<CrsMatrix> A_;               // K with a bounded update; null: none was made yet
  DeviceView<double ***> written_; // (nodes of H, dim, dim) that update
  RCP<Multigrid> multigrid_;       // null: to be made from nothing
  std::optional<LocalCorrection> correction_;
  int revision_ = -1;       // of H when it was last brought to it
  bool is_fresh_ = false;   // no states have changed since the last set-up
  bool is_renewed_ = false; // the last set-up reused the one before
  bool strengthened_ = false;
};

} // namespace rpc::solver
