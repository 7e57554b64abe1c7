// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/alike_nodes.hpp"
#include "rpc/algebra/node_blocks.hpp"
#include "rpc/core/tpetra.hpp"

namespace rpc
{

/// The rows of some nodes of a matrix. Those of a node follow each other and have the same columns, its own among them.
struct RowsOfNodes {
  using LocalMatrix = CrsMatrix::local_matrix_device_type;

  DeviceView<LO *> node;  ///< (n) owned nodes, lids
  DeviceView<LO *> place; ///< (n) which of the nodes of `rows` that is
  LocalMatrix rows;       ///< (nodes * dim, columns)

  LO size() const { return static_cast<LO>(node.extent(0)); }
};

/// Products with a matrix most of whose rows repeat those of a few nodes, as on a box of equal cells: such a row is kept once for
/// all nodes of its kind, and a product reads a number a node instead of the row. The other rows are read from a matrix, a node's
/// columns once: where none repeat, that still takes a third of the time of a product row by row.
///
/// Nodes are of one kind if their rows have the same values in columns that lie as far from the node in the numbering.
class RepeatedRows
{
public:
  using LocalMatrix = RowsOfNodes::LocalMatrix;

  /// @param A    fill-complete; each node's unknowns are consecutive rows with equal columns, and so are its columns. It is kept: rows
  ///             that do not repeat have its values as they come to be, the others as they are now. Collective.
  /// @param dim  unknowns of a node, 1 to 3
  static RepeatedRows of(RCP<const CrsMatrix> A, int dim);

  /// Of a matrix that there is not.
  /// @param kinds  of the owned nodes
  /// @param rows   those of the kinds' examples, in their order, then of the nodes of no kind, ascending
  static RepeatedRows of(const AlikeNodes &kinds, const RowsOfNodes &rows, int dim);

  /// y <- A x, of this rank.
  /// @param x  (columns of A)   @param y  (rows of A)
  void apply(const Vector &x, Vector &y) const;
  /// Whether that takes less time than Tpetra's product. Where no rows repeat it does not on a GPU, for a thread for each node would read
  /// entries far apart, and not for one unknown a node, whose columns are read once anyway. The same on all ranks, for the two products
  /// exchange in different ways.
  bool pays() const { return pays_; }
  /// The matrix that it was made of, from which rows that do not repeat are read; null: there is none.
  const RCP<const CrsMatrix> &matrix() const { return A_; }

  /// Whether rows of this rank repeat; where it has none, too.
  bool any_repeat() const { return num_kinds() > 0 || num_nodes() == 0; }
  /// 0 where less than three quarters of this rank's rows repeat.
  int num_kinds() const { return static_cast<int>(begin_.extent(0)) - 1; }
  LO num_nodes() const { return static_cast<LO>(kind_.extent(0)); }
  int dim() const { return dim_; }

  /// The blocks in the rows of owned nodes, for kernels.
  struct Blocks {
    int dim;
    DeviceView<int *> kind;
    DeviceView<LO *> begin, offset;
    DeviceView<double *> value;
    LocalMatrix rest;

    /// Number of a node's blocks.
    KOKKOS_INLINE_FUNCTION LO size(const LO node) const
    {
      const int k = kind(node);
      if (k >= 0) return begin(k + 1) - begin(k);
      const LO row = dim * (-1 - k);
      return static_cast<LO>(rest.graph.row_map(row + 1) - rest.graph.row_map(row)) / dim;
    }
    /// The node in whose columns block n lies (overlap lid).
    KOKKOS_INLINE_FUNCTION LO column(const LO node, const LO n) const
    {
      const int k = kind(node);
      return k >= 0 ? node + offset(begin(k) + n)
                    : rest.graph.entries(rest.graph.row_map(dim * (-1 - k)) + dim * n) / dim;
    }
    /// Entry (i, j) of block n.
    KOKKOS_INLINE_FUNCTION double entry(const LO node, const LO n, const int i, const int j) const
    {
      const int k = kind(node);
      if (k >= 0) return value(block_size(dim) * (begin(k) + n) + place_in_block(dim, i, j));
      return rest.values(rest.graph.row_map(dim * (-1 - k) + i) + dim * n + j);
    }
    /// Which block lies on the diagonal.
    KOKKOS_INLINE_FUNCTION LO own(const LO node) const
    {
      LO n = 0;
      while (column(node, n) != node) ++n; // an owned node's first column has its first row's lid
      return n;
    }
  };
  Blocks blocks() const;

  /// A block in the list of a kind: four numbers in the plane, column after column; in space three columns of four, the last of which
  /// is 0; of one unknown a node one number.
  KOKKOS_INLINE_FUNCTION static constexpr std::size_t block_size(const int dim)
  {
    return dim == 1 ? 1 : dim == 2 ? 4 : 12;
  }
  KOKKOS_INLINE_FUNCTION static constexpr int place_in_block(const int dim, const int row, const int column)
  {
    return dim == 2 ? 2 * column + row : 4 * column + row;
  }

private:
  LocalMatrix rest() const { return A_.is_null() ? rest_ : A_->getLocalMatrixDevice(); }
  void list_kinds(const RowsOfNodes &examples);

  int dim_ = 2;
  bool pays_ = true;
  RCP<const CrsMatrix> A_;     // or null
  LocalMatrix rest_;           // without A: the rows that do not repeat, among others
  DeviceView<int *> kind_;     // (owned nodes) < 0: -1 - place of the node among those of the matrix that has the rest
  DeviceView<LO *> begin_;     // (kinds + 1) where the neighbours of a kind begin
  DeviceView<LO *> offset_;    // (neighbours) number of the column's node less that of the row's
  DeviceView<double *> value_; // (neighbours * size of a block)
};

/// The blocks on the diagonal. Nodes of a kind share one.
NodeBlocks diagonal_blocks(const RepeatedRows &rows);

} // namespace rpc
