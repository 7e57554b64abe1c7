// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/updated_operator.hpp"
#include "rpc/solver/mesh_multigrid.hpp"
#include "rpc/solver/preconditioner.hpp"

#include <memory>

namespace rpc::solver
{

/// The Cholesky factor of H itself, for few unknowns: made anew for each choice of contact states, on every rank. Of an update that is
/// not symmetric it takes the symmetric part.
class Factor : public Preconditioner
{
public:
  explicit Factor(RCP<const UpdatedOperator> H) : H_(std::move(H)) {}

  /// Refused where H is not positive definite, or the factor would take too many multiplications.
  Prepared prepare(double tolerance) override;
  void forget() override;
  std::string name() const override { return "factor"; }
  std::string description() const override { return "factor for each choice of states: few unknowns"; }

  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  RCP<const Map> getDomainMap() const override { return H_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return H_->getRangeMap(); }

private:
  RCP<const UpdatedOperator> H_;
  RCP<CrsMatrix> A_;                       // H; null: none was made yet
  std::unique_ptr<CoarsestSolver> factor_; // null: none was made, or it was refused
  int revision_ = -1;                      // of H when it was made or refused
};

} // namespace rpc::solver
