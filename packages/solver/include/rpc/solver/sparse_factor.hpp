// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <memory>
#include <vector>

namespace rpc::solver
{

/// Some entries of a symmetric matrix, in any order; equal places add up. Each pair of places is given once or twice, as
/// (i, j) and (j, i): entries above the diagonal do not count.
struct SymmetricEntries {
  std::vector<int> row, column;
  std::vector<double> value;
};

/// The entries of all ranks on every rank; collective.
SymmetricEntries entries_of_all(const Comm &comm, const SymmetricEntries &mine);

/// Columns of few entries.
struct SparseColumns {
  std::vector<int> begin{0}; ///< (columns + 1) where the entries of each begin
  std::vector<int> row;      ///< (entries) each once in a column
  std::vector<double> value; ///< (entries)

  int count() const { return static_cast<int>(begin.size()) - 1; }
};

/// What a factor takes, as its symbolic factorization tells before it is made.
struct FactorCost {
  double operations = 0; ///< multiplications and additions
  double entries = 0;    ///< of the factor
  double bytes = 0;      ///< most that a rank needs while it is made [B]
  /// About, by constants of one machine: a choice by them is the same in every run.
  double seconds = 0, seconds_of_solve = 0; ///< [s]
  double seconds_of_column = 0;             ///< of many of few entries that are solved for together [s]
  double gain_of_ranks = 1;                 ///< how many times as fast this is as on one rank
};

/// Cholesky factor of a sparse symmetric positive definite matrix on the host.
///
/// MUMPS makes it, in METIS' order of nested dissection, on all ranks of a communicator together. On one rank matrices of few unknowns in a
/// narrow band, and those whose own order is one, go to LAPACK's band factorization, and so do all matrices where there is no MUMPS.
class SparseFactor
{
public:
  virtual ~SparseFactor() = default;

  /// Whether ranks can make a factor together: not without MUMPS.
  static const bool can_be_shared;

  /// Orders the unknowns and counts what the factor takes; collective.
  /// @param comm     of several ranks only where can_be_shared is true
  /// @param size     of the matrix
  /// @param entries  of this rank; their values are not read, and all ranks' entries add up
  /// @param dofs_per_node  n: the unknowns n k to n k + n - 1 have the same neighbours, so that nodes can be ordered for them; 1 where
  ///                 nothing is known
  static std::unique_ptr<SparseFactor> analyse(const RCP<const Comm> &comm, int size, const SymmetricEntries &entries,
                                               int dofs_per_node);

  virtual FactorCost cost() const = 0;

  /// Makes the factor; collective.
  /// @param value  (entries) of this rank, in the order of analyse()
  /// @return whether the matrix is positive definite; if not, there is no factor
  /// @throws std::bad_alloc on all ranks where memory runs out
  /// @throws Interrupted on all ranks where the run has been asked to stop meanwhile; then it must not be used again
  virtual bool make(const std::vector<double> &value) = 0;
  virtual bool exists() const = 0;

  /// x <- A^-1 x; collective.
  /// @param x  (size) on rank 0, where it is read and written; on other ranks it may be null
  virtual void solve(double *x) const = 0;
  /// X <- A^-1 B; collective. Many columns together take a part of the time of as many solves, the less the fewer entries they have.
  /// @param B  as many columns on each rank; of other ranks than 0 the entries do not count
  /// @param x  (columns, size) on rank 0, one column after the other, where it is written; on other ranks it may be null
  virtual void solve(const SparseColumns &B, double *x) const = 0;
};

/// A factor on this rank alone, of entries that are all its own; null where it would take more than so many operations, or the matrix
/// is not positive definite.
std::unique_ptr<SparseFactor> factor_of(int size, const SymmetricEntries &entries, double most_work);

} // namespace rpc::solver
