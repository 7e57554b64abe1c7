// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/node_points.hpp"
#include "rpc/algebra/stiffness_operator.hpp"

#include <memory>

namespace rpc
{

/// A stiffness with an update that changes often: a block at each of some nodes.
///
///     H = K + sum_i e_i (U_i + C_i) e_i^T,    U_i, C_i dim x dim                                    doc/theory.md (4.2a)
///
/// U is symmetric positive semidefinite, and what preconditioners see; C, as a rule 0, need not be symmetric (12.5).
///
/// The update is kept as such and never mixed with K: it may be very much larger, and K's digits would be lost. All members are
/// collective.
class UpdatedOperator : public Operator
{
public:
  /// @param nodes  (n) distinct owned nodes, ascending: all at which there may ever be an update
  UpdatedOperator(RCP<const StiffnessOperator> K, DeviceView<LO *> nodes);

  /// y <- alpha H x + beta y.
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  RCP<const Map> getDomainMap() const override { return K_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return K_->getRangeMap(); }
  bool hasTransposeApply() const override { return false; }

  /// y <- (H - C) x and y <- K x, up to single precision where that saves time: for preconditioners. See allow_rounding().
  void apply_rounded(const MultiVector &x, MultiVector &y) const;
  void apply_base_rounded(const MultiVector &x, MultiVector &y) const;
  /// Keeps K's rows in single precision too, where that saves time, or no longer.
  void allow_rounding(bool allowed);
  /// Whether it keeps them now, on this rank.
  bool is_rounded() const { return rounded_ != nullptr; }

  /// The update at each node becomes the sum of the blocks of its points; it is 0 at nodes without a point.
  /// @param points  at some of nodes()   @param block  (points, dim, dim) U
  /// @param coupling  (points, dim, dim) C; empty: 0
  /// @return number of nodes where it changed, over all ranks
  /// @throws rpc::Error (internal_error) on all ranks if a point lies at another node
  GO set(const NodePoints &points, const DeviceView<double ***> &block, const DeviceView<double ***> &coupling = {});
  /// The update becomes that of another operator on the same nodes. An operator that follows is never set by itself: revisions tell whether
  /// there is anything to do.
  /// @throws rpc::Error (internal_error) where the nodes are others
  void follow(const UpdatedOperator &other);
  /// Grows with each change of H.
  int revision() const { return revision_; }
  /// Whether H is symmetric, up to rounding.
  bool is_symmetric() const { return symmetric_; }

  const StiffnessOperator &base() const { return *K_; }
  const RCP<const StiffnessOperator> &shared_base() const { return K_; }
  int dofs_per_node() const { return K_->dofs_per_node(); }
  const DeviceView<LO *> &nodes() const { return nodes_; }
  /// (nodes, dim, dim) U, the blocks of K, and those of H without C.
  const DeviceView<double ***> &update() const { return update_; }
  const DeviceView<double ***> &base_blocks() const { return base_blocks_; }
  DeviceView<double ***> blocks() const;
  /// y_n += (U_n + C_n) x_n at nodes(). @param x  (owned dofs)   @param y  (nodes times dim) a node's components side by side
  void add_update_at_nodes(const Vector &x, Vector &y) const;

private:
  RCP<const StiffnessOperator> K_;
  std::shared_ptr<const RoundedRows> rounded_; // or null
  DeviceView<LO *> nodes_;
  DeviceView<double ***> base_blocks_, update_;
  DeviceView<double ***> coupling_; // empty: 0
  bool symmetric_ = true;
  int revision_ = 0;
};

} // namespace rpc
