#pragma once

#include "rpc/core/tpetra.hpp"

#include <optional>

namespace rpc
{

/// Products with a matrix most of whose rows repeat those of a few nodes, as on a box of equal cells: such a row is kept once for
/// all nodes of its kind, and a product reads a number a node instead of the row. The other rows are read from the matrix, a node's
/// columns once: where none repeat, that still takes a third of the time of a product row by row.
///
/// Nodes are of one kind if their rows have the same values in columns that lie as far from the node in the numbering.
class RepeatedRows
{
public:
  /// @param A    fill-complete; each node's unknowns are consecutive rows with equal columns, and so are its columns. It is kept, and
  ///             its values as they are now are those of the repeated rows.
  /// @param dim  unknowns of a node
  /// @return nothing where a node has one unknown; on a GPU, where less than three quarters of the rows repeat
  static std::optional<RepeatedRows> of(RCP<const CrsMatrix> A, int dim);

  /// y <- A x, of this rank.
  /// @param x  (columns of A)   @param y  (rows of A)
  void apply(const Vector &x, Vector &y) const;

  /// 0 where less than three quarters of this rank's rows repeat.
  int num_kinds() const { return static_cast<int>(begin_.extent(0)) - 1; }

private:
  RCP<const CrsMatrix> A_;
  int dim_ = 2;
  DeviceView<short *> kind_;   // (owned nodes) -1: read from A
  DeviceView<LO *> begin_;     // (kinds + 1) where the neighbours of a kind begin
  DeviceView<LO *> offset_;    // (neighbours) number of the column's node less that of the row's
  DeviceView<double *> value_; // (neighbours * entries of a padded block)
};

} // namespace rpc
