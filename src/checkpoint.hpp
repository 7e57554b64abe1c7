// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace rpc
{

/// Checkpoints of a run with load steps: after some steps all that the next one needs is written, so that a run that was ended can go
/// on. The newest two are kept.
class Checkpoints
{
public:
  /// @param restarts  the run goes on from a checkpoint
  /// @param restart   this one; empty: the newest in the folder that is whole
  /// @param folder    for new checkpoints
  Checkpoints(const Scene &scene, bool restarts, std::string restart, const std::string &folder);

  /// What the run goes on from, on its mesh, which is rebuilt; none from the first step. Collective.
  /// @throws rpc::Error (bad_input) on every rank if the file is damaged, or belongs to another mesh, deck or version
  std::optional<analysis::HistoryState> resume(const RCP<const Comm> &comm);
  /// Whether the run goes on from a checkpoint.
  bool goes_on() const { return restarts_; }
  /// The checkpoint that the run has gone on from; empty: none.
  const std::string &source() const { return restart_; }
  /// Writes a checkpoint. Collective.
  void write(const analysis::HistoryState &state);

private:
  struct Whole;
  Whole whole(const std::string &path, const RCP<const Comm> &comm) const;
  analysis::HistoryState state_of(Whole whole) const;
  std::vector<std::string> in_folder() const;
  void remove_others(const std::string &newest);

  const Scene &scene_;
  bool restarts_;
  std::string restart_, folder_;
  std::vector<std::string> written_;
};

} // namespace rpc
