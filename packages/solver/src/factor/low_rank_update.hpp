// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/solver/sparse_factor.hpp"

#include <map>
#include <vector>

namespace rpc::solver
{

/// scale v v^T, where v has entries at up to three unknowns that follow each other.
struct RankOneTerm {
  long long first_row = 0; ///< of v
  double v[3] = {0, 0, 0}; ///< of length 1; 0 beyond a node's unknowns
  double scale = 0;        ///< of any sign
};

/// value (v_i v_j^T + v_j v_i^T) of two of some terms.
struct Coupling {
  int i = 0, j = 0; ///< places of the terms, i != j
  double value = 0;
};

/// The inverse of a matrix A with a factor, after some terms of rank one, and couplings of them, have been added to it:
///
///     (A + V S V^T)^-1 = A^-1 - A^-1 V C V^T A^-1,    C = (I + S V^T A^-1 V)^-1 S                    doc/theory.md (4.11)
///
/// It is exact, and takes one solve with the factor while A^-1 V is kept, else two. V^T A^-1 V, and A^-1 V as long as it is not too large, are
/// kept for all terms that there ever were, so that a change of states costs a column for each place where there was none before. Slip in
/// space turns with each step: once there are more columns than their places have directions, only those of the present terms are kept.
class LowRankUpdate
{
public:
  /// How many columns set() would solve for.
  int num_new(const std::vector<RankOneTerm> &terms) const;
  /// Collective on the factor's ranks.
  /// @param size  of A   @param has_vectors  this rank does: see SparseFactor::solve   @param terms  all of them, the same on each rank
  /// @param couplings  each pair once at most, the same on each rank
  /// @param most_kept  entries that A^-1 V may have, the same on each rank
  void set(const SparseFactor &factor, int size, bool has_vectors, const std::vector<RankOneTerm> &terms,
           const std::vector<Coupling> &couplings, double most_kept);
  /// x <- (A + V S V^T)^-1 x, like SparseFactor::solve; collective.
  void solve(const SparseFactor &factor, double *x) const;
  /// There are no terms, and A is another one.
  void forget() { *this = {}; }

private:
  int column_of(const RankOneTerm &term) const;
  std::size_t num_unknown(const std::vector<RankOneTerm> &terms) const;
  bool starts_anew(const std::vector<RankOneTerm> &terms) const;
  std::vector<double> times_S(const std::vector<double> &x) const;

  int size_ = 0;
  std::multimap<long long, int> columns_at_;     // by first row
  std::vector<RankOneTerm> column_;              // (columns) without their scale
  std::vector<std::vector<double>> flexibility_; // (columns, columns up to this one) V^T A^-1 V
  std::vector<std::vector<double>> solved_;      // (columns, size) A^-1 V, where this rank has vectors
  bool keeps_ = true;                            // A^-1 V; false: it was too large
  std::vector<int> present_;                     // (terms) their columns
  std::vector<double> scale_;                    // (terms) the diagonal of S
  std::vector<Coupling> coupling_;               // the rest of S
  std::vector<double> matrix_;                   // (terms, terms) LU factors of I + S V^T A^-1 V
  std::vector<int> pivot_;                       // (terms)
};

} // namespace rpc::solver
