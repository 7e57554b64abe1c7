// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "factor/low_rank_update.hpp"
#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc::solver
{

/// What has changed in a symmetric matrix of the stiffness between nodes.
struct MatrixChanges {
  /// A term of the change of a node's own block, where nothing else of the node has changed.
  struct AtNode {
    RankOneTerm term;
    double part = 0; ///< the largest entry of the change over the largest one of the block before it
  };
  /// Entry of the lower triangle, of a node that has changed with others.
  struct Between {
    long long row = 0, column = 0; ///< gids, row >= column
    double value = 0;              ///< of the change
  };
  std::vector<AtNode> at_nodes;
  std::vector<Between> between;
};

/// Those of all ranks, but for rounding; collective.
/// @param before  (entries of this rank) what A's were   @param dofs_per_node  1 to 3; the gids of a node follow each other, as its rows do
MatrixChanges changes_since(const HostView<const double *> &before, const CrsMatrix &A, int dofs_per_node);

/// A change as terms of low rank.
struct LowRankTerms {
  std::vector<RankOneTerm> terms;
  std::vector<Coupling> couplings;
};

/// All of a change, but for nodes' own blocks of which no more than some part has changed.
LowRankTerms low_rank_terms(const MatrixChanges &changes, double least_part, int dofs_per_node);

} // namespace rpc::solver
