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
  /// @param restart  checkpoint to go on from; empty: from the first step
  /// @param folder   for new checkpoints
  Checkpoints(const Scene &scene, std::string restart, const std::string &folder);

  /// What the run goes on from; none from the first step. Collective.
  /// @throws rpc::Error (bad_input) on every rank if the file is damaged, or belongs to another mesh, deck or version
  std::optional<analysis::HistoryState> resume(const fem::Discretization &d) const;
  /// Writes a checkpoint. Collective.
  void write(const analysis::HistoryState &state, const fem::Discretization &d);

private:
  void remove_others(const std::string &newest);

  const Scene &scene_;
  std::string restart_, folder_;
  std::vector<std::string> written_;
};

} // namespace rpc
