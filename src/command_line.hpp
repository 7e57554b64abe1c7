#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rpc
{

struct CommandLine {
  std::string input;                    ///< deck, as given
  std::string output = ".";             ///< folder
  std::vector<std::string> assignments; ///< of --set, in order
  bool check = false;
  bool print_parameters = false;
  bool version = false;
};

/// @param help  where the text goes that --help asks for
/// @return nothing if --help was asked for
/// @throws rpc::Error (bad_input) on an unknown or incomplete option
std::optional<CommandLine> parse_command_line(int argc, char *argv[], std::string &help);

} // namespace rpc
