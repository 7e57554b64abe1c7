// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/updated_operator.hpp"
#include "rpc/solver/sparse_factor.hpp"

#include <memory>
#include <optional>

namespace rpc::solver
{

/// Columns of a matrix that belong to a patch: rows with an entry in them, ascending, and their entries. Of this rank.
struct PatchColumns {
  DeviceView<LO *> row;            ///< (rows) owned rows
  DeviceView<std::size_t *> begin; ///< (rows + 1) where their entries begin
  DeviceView<int *> column;        ///< (entries) place in the patch
  DeviceView<double *> value;      ///< (entries)
};

/// The same entries, column after column.
struct PatchEntries {
  DeviceView<std::size_t *> begin; ///< (columns + 1) where a column's entries begin
  DeviceView<LO *> row;            ///< (entries) owned rows, ascending in each column
  DeviceView<double *> value;      ///< (entries)
};

/// Number of nodes of all ranks at which the symmetric part of H's update is another one than what was written, by more than a part of
/// their own stiffness; collective.
GO num_changes(const UpdatedOperator &H, const DeviceView<double ***> &written, double slight = 0);

/// Carries a preconditioner M of a matrix A over to the stiffness H, by exact solves on a patch, the
/// unknowns of the contact nodes where the two differ and, in the plane, of some layers of cells around them:
///
///     B = Q + (I - Q H) M (I - H Q),    Q = R^T (R H R^T)^-1 R                                    doc/theory.md (4.8)
///
/// B is SPD if M is, and costs M and two solves on the patch more. The patch's factor lies on all ranks.
class LocalCorrection
{
public:
  /// Collective. Of an update that is not symmetric it takes the symmetric part.
  /// @param A        K with an earlier update in it   @param written  (nodes of H, dim, dim) that one, symmetric
  /// @param slight   changes up to this part of a node's own stiffness are left out
  /// @return nothing where there are no other changes, or the patch would be too large
  static std::optional<LocalCorrection> around(const UpdatedOperator &H, const CrsMatrix &A,
                                               const DeviceView<double ***> &written, double slight = 0);

  /// y <- B x; collective.
  void apply(const Operator &M, const Vector &x, Vector &y) const;

  /// q <- Q b, and rest <- b - H q, which is 0 on the patch; collective.
  void solve_on_patch(const Vector &b, Vector &q, Vector &rest) const;
  /// y <- B r where r is 0 on the patch: (I - Q H) M r, with one solve on the patch and one sum over the ranks. H y is 0 on the
  /// patch, so that the residuals of a Krylov method that starts from `rest` stay 0 there. Collective.
  void apply_off_patch(const Operator &M, const Vector &r, Vector &y) const;
  int size() const { return size_; } ///< unknowns in the patch, over all ranks

private:
  DeviceView<double *> solve(const DeviceView<double *> &mine) const;

  RCP<const Comm> comm_;
  int size_ = 0;
  PatchColumns columns_;                       ///< of H
  PatchEntries entries_;                       ///< of these columns
  DeviceView<LO *> member_row_;                ///< (own members) owned rows in the patch ...
  DeviceView<int *> member_;                   ///< (own members) ... and where
  std::shared_ptr<const SparseFactor> factor_; ///< of R H R^T
};

} // namespace rpc::solver
