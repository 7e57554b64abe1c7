#pragma once

#include "rpc/algebra/repeated_rows.hpp"
#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc::solver
{

/// The contact nodes of all ranks, rank after rank, with their supports on one mesh: the displacement of node i is
/// sum_k weight[k] u(node[k]), k from begin[i] to begin[i + 1].
struct PointSupports {
  int dim = 2;
  std::vector<std::size_t> begin{0}; ///< (points + 1)
  std::vector<GO> node;              ///< (entries) gids
  std::vector<double> weight;        ///< (entries)

  int size() const { return static_cast<int>(begin.size()) - 1; }
};

/// Those on the mesh whose nodes these are; collective.
PointSupports point_supports(const DeviceView<LO *> &nodes, int dim, const Map &dofs);

/// The same points on the next coarser mesh; collective.
/// @param interpolation  (nodes of the mesh x nodes of the coarser one)
PointSupports coarser(const PointSupports &fine, const CrsMatrix &interpolation);

/// The matrix of a coarse mesh with contact: A and, with P the interpolation to the finest mesh,
///
///     P^T (sum_i e_i U_i e_i^T) P.                                                              doc/theory.md (4.7a)
///
/// The sum is written into the entries of the nodes around the points, in place. Couplings of nodes that share no cell of the coarse mesh are
/// replaced by their bound on the diagonal; they occur where meshes are not nested.
class CoarseContact : public Operator
{
public:
  /// @param A  the coarse mesh's matrix without contact   @param prescribed (columns of A) 1 where displacements are prescribed
  CoarseContact(const PointSupports &points, RCP<CrsMatrix> A, const DeviceView<char *> &prescribed);

  /// y <- (A with contact) x; collective.
  void apply(const MultiVector &x, MultiVector &y, Teuchos::ETransp mode = Teuchos::NO_TRANS, double alpha = 1,
             double beta = 0) const override;
  RCP<const Map> getDomainMap() const override { return A_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return A_->getRangeMap(); }

  /// @param update  (points of all ranks, dim, dim) [N/m]
  void write(const DeviceView<double ***> &update);

  /// (n) Owned nodes with entries that change, ascending.
  const DeviceView<LO *> &nodes() const { return nodes_; }
  /// (owned nodes, dim, dim) The diagonal blocks of all nodes, as long as no contact is written.
  DeviceView<double ***> base_blocks() const { return diagonal_blocks(rows_); }
  /// (n, dim, dim) Their present diagonal blocks.
  DeviceView<double ***> blocks() const;

private:
  int dim_;
  RCP<CrsMatrix> A_;
  RepeatedRows rows_;                    // of the matrix without contact
  DeviceView<LO *> row_, column_;        // (blocks) owned node; column's node
  DeviceView<std::size_t **> entry_;     // (blocks, dim) where the block begins in each of its rows
  DeviceView<double ***> base_;          // (blocks, dim, dim) without contact
  DeviceView<std::size_t *> begin_;      // (blocks + 1) where a block's parts begin
  DeviceView<int *> point_;              // (parts)
  DeviceView<double *> coefficient_;     // (parts) product of the weights at both nodes
  DeviceView<char *> prescribed_;        // (columns of A)
  DeviceView<LO *> nodes_;               // (n)
  DeviceView<std::size_t **> own_entry_; // (n, dim) where the node's own block begins
};

} // namespace rpc::solver
