// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

namespace rpc::solver
{

/// A matrix A for products with A and with A^T, also where several threads would add to a row of A^T at once. (Rows of A^T that had one owner
/// each would be sorted on the host: a product sums over the ranks that share one.)
class SharedRows
{
public:
  /// Collective.
  explicit SharedRows(RCP<const CrsMatrix> A);

  /// y <- A x; collective.
  void apply(const Vector &x, Vector &y) const { A_->apply(x, y); }
  /// y <- A^T x + beta y; collective.
  void apply_transposed(const Vector &x, Vector &y, double beta) const
  {
    if (transposed_.is_null())
      A_->apply(x, y, Teuchos::TRANS, 1., beta);
    else
      transposed_->apply(x, y, Teuchos::NO_TRANS, 1., beta);
  }
  const CrsMatrix &matrix() const { return *A_; }

private:
  RCP<const CrsMatrix> A_, transposed_; // null: one thread adds to rows of A^T in any order
};

} // namespace rpc::solver
