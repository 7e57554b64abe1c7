#pragma once

#include "rpc/algebra/node_points.hpp"
#include "rpc/algebra/repeated_rows.hpp"
#include "rpc/algebra/rounded_rows.hpp"
#include "rpc/core/tpetra.hpp"

#include <functional>
#include <limits>
#include <memory>

namespace rpc
{

/// A matrix whose rows are known, and which is assembled where somebody asks for it.
struct UnassembledMatrix {
  RepeatedRows rows;
  RCP<const Map> dofs, columns;
  RCP<const Import> importer;               ///< of a vector to the columns; null where these are the dofs
  std::function<RCP<CrsMatrix>()> assemble; ///< collective
};

/// A symmetric positive definite operator with an update of rank one at each of some points, which changes often:
///
///     H = K + sum_i added_i w_i m_i m_i^T                                                         doc/theory.md (4.2)
///
/// with m_i the point's direction. The update lies in the diagonal blocks of the points' nodes.
///
/// The assembled matrix is there for algebraic preconditioners: it holds K and as much of the update as was last written into it, so
/// that a preconditioner made for it stays valid while H changes. Products do not see what was written. They take the rows
/// of the points' nodes from K's own blocks and the present update: to subtract what was written would leave the rounding of
/// the largest of them. Where rows repeat, products need no matrix, and there may be none. All members are collective.
class UpdatedOperator : public Operator
{
public:
  /// @param K  assembled, all its own; each node's unknowns are consecutive rows with equal columns
  UpdatedOperator(const RCP<CrsMatrix> &K, const NodePoints &points);
  /// The same of a K that is not assembled yet.
  UpdatedOperator(UnassembledMatrix K, const NodePoints &points);

  /// y <- alpha H x + beta y.
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  RCP<const Map> getDomainMap() const override { return dofs_; }
  RCP<const Map> getRangeMap() const override { return dofs_; }
  bool hasTransposeApply() const override { return false; }

  /// Ku <- K u.
  void apply_base(const Vector &u, Vector &Ku) const;
  /// y <- H x and y <- K x, up to single precision where that saves time: for preconditioners. See allow_rounding().
  void apply_rounded(const MultiVector &x, MultiVector &y) const;
  void apply_base_rounded(const MultiVector &x, MultiVector &y) const;
  /// Keeps K's rows in single precision too, or no longer: where they are read one by one, on the host, and nothing is written into
  /// the matrix.
  void allow_rounding(bool allowed);

  /// @param added  (points) >= 0
  /// @return number of points where it changed, over all ranks
  GO set(const DeviceView<double *> &added);
  /// Brings the matrix to H, with at most `most` times a point's own stiffness added at each: time for a new preconditioner.
  void write(double most = std::numeric_limits<double>::infinity());
  /// Assembled now if it was not before.
  const RCP<CrsMatrix> &matrix() const;
  bool has_matrix() const { return !matrix_.is_null(); }
  /// Grows with each change of H.
  int revision() const { return revision_; }
  int dofs_per_node() const { return points_.dim; }
  const NodePoints &points() const { return points_; }
  /// (points) as they were last set.
  const DeviceView<double *> &added() const { return added_; }
  /// (owned nodes, dim, dim) The diagonal blocks of K.
  DeviceView<double ***> base_blocks() const;
  /// (points) The node whose block a point changes; -1 for a point that is not the first one at its node.
  DeviceView<LO *> changing_nodes() const;
  /// (points, dim, dim) The blocks of K and of H at these nodes.
  const DeviceView<double ***> &changing_base_blocks() const { return base_blocks_; }
  const DeviceView<double ***> &changing_blocks() const { return blocks_; }

  /// Points whose part of H is not in the matrix: each adds coefficient m m^T to its node's own block. Of this rank.
  struct Changes {
    DeviceView<LO *> node;            ///< (n) owned node lids
    DeviceView<double **> direction;  ///< (n, dim) m
    DeviceView<double *> coefficient; ///< (n) (added - written) w, not 0
    LO size() const { return static_cast<LO>(node.extent(0)); }
  };
  Changes changes() const;

  /// (points) m . K_ii m / (w m . m) of the node's own block; 0 where the direction is.
  const DeviceView<double *> &own_stiffness() const { return own_stiffness_; }

  /// (points) kappa_i = sum_j |m_i . K_ij m_j| / |m_i|^2 over all points j, with |.| entry by entry: the energy of moves
  /// s_i m_i/|m_i|^2 of all points at once is at most sum_i kappa_i s_i^2/2.                                        (4.6)
  const DeviceView<double *> &coupled_stiffness() const { return coupled_stiffness_; }

private:
  void apply_with(const DeviceView<double ***> &blocks, bool rounded, const MultiVector &x, MultiVector &y) const;

  RepeatedRows rows_;                          // of K
  std::shared_ptr<const RoundedRows> rounded_; // or null
  RCP<const Map> dofs_, columns_;
  RCP<const Import> importer_;
  std::function<RCP<CrsMatrix>()> assemble_;
  mutable RCP<CrsMatrix> matrix_; // null: nobody has asked for it
  NodePoints points_;
  DeviceView<LO *> lead_;                // (points) first point of the same node
  DeviceView<double *> added_, written_; // (points) of H, and of the matrix
  bool has_changes_ = false;             // of H since the matrix was written
  bool is_written_ = false;              // the matrix is not K
  DeviceView<double *> own_stiffness_, coupled_stiffness_;
  // (points, dim) where the node's own block begins in each of its rows of the matrix
  mutable DeviceView<std::size_t **> entry_;
  DeviceView<double ***> base_blocks_; // (points, dim, dim) own blocks of K, and of H: that of a lead counts
  DeviceView<double ***> blocks_;
  int revision_ = 0;
};

} // namespace rpc
