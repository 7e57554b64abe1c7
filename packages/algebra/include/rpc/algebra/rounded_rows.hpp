// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/repeated_rows.hpp"

#include <memory>

namespace rpc
{

/// Products with a matrix in single precision, for preconditioners: half of the bytes.
///
///     (A x)_i ~ sum_{j != i} fl(A_ij) (x_j - x_i) + S_i x_i,    S_i = sum_j A_ij                    doc/theory.md (4.7d)
///
/// with blocks A_ij of nodes, fl(.) of single and S_i of double precision. To a translation of an elastic body it gives S_i x_i as A
/// does: stiffnesses between nodes are rounded, not the force of a translation. On the host only.
class RoundedRows
{
public:
  /// @param A    fill-complete; each node's unknowns are consecutive rows with equal columns, and so are its columns
  /// @param dim  unknowns of a node, 2 or 3
  RoundedRows(const CrsMatrix &A, int dim);

  /// y <- A x, of this rank.
  /// @param x  (columns of A)   @param y  (rows of A)
  void apply(const Vector &x, Vector &y) const;

private:
  int dim_;
  DeviceView<std::size_t *> begin_; // (owned nodes + 1) where a node's blocks begin, its own left out
  DeviceView<LO *> column_;         // (blocks) node
  DeviceView<float *> value_;       // (blocks * dim * dim, and some more)
  DeviceView<double *> sum_;        // (owned nodes * dim * dim) S_i, row after row
};

/// The same of rows as they are now. Null where they would save no time: only rows that are read one by one, on the host, do.
std::shared_ptr<const RoundedRows> rounded_where_it_pays(const RepeatedRows &rows);

} // namespace rpc
