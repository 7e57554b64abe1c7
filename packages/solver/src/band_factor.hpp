#pragma once

#include "sparse_factor.hpp"

namespace rpc::solver
{

/// By LAPACK's band factorization in the reverse Cuthill-McKee order, of entries that are all this rank's.
class BandFactor : public SparseFactor
{
public:
  BandFactor(int size, const SymmetricEntries &entries);

  FactorCost cost() const override;
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
