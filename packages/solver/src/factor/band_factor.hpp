// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/solver/sparse_factor.hpp"

namespace rpc::solver
{

/// By LAPACK's band factorization, of entries that are all this rank's.
class BandFactor : public SparseFactor
{
public:
  /// @param place  (size) of each row in the band
  BandFactor(int size, const SymmetricEntries &entries, std::vector<int> place);
  static std::unique_ptr<BandFactor> in_cuthill_mckee_order(int size, const SymmetricEntries &entries); ///< reversed
  static std::unique_ptr<BandFactor> as_numbered(int size, const SymmetricEntries &entries);

  /// What a factor takes of `size` rows with `width` entries below the diagonal.
  static FactorCost cost_of(double size, double width);
  FactorCost cost() const override { return cost_of(size_, width_); }
  bool make(const std::vector<double> &value) override;
  bool exists() const override { return exists_; }
  void solve(double *x) const override { solve_in_place(x, 1); }
  void solve(const SparseColumns &B, double *x) const override;

private:
  void solve_in_place(double *x, int columns) const; // (columns, size)

  int size_, width_ = 0; // of the matrix; of the band below the diagonal
  bool exists_ = false;
  std::vector<std::size_t> entry_; // (entries) place of each in the factor, `above` for those that do not count
  std::vector<int> place_;         // (size) of each row in the factor
  std::vector<double> factor_;     // (width + 1, size) columns of the lower half
};

} // namespace rpc::solver
