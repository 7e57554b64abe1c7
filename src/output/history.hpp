// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/io/atomic_file.hpp"
#include "scene.hpp"

#include <memory>
#include <string>

namespace rpc
{

/// The table of load steps as comma-separated values: one row for each; for each Dirichlet condition its mean displacement and its
/// reaction. It grows with each step.
class HistoryFile
{
public:
  /// Adds the rows that the solution's history has and the file has not. Collective.
  /// @throws rpc::Error on every rank if they cannot be written; no part of them stays
  void update(const std::string &path, const Scene &scene, const analysis::Solution &solution);

private:
  std::unique_ptr<io::GrowingFile> file_; // rank 0 only
  std::size_t rows_ = 0;
};

} // namespace rpc
