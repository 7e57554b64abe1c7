// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/repeated_rows.hpp"
#include "rpc/algebra/rounded_rows.hpp"
#include "rpc/core/halo.hpp"
#include "rpc/core/tpetra.hpp"

#include <functional>
#include <memory>

namespace rpc
{

/// A matrix whose rows are known, and which is assembled on demand.
struct UnassembledMatrix {
  RepeatedRows rows;
  RCP<const Map> dofs;
  std::shared_ptr<const Halo> halo;         ///< of the columns
  std::function<RCP<CrsMatrix>()> assemble; ///< collective
};

/// The stiffness K of a body on its mesh: symmetric positive definite once prescribed unknowns are eliminated, and constant. It belongs
/// to the body and knows nothing of contact.
///
/// Where rows repeat, products need no matrix, and there may be none until an algebraic preconditioner asks for one. All members
/// are collective.
class StiffnessOperator : public Operator
{
public:
  /// @param K    assembled; each node's unknowns are consecutive rows with equal columns. Nobody may change it from here on.
  /// @param dim  unknowns of a node, 1 to 3
  StiffnessOperator(RCP<const CrsMatrix> K, int dim);
  /// The same of a K that is not assembled yet.
  explicit StiffnessOperator(UnassembledMatrix K);

  /// y <- alpha K x + beta y.
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  RCP<const Map> getDomainMap() const override { return dofs_; }
  RCP<const Map> getRangeMap() const override { return dofs_; }
  bool hasTransposeApply() const override { return false; }

  /// y <- K x by rows in single precision, for preconditioners.
  void apply_rounded(const RoundedRows &rounded, const MultiVector &x, MultiVector &y) const;

  int dofs_per_node() const { return rows_.dim(); }
  /// The blocks on the diagonal.
  NodeBlocks diagonal_blocks() const { return rpc::diagonal_blocks(rows_); }
  /// (n, dim, dim) Those of some owned nodes.
  DeviceView<double ***> diagonal_blocks(const DeviceView<LO *> &nodes) const;
  const RepeatedRows &rows() const { return rows_; }
  /// What x is at the columns, see Halo.
  const Vector &at_columns(const Vector &x) const { return halo_->at_columns(x); }

  /// Assembled now if it was not before.
  const RCP<const CrsMatrix> &matrix() const;
  /// A matrix that the caller may write into: with values of its own, and K's graph. Where K is not assembled, it is for this copy only.
  RCP<CrsMatrix> copy() const;
  /// How often K has been assembled, to be kept here or for a copy.
  int assemblies() const { return assemblies_; }

private:
  RepeatedRows rows_;
  RCP<const Map> dofs_;
  std::shared_ptr<const Halo> halo_; // of the columns
  std::function<RCP<CrsMatrix>()> assemble_;
  mutable RCP<const CrsMatrix> matrix_; // null: not kept
  mutable int assemblies_ = 0;
};

} // namespace rpc
