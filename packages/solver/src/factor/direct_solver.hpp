// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "factor/low_rank_update.hpp"
#include "rpc/core/tpetra.hpp"
#include "rpc/solver/mesh_multigrid.hpp"
#include "rpc/solver/sparse_factor.hpp"

#include <memory>
#include <optional>
#include <string>

namespace rpc::solver
{

/// A^-1 by a sparse factor, and by an update of it where few entries of A have changed. A few unknowns are factored on each rank alike, more
/// by all ranks together. Rows have gids from 0, without gaps.
class DirectSolver : public CoarsestSolver
{
public:
  /// Analyses the matrix; there is no factor yet. Collective.
  /// @param dofs_per_node  unknowns of a node, whose gids follow each other
  /// @param is_band  whether gids that A couples are close to each other: then each rank has a band factor in their order
  DirectSolver(RCP<const CrsMatrix> A, int dofs_per_node, bool is_band = false);

  FactorCost cost() const { return factor_->cost(); }
  /// Empty if the memory that is free now will do for the factor; else why not. The same on all ranks; collective.
  std::string lacks_memory() const;

  /// Factors the matrix as it is now; collective. @return whether it is positive definite
  bool make();
  /// By terms of low rank, (4.11), where these take less time than a new factor.
  Update update(double slight) override;
  double seconds_of_update() const override;
  /// The next update makes a new factor.
  void forget() { may_follow_ = false; }
  void apply(const Vector &b, Vector &x) const override;

private:
  std::optional<Update> follow(double slight);

  RCP<const CrsMatrix> A_;
  int dofs_per_node_;
  std::unique_ptr<SparseFactor> factor_;
  HostView<double *> factored_;    // (entries of this rank) A's when the factor was made
  std::vector<std::size_t> lower_; // (of these on and below the diagonal) which each is
  bool may_follow_ = false;        // by an update of the factor
  LowRankUpdate update_;           // of the factor
  RCP<const Import> to_root_;      // null: each rank has a factor of its own
  bool on_one_rank_ = false;       // all rows are, which then solves alone
};

} // namespace rpc::solver
