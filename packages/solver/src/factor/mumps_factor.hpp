// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/solver/sparse_factor.hpp"

namespace rpc::solver
{

/// By MUMPS, in METIS' order of nested dissection of the nodes.
class MumpsFactor : public SparseFactor
{
public:
  /// See SparseFactor::analyse.
  MumpsFactor(RCP<const Comm> comm, int size, const SymmetricEntries &entries, int dofs_per_node);
  ~MumpsFactor() override;

  FactorCost cost() const override;
  bool make(const std::vector<double> &value) override;
  bool exists() const override;
  void solve(double *x) const override;
  void solve(const SparseColumns &B, double *x) const override;

private:
  struct Impl;
  RCP<const Comm> comm_;
  std::shared_ptr<Impl> impl_; // also of the thread that makes the factor
};

} // namespace rpc::solver
