// SPDX-License-Identifier: BSD-3-Clause
#include "command_line.hpp"

#include "gpu.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/kokkos.hpp"
#include "rpc/core/kokkos_start.hpp"
#include "rpc/core/parameters.hpp"

#include <Teuchos_CommandLineProcessor.hpp>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <regex>
#include <sstream>
#include <string>

#ifdef HAVE_TPETRACORE_MPI
#include <mpi.h>
#endif

namespace rpc
{
namespace
{

constexpr std::array options_with_value{"--input",  "--make-surface", "--mesh-info", "--new",
                                        "--output", "--print-schema", "--restart",   "--set"};
constexpr std::array flags{"--check", "--print-parameters", "--verbose", "--version", "--help"};

bool is_one_of(const std::string &text, const std::vector<std::string> &names)
{
  return std::find(names.begin(), names.end(), text) != names.end();
}

/// "--name value" as "--name=value", and no value where none belongs: Teuchos passes over both without a word.
std::vector<std::string> joined(const std::vector<char *> &arguments)
{
  const std::vector<std::string> valued(options_with_value.begin(), options_with_value.end());
  const std::vector<std::string> plain(flags.begin(), flags.end());
  std::vector<std::string> result;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    std::string text = arguments[i];
    if (i > 0 && is_one_of(text, valued) && i + 1 < arguments.size() && arguments[i + 1][0] != '-')
      text += std::string("=") + arguments[++i];
    const auto equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const bool has_value = equals != std::string::npos && equals + 1 < text.size();
    const bool newest = text == "--restart" || text == "--new" || text == "--print-schema"; // they go without
    RPC_REQUIRE(i == 0 || has_value || newest || !is_one_of(name, valued),
                "command line: " << name << " needs a value, as in " << name << "="
                                 << (name == "--set" ? "\"Sublist->Parameter=value\"" : "NAME") << ". See rpc --help.");
    RPC_REQUIRE(i == 0 || equals == std::string::npos || !is_one_of(name, plain),
                "command line: " << name << " takes no value, got \"" << text << "\". See rpc --help.");
    result.push_back(text);
  }
  return result;
}

/// Takes every --set=... out of the arguments: Teuchos keeps only the last of equal options.
std::vector<std::string> take_assignments(std::vector<std::string> &arguments)
{
  std::vector<std::string> assignments, rest;
  for (const std::string &argument : arguments) {
    if (argument.rfind("--set=", 0) != 0) {
      rest.push_back(argument);
      continue;
    }
    std::string text = argument.substr(6);
    if (text.size() > 1 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    assignments.push_back(text);
  }
  arguments = rest;
  return assignments;
}

/// Takes out a flag that Teuchos does not know or would act upon by itself.
bool take_flag(std::vector<std::string> &arguments, const std::string &name)
{
  const auto end = std::remove(arguments.begin() + 1, arguments.end(), name);
  const bool found = end != arguments.end();
  arguments.erase(end, arguments.end());
  return found;
}

/// Names the argument that Teuchos' message is about.
std::string refusal(const std::string &message)
{
  static const std::regex quote("option '(.*)' was not recognized");
  std::smatch found;
  if (!std::regex_search(message, found, quote)) return "command line: " + one_line(message);
  const std::string argument = found[1];
  std::vector<std::string> names(options_with_value.begin(), options_with_value.end());
  names.insert(names.end(), flags.begin(), flags.end());
  const std::string nearest = nearest_name(argument.substr(0, argument.find('=')), names);
  if (argument[0] != '-')
    return "command line: unknown option \"" + argument + "\". A deck is named by --input=" + argument + ".";
  return "command line: unknown option \"" + argument + "\"." +
         (nearest.empty() ? "" : " Did you mean " + nearest + "?");
}

} // namespace

Arguments split_arguments(const int argc, char *argv[])
{
  Arguments arguments;
  for (int i = 0; i < argc; ++i) {
    const bool for_kokkos = std::string(argv[i]).rfind("--kokkos-", 0) == 0;
    arguments.kokkos_help |= std::string(argv[i]) == "--kokkos-help";
    if (i == 0 || for_kokkos) arguments.kokkos.push_back(argv[i]);
    if (i == 0 || !for_kokkos) arguments.own.push_back(argv[i]);
  }
  return arguments;
}

CommandLine parse_command_line(const std::vector<char *> &argument_pointers)
{
  using Teuchos::CommandLineProcessor;
  std::vector<std::string> arguments = joined(argument_pointers);
  CommandLine line;
  line.assignments = take_assignments(arguments);
  line.help = take_flag(arguments, "--help") | take_flag(arguments, "-h");
  line.verbose = take_flag(arguments, "--verbose");
  const bool newest = take_flag(arguments, "--restart"), menu = take_flag(arguments, "--new");
  const bool schema = take_flag(arguments, "--print-schema");

  CommandLineProcessor parser(false, true, false);
  parser.setOption("input", &line.input, "");
  parser.setOption("make-surface", &line.surface, "");
  parser.setOption("mesh-info", &line.mesh, "");
  parser.setOption("new", &line.new_deck, "");
  parser.setOption("output", &line.output, "");
  parser.setOption("print-schema", &line.schema, "");
  parser.setOption("restart", &line.restart, "");
  parser.setOption("check", "run", &line.check, "");
  parser.setOption("print-parameters", "no-print-parameters", &line.print_parameters, "");
  parser.setOption("version", "no-version", &line.version, "");
  std::vector<char *> pointers;
  for (std::string &argument : arguments) pointers.push_back(argument.data());
  std::ostringstream text;
  const auto status = parser.parse(static_cast<int>(pointers.size()), pointers.data(), &text);
  RPC_REQUIRE(status == CommandLineProcessor::PARSE_SUCCESSFUL, refusal(text.str()) << " See rpc --help.");
  line.writes_template = menu || !line.new_deck.empty();
  if (schema && line.schema.empty()) line.schema = "json";
  line.prints_schema = !line.schema.empty();
  RPC_REQUIRE(!line.prints_schema || line.schema == "json" || line.schema == "relaxng",
              "command line: --print-schema must be one of json, relaxng, got \"" << line.schema
                                                                                  << "\". See rpc --help.");
  for (const auto &[option, given] : {std::pair<std::string, bool>{"--make-surface", !line.surface.empty()},
                                      {"--mesh-info", !line.mesh.empty()},
                                      {"--new", line.writes_template}})
    RPC_REQUIRE(!given || line.input.empty(), "command line: " << option
                                                               << " does not go with --input, which would not be "
                                                               << "read. Leave one of them out.");
  line.restarts = newest || !line.restart.empty();
  RPC_REQUIRE(!newest || line.restart.empty(),
              "command line: --restart stands twice, once with a file and once without. See rpc --help.");
  return line;
}

namespace
{

/// Throws on every rank what one of them met with, for all are to end; before there is a Comm, collective.
void throw_on_all_ranks([[maybe_unused]] const std::optional<Error> &mine)
{
#ifdef HAVE_TPETRACORE_MPI
  int rank = 0, size = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  int first = mine ? rank : size;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (first == size) return;
  std::string text = mine ? mine->what() : "";
  if (size > 1 && rank == first) {
    char host[MPI_MAX_PROCESSOR_NAME + 1] = {};
    int length = 0;
    MPI_Get_processor_name(host, &length);
    text += " This happened on rank " + std::to_string(rank) + " of " + std::to_string(size) + ", host " + host + ".";
  }
  int numbers[2] = {mine ? static_cast<int>(mine->code()) : 0, static_cast<int>(text.size())};
  MPI_Bcast(numbers, 2, MPI_INT, first, MPI_COMM_WORLD);
  text.resize(numbers[1]);
  MPI_Bcast(text.data(), numbers[1], MPI_CHAR, first, MPI_COMM_WORLD);
  throw Error(static_cast<ExitCode>(numbers[0]), text);
#else
  if (mine) throw *mine;
#endif
}

} // namespace

std::unique_ptr<Tpetra::ScopeGuard> start_kokkos(std::vector<char *> arguments, const bool root)
{
  std::string given; // Kokkos takes its options out
  for (std::size_t i = 1; i < arguments.size(); ++i) given += std::string(" ") + arguments[i];
  if (!root) // Kokkos prints it on every rank
    arguments.erase(std::remove(arguments.begin(), arguments.end(), std::string("--kokkos-help")), arguments.end());
  std::string gpu = gpu_option(arguments);
  if (!gpu.empty()) arguments.push_back(gpu.data());
  std::vector<std::string> spelled; // for this version of Kokkos
  for (const char *const argument : arguments) spelled.push_back(kokkos_spelling(argument));
  std::vector<char *> pointers;
  for (std::string &argument : spelled) pointers.push_back(argument.data());
  int argc = static_cast<int>(pointers.size());
  pointers.push_back(nullptr);
  char **argv = pointers.data();
  std::unique_ptr<Tpetra::ScopeGuard> guard;
#ifdef KOKKOS_ENABLE_CUDA
  setenv("KOKKOS_DISABLE_WARNINGS", "ON", 0); // it warns of managed memory, which Tpetra 13.2 cannot do without
#endif
  std::optional<Error> failure; // maybe on this rank alone, such as one without a GPU
  try {
    start_or_throw([&] { guard = std::make_unique<Tpetra::ScopeGuard>(&argc, &argv); });
  } catch (const std::exception &error) {
    static const std::regex place(R"(\s*\S+\.[ch]pp:\d+)"); // in Kokkos' sources
    const std::string reason = std::regex_replace(one_line(error.what()), place, "");
    if (given.empty())
      failure.emplace(ExitCode::internal_error,
                      std::string("start: Kokkos cannot run on ") + ExecutionSpace::name() + " here (" + reason +
                          "). A program built for CUDA takes an NVIDIA GPU that nvidia-smi lists; " +
                          "elsewhere build for the host, see doc/portability.md.");
    else
      failure.emplace(ExitCode::bad_input,
                      "command line: Kokkos refuses its options" + given + " (" + reason + "). See rpc --kokkos-help.");
  }
  if (!failure && argc > 1)
    failure.emplace(ExitCode::bad_input, std::string("command line: Kokkos does not know the option \"") + argv[1] +
                                             "\". See rpc --kokkos-help.");
  throw_on_all_ranks(failure);
  return guard;
}

std::string help_text()
{
  return R"(Contact of an elastic body with a rigid-plastic foundation.

Usage: rpc --new=NAME
       rpc --input=DECK [options]
       mpirun -n RANKS rpc --input=DECK [options]

  --input=DECK         the problem, in Teuchos XML or, by its extension .yaml or .yml, in YAML;
                       looked up as given, then among the decks that come with rpc
  --new                lists commented decks to start from
  --new=NAME           writes one of them, NAME.xml, and never over a file that is there
  --mesh-info=FILE     tells blocks, sides, sizes and quality of a geometry or mesh, and draws it
                       in the output folder
  --make-surface=FILE  writes a synthetic rough surface, .npy, .csv or .asc, as --set says, e.g.
                       --set="RMS Slope=0.1" --set="Points=256"; see doc/input/surfaces.md
  --output=DIR         folder for the results, made if missing; default: the current one
  --set="A->B=VALUE"   sets a parameter of the deck, any number of times,
                       e.g. --set="Contact->Yield Stress=16" --set="Mesh->Cells={80, 16}"
  --restart            goes on after the newest checkpoint in the output folder
  --restart=FILE       goes on after a checkpoint, see "Steps->Checkpoint Every"
  --check              does all that a run does before its first solve, and writes nothing
  --verbose            the console also tells what parts of the algorithm the run skipped, and the
                       residuals of every Uzawa iteration
  --print-parameters   prints every parameter of a deck: type, default, meaning, unit
  --print-schema       prints the JSON Schema of decks in YAML, for editors
  --print-schema=relaxng
                       prints the RELAX NG schema of decks in XML, for editors
  --version            prints the version
  --help, -h           prints this text
  --kokkos-...         goes to Kokkos, e.g. --kokkos-threads=4; --kokkos-help lists them

Results: DECK.e (fields, for ParaView), DECK.contact.csv (contact surface), DECK.json (summary);
         of load steps DECK.history.csv (a row for each).

Exit codes: 0 converged
            1 internal error
            2 bad input
            3 bad mesh
            4 not converged, or interrupted
            5 no solution exists, or none that is determined
)";
}

} // namespace rpc
