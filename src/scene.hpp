// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "output/points.hpp"
#include "rpc/adapt/solve.hpp"
#include "rpc/io/exodus.hpp"

#include <Teuchos_DefaultSerialComm.hpp>
#include <Teuchos_ParameterList.hpp>
#include <string>
#include <utility>
#include <vector>

namespace rpc
{

struct OutputOptions {
  bool exodus = true, csv = true, json = true;
  io::ExodusFiles exodus_files = io::ExodusFiles::joined;
  bool timers = false;
  bool cell_stresses = false; ///< in the Exodus file
  bool verbose = false;       ///< of the command line: the console tells more
  std::vector<ResultPoints> points = {};
};

/// A deck, read and checked: all that a run needs to know.
struct Scene : adapt::Task {
  std::string name; ///< of the deck's file, without folder and extension
  OutputOptions output;
  std::vector<std::string> notes; ///< on the deck, for the user
  /// What a checkpoint must agree with, part by part of the deck.
  std::vector<std::pair<std::string, std::string>> identity;
};

/// Every parameter of a deck: the packages' lists put together.
Teuchos::ParameterList valid_deck();

/// A deck's parameters, all that it may have: names and types are right, values not looked at yet. As read_scene().
Teuchos::ParameterList read_parameters(const std::string &deck_path, const std::vector<std::string> &assignments,
                                       const Comm &comm = Teuchos::SerialComm<int>());

/// Rank 0 reads the files, of which other ranks may have none; collective on comm, by default each rank for itself.
/// @param assignments  "Sublist->Parameter=value", applied on top of the deck
/// @throws rpc::Error (bad_input) on every rank on the first thing that is wrong
Scene read_scene(const std::string &deck_path, const std::vector<std::string> &assignments,
                 const Comm &comm = Teuchos::SerialComm<int>());

} // namespace rpc
