// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "owner_questions.hpp"
#include "rpc/algebra/repeated_rows.hpp"
#include "rpc/solver/mesh_levels.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace rpc::solver
{

/// Blocks that contact adds to a matrix, in the rows of owned nodes.
struct AddedBlocks {
  DeviceView<LO *> row, column; ///< (blocks) owned nodes, ascending; nodes of the matrix's columns
  DeviceView<double ***> block; ///< (blocks, dim, dim)
};

/// Blocks in the rows of some nodes, on the host.
struct BlockRows {
  std::vector<std::size_t> begin{0}; ///< (rows + 1) where a row's blocks begin
  std::vector<GO> column;            ///< (blocks) gid of the column's node
  std::vector<double> value;         ///< (blocks, dim, dim)
};

/// The matrices R_p A R_p^T of patches of nodes, on the host. Of nodes that other ranks own, these send the rows.
class PatchMatrices
{
public:
  /// Collective. For the parameters see PatchSolver.
  PatchMatrices(const RepeatedRows &rows, const RCP<const Map> &nodes, const std::vector<GO> &columns,
                const NodePatches &patches, const AddedBlocks &added);
  PatchMatrices(const PatchMatrices &) = delete;

  int size() const { return static_cast<int>(begin_.size()) - 1; }
  /// Number of a patch's unknowns.
  int rows_of(const int patch) const { return dim_ * (begin_[patch + 1] - begin_[patch]); }
  const std::vector<LO> &begin() const { return begin_; }   ///< (patches + 1)
  const std::vector<LO> &node() const { return node_; }     ///< (entries) the owned nodes, then the ghosts
  const std::vector<GO> &ghosts() const { return ghosts_; } ///< gids
  LO num_nodes() const { return num_owned_ + static_cast<LO>(ghosts_.size()); }

  /// Whether contact adds to a patch.
  bool changes(int patch) const;
  /// Equal for patches whose matrices are equal without contact; empty where that is not known beforehand.
  std::vector<LO> likeness(int patch) const;
  /// (rows, rows) Without contact. For the time of construction: the rows of A are not kept.
  std::vector<double> without_contact(int patch) const;
  void forget_rows();

  /// Contact adds other blocks; collective.
  void set_added(const DeviceView<double ***> &block);
  /// (rows, rows) What contact adds.
  std::vector<double> added(int patch) const;

private:
  using BlocksOnHost = decltype(to_host(DeviceView<double ***>())); // in the device's layout
  /// Takes a block of a row: its column's gid and its values.
  using TakeBlock = std::function<void(GO column, const double *value)>;
  BlockRows rows_of_ghosts(const BlockRows &mine) const;
  void take_row(const BlockRows &rows, std::size_t row, const TakeBlock &take) const;
  void append_added(LO node, const BlocksOnHost &block, BlockRows &to) const;
  std::vector<double> gathered(int patch, const std::function<void(LO node, const TakeBlock &take)> &blocks_of) const;

  int dim_;
  RCP<const Map> nodes_;
  LO num_owned_;
  std::vector<LO> begin_, node_;
  std::vector<GO> ghosts_;
  std::unique_ptr<OwnerQuestions> questions_; // about the ghosts; null in one process
  std::optional<RepeatedRows> rows_;          // of the owned nodes; none: forgotten
  std::vector<GO> columns_;                   // (nodes of A's columns) gids
  decltype(to_host(DeviceView<int *>()))
      kind_;             // (owned nodes) nodes of one kind have the same rows but for a shift of columns; < 0: of none
  BlockRows ghost_rows_; // (ghosts)
  std::vector<LO> added_row_;    // (blocks) ascending
  std::vector<GO> added_column_; // (blocks)
  BlockRows added_;              // (nodes) what contact adds now
};

} // namespace rpc::solver
