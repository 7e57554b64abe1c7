#pragma once

#include "low_rank_update.hpp"
#include "rpc/solver/mesh_multigrid.hpp"
#include "sparse_factor.hpp"

#include <memory>
#include <string>
#include <vector>

namespace rpc::solver
{

/// A^-1 by a sparse factor. A few unknowns are factored on each rank alike, more by all ranks together. Rows have gids from 0, without gaps.
class DirectSolver : public CoarsestSolver
{
public:
  /// Analyses the matrix; there is no factor yet. Collective.
  /// @param dofs_per_node  unknowns of a node, whose gids follow each other
  DirectSolver(RCP<const CrsMatrix> A, int dofs_per_node);

  FactorCost cost() const { return factor_->cost(); }
  /// Empty if the memory that is free now will do for the factor; else why not. The same on all ranks; collective.
  std::string lacks_memory() const;

  /// Factors the matrix as it is now; collective. @return whether it is positive definite
  bool make();
  void update() override;
  double seconds_of_update() const override;
  void apply(const Vector &b, Vector &x) const override;

  /// What was added to the matrix since make(), in place of what was said before: no new factor is made for it. Collective.
  /// @param terms  of this rank
  void add(const std::vector<RankOneTerm> &terms);
  /// How many terms, of all ranks, add() would have to solve for; collective.
  int num_new(const std::vector<RankOneTerm> &terms) const;

private:
  RCP<const CrsMatrix> A_;
  std::unique_ptr<SparseFactor> factor_;
  LowRankUpdate update_;      // of the factor
  RCP<const Import> to_root_; // null: each rank has a factor of its own
  bool on_one_rank_ = false;  // all rows are, which then solves alone
};

} // namespace rpc::solver
