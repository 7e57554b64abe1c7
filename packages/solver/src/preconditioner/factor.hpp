// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "factor/direct_solver.hpp"
#include "rpc/algebra/updated_operator.hpp"
#include "rpc/solver/preconditioner.hpp"

#include <memory>
#include <string>

namespace rpc::solver
{

/// The Cholesky factor of H itself. Of an update that is not symmetric it takes the symmetric part.
///
/// A sparse factor, for matrices on which multigrid converges slowly. Low-rank updates (4.11), which are exact, follow changes of states; where
/// they would take longer, the factor is made anew.
class Factor : public Preconditioner
{
public:
  explicit Factor(RCP<const UpdatedOperator> H) : H_(std::move(H)) {}

  /// What a factor takes, and why it cannot be had, if so.
  struct Prospect {
    FactorCost cost;
    std::string obstacle; ///< empty: it can be had
  };
  /// Orders the unknowns and counts, once; collective.
  const Prospect &prospect();
  /// It becomes the factor of a narrow band, in the order of the gids, on each rank; before the first prospect().
  void take_band() { is_band_ = true; }

  /// @throws std::runtime_error where H is not positive definite, or there is an obstacle
  Prepared prepare() override;
  void forget() override;
  bool renew() override;
  bool is_exact() const override { return has_all_ && last_update_ != CoarsestSolver::Update::rough; }
  std::string name() const override;
  std::string description() const override;
  /// Whether a new factor takes less time than so many iterations: never where the present one is that of H but for rounding.   (4.12)
  bool renewal_pays(double iterations) const
  {
    return last_update_ == CoarsestSolver::Update::rough &&
           prospect_.cost.seconds < iterations * prospect_.cost.seconds_of_solve;
  }

  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  RCP<const Map> getDomainMap() const override { return H_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return H_->getRangeMap(); }

private:
  RCP<const UpdatedOperator> H_;
  bool is_band_ = false;
  RCP<CrsMatrix> A_;                     // K with an update; null: it was not analysed
  std::unique_ptr<DirectSolver> solver_; // of A
  Prospect prospect_;
  int revision_ = -1;    // of H when it was last brought to it
  bool has_all_ = false; // of contact's stiffness
  CoarsestSolver::Update last_update_ = CoarsestSolver::Update::made;
};

} // namespace rpc::solver
