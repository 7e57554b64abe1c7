#include "command_line.hpp"

#include "rpc/core/error.hpp"

#include <Teuchos_CommandLineProcessor.hpp>
#include <sstream>

namespace rpc
{
namespace
{

/// Takes every --set=... and --set ... out of the arguments: Teuchos keeps only the last of equal options.
std::vector<std::string> take_assignments(std::vector<char *> &arguments)
{
  std::vector<std::string> assignments;
  std::vector<char *> rest;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    std::string text = arguments[i];
    if (text == "--set") {
      RPC_REQUIRE(i + 1 < arguments.size(),
                  "command line: --set needs an assignment, --set=\"Sublist->Parameter=value\"");
      assignments.push_back(arguments[++i]);
    } else if (text.rfind("--set=", 0) == 0) {
      text = text.substr(6);
      if (text.size() > 1 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
      assignments.push_back(text);
    } else {
      rest.push_back(arguments[i]);
    }
  }
  arguments = rest;
  return assignments;
}

} // namespace

std::optional<CommandLine> parse_command_line(const int argc, char *argv[], std::string &help)
{
  using Teuchos::CommandLineProcessor;
  std::vector<char *> arguments(argv, argv + argc);
  CommandLine line;
  line.assignments = take_assignments(arguments);

  CommandLineProcessor parser(false, true, false);
  parser.setDocString(
      "Contact of an elastic body with a rigid-plastic foundation.\n\n"
      "  --set=\"Sublist->Parameter=value\" sets a parameter of the deck, any number of times.\n"
      "  --kokkos-* options go to Kokkos.\n\n"
      "Exit codes: 0 converged, 1 internal error, 2 bad input, 3 bad mesh, 4 not converged, 5 no solution exists.\n");
  parser.setOption("input", &line.input,
                   "Deck, .xml or .yaml; looked up as given, then among the decks that come with rpc.");
  parser.setOption("output", &line.output, "Folder for the results.");
  parser.setOption("check", "run", &line.check, "Only read and check the deck.");
  parser.setOption("print-parameters", "no-print-parameters", &line.print_parameters,
                   "Print all parameters of a deck and stop.");
  parser.setOption("version", "no-version", &line.version, "Print the version and stop.");
  std::ostringstream text;
  const auto status = parser.parse(static_cast<int>(arguments.size()), arguments.data(), &text);
  if (status == CommandLineProcessor::PARSE_HELP_PRINTED) {
    help = text.str();
    return std::nullopt;
  }
  RPC_REQUIRE(status == CommandLineProcessor::PARSE_SUCCESSFUL,
              "command line: " << text.str().substr(0, text.str().find("\n\n")) << "\nSee rpc --help.");
  return line;
}

} // namespace rpc
