// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "patch_matrices.hpp"
#include "rpc/core/halo.hpp"

#include <memory>
#include <vector>

namespace rpc::solver
{

/// Exact solves on patches of nodes, added up: the additive Schwarz preconditioner
///
///     B = sum_p R_p^T (R_p A R_p^T)^-1 R_p                                                      doc/theory.md (4.7f)
///
/// with R_p the selection of patch p's unknowns. Symmetric; positive definite where each node is in a patch. Patches with equal matrices
/// share an inverse. A may have blocks that change, where contact adds to it.
class PatchSolver
{
public:
  /// Collective.
  /// @param rows     A without contact
  /// @param nodes    map of the nodes
  /// @param columns  (nodes of A's columns) gids
  /// @param patches  of this rank; their nodes may be those of any ranks
  /// @param added    what contact adds now, at all places where it may ever add
  /// @throws std::runtime_error on all ranks if a patch's matrix is not positive definite
  PatchSolver(const RepeatedRows &rows, const RCP<const Map> &nodes, const std::vector<GO> &columns,
              const NodePatches &patches, const AddedBlocks &added);

  /// Contact adds other blocks at the same places; collective. @throws as above
  void set_added(const DeviceView<double ***> &block);

  /// z <- B r; collective.
  void apply(const Vector &r, Vector &z) const;

  int num_patches() const { return static_cast<int>(place_.extent(0)); }
  /// Inverses that are kept.
  int num_inverses() const { return num_inverses_; }

private:
  void invert_what_stays();
  void invert_what_changes();
  void list_entries();

  PatchMatrices matrices_;
  std::vector<int> changing_; // patches that contact adds to
  std::vector<std::vector<double>> without_,
      last_added_;                             // (changing) their matrices without contact; what contact added last
  std::vector<std::size_t> place_of_changing_; // (changing) where its inverse begins in changing_inverse_
  HostView<double *> changing_inverse_;
  std::size_t first_changing_ = 0; // place among all inverses
  int num_inverses_ = 0;

  int dim_;
  RCP<const Comm> comm_;
  std::shared_ptr<const Halo> halo_;
  DeviceView<LO *> begin_, node_;        // (patches + 1), (entries) the owned nodes, then those of other ranks
  DeviceView<LO *> patch_;               // (entries) of which the entry is
  DeviceView<std::size_t *> place_;      // (patches) of the inverse
  DeviceView<double *> inverse_;         // column after column, see stride_of()
  DeviceView<LO *> first_entry_, entry_; // (nodes + 1), (entries) where a node occurs
  DeviceView<double *> part_;            // (entries * dim) solutions on patches
};

} // namespace rpc::solver
