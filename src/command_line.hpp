// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Tpetra_Core.hpp>
#include <memory>
#include <string>
#include <vector>

namespace rpc
{

struct CommandLine {
  std::string input;                    ///< deck, as given
  std::string output = ".";             ///< folder
  bool restarts = false;                ///< a run goes on from a checkpoint
  std::string restart;                  ///< the checkpoint; empty: the newest one in the output folder
  std::vector<std::string> assignments; ///< of --set, in order
  bool check = false;
  std::string mesh;             ///< a geometry or mesh that is to be told about
  std::string surface;          ///< a file of heights that is to be made
  bool writes_template = false; ///< a deck to start from
  std::string new_deck;         ///< its name; empty or help: the menu of them
  bool help = false;
  bool print_parameters = false;
  bool prints_schema = false;
  std::string schema; ///< json or relaxng
  bool version = false;
  bool verbose = false; ///< the console tells what was skipped too

  /// Whether there is a scene to be solved or checked: texts need no kernels and so no GPU.
  bool solves() const
  {
    return !help && !version && !print_parameters && !prints_schema && !writes_template && mesh.empty() &&
           surface.empty();
  }
};

/// The arguments, those for Kokkos apart: Kokkos must not see the others, or it answers to --help and --threads too.
/// Both start with the program's name.
struct Arguments {
  std::vector<char *> kokkos, own;
  bool kokkos_help = false; ///< Kokkos lists its options, and the run ends
};
Arguments split_arguments(int argc, char *argv[]);

/// @throws rpc::Error (bad_input) on an unknown or incomplete option
CommandLine parse_command_line(const std::vector<char *> &arguments);

/// Starts Kokkos with the options that are for it; on all ranks alike.
/// @param root  whether this is rank 0, which alone prints Kokkos' help
/// @throws rpc::Error (bad_input) on an option that Kokkos refuses or does not know
std::unique_ptr<Tpetra::ScopeGuard> start_kokkos(std::vector<char *> arguments, bool root);

/// What --help prints.
std::string help_text();

} // namespace rpc
