// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene.hpp"
#include "solve.hpp"

#include <Tpetra_Core.hpp>
#include <string>
#include <vector>

/// Runs a deck in process, without output.
inline rpc::Solution run_scene(const std::string &deck, const std::vector<std::string> &assignments,
                               const rpc::RCP<const rpc::Comm> &comm = Tpetra::getDefaultComm())
{
  std::ostream nowhere(nullptr);
  return rpc::solve(rpc::read_scene(deck, assignments), comm, nowhere);
}
