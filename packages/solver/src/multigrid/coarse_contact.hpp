// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "multigrid/contact_supports.hpp"
#include "rpc/algebra/rounded_rows.hpp"
#include "rpc/core/halo.hpp"
#include "rpc/solver/mesh_levels.hpp"

#include <memory>
#include <vector>

namespace rpc::solver
{

/// (contact nodes; dim * dim) The blocks of contact nodes, row after row, as a vector that other ranks can import.
/// @param contact  map of the contact nodes   @param block  (contact nodes, dim, dim)
MultiVector packed_blocks(const RCP<const Map> &contact, const DeviceView<double ***> &block);

/// The matrix of a coarse mesh with contact: A and, with S the supports of the contact nodes on this mesh,
///
///     S^T U S.                                                                                  doc/theory.md (4.7a)
///
/// Where A is assembled, the sum is written into its entries at the nodes around the contact nodes, in place. Products with rows that repeat,
/// or in single precision, do not read these entries, and where A is not assembled there are none: the sum is added to the products there.
/// Couplings of nodes that share no cell of the coarse mesh are replaced by their bound on the diagonal; they occur where meshes are not nested.
class CoarseContact : public Operator
{
public:
  /// Collective.
  /// @param supports    S, see contact_supports.hpp   @param nodes  map of the coarse mesh's nodes
  /// @param mesh  the coarse one, A without contact
  CoarseContact(const ContactSupports &supports, const Map &nodes, int dim, const MeshLevel &mesh);

  /// From now on apply() takes A in single precision where that saves time, and contact in double precision (4.7d). To be called before
  /// the first write().
  void allow_rounding() { rounded_ = rounded_where_it_pays(rows_); }

  /// y <- (A with contact) x; collective.
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  RCP<const Map> getDomainMap() const override { return dofs_; }
  RCP<const Map> getRangeMap() const override { return dofs_; }

  /// y += (S^T U S) x in the rows that it is not written into.  @param x  (columns of A)
  void add_product(const Vector &x, Vector &y) const;
  /// Whether couplings had to be bounded on any rank.
  bool is_bounded() const { return bounded_; }
  /// That of the next coarser mesh from the sums of this one, which is not bounded: each of them is a block that the coarser mesh's nodes
  /// share by P. Collective.  @param interpolation  P
  ContactSupports coarser_supports(const CrsMatrix &interpolation) const;
  /// (blocks; dim * dim) These sums, as they were written last, for its write().
  MultiVector packed_sums(const RCP<const Map> &blocks) const { return packed_blocks(blocks, sum_); }

  /// Collective. @param update  U, packed_blocks() [N/m]
  void write(const MultiVector &update);

  /// (n) Owned nodes with entries that change, ascending.
  const DeviceView<LO *> &nodes() const { return nodes_; }
  /// (owned nodes, dim, dim) The diagonal blocks of all nodes, as long as no contact is written.
  NodeBlocks base_blocks() const { return diagonal_blocks(rows_); }
  /// (n, dim, dim) Their present diagonal blocks.
  DeviceView<double ***> blocks() const;

private:
  int dim_;
  RCP<const Map> dofs_;
  RCP<CrsMatrix> A_;                     // null: not assembled
  RepeatedRows rows_;                    // of the matrix without contact
  std::shared_ptr<const Halo> halo_;     // of its columns
  RCP<const Import> near_;               // from the contact nodes to those near this rank's nodes
  std::vector<GO> row_gid_, column_gid_; // (blocks) nodes
  DeviceView<LO *> row_, column_;        // (blocks) owned node; column's node
  DeviceView<LO *> place_;               // (blocks) which one of its node's blocks it is
  DeviceView<double ***> base_;          // (blocks, dim, dim) without contact
  DeviceView<std::size_t *> begin_;      // (blocks + 1) where a block's parts begin
  DeviceView<int *> contact_;            // (parts) near contact node
  DeviceView<double *> coefficient_;     // (parts) product of the weights at both nodes
  DeviceView<char *> prescribed_;        // (columns of A)
  DeviceView<LO *> nodes_;               // (n)
  DeviceView<std::size_t *> first_;      // (n + 1) where a node's blocks begin
  DeviceView<double ***> sum_, added_;   // (blocks, dim, dim) S^T U S, and with 0 at prescribed unknowns
  bool bounded_ = false;                 // some couplings of it
  DeviceView<std::size_t *> own_;        // (n) the node's own block

  std::shared_ptr<const RoundedRows> rounded_; // A without contact, for apply(); null: apply() reads rows_
};

} // namespace rpc::solver
