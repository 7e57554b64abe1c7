// SPDX-License-Identifier: BSD-3-Clause
#include "new_deck.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/remedies.hpp"
#include "rpc/io/deck.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace rpc
{
namespace
{

namespace fs = std::filesystem;

fs::path template_folder()
{
  std::string searched;
  for (const std::string &place : io::deck_folders()) {
    const fs::path folder = fs::path(place) / "templates";
    std::error_code error;
    if (fs::is_directory(folder, error)) return folder;
    searched += (searched.empty() ? "" : ", ") + folder.string();
  }
  throw Error(ExitCode::bad_input, "command line: --new finds no templates; searched: " + searched +
                                       ". Name the folder of rpc's decks in the environment variable RPC_INPUT_DIR.");
}

/// The first sentence of a deck's first comment.
std::string headline(const fs::path &deck)
{
  std::ifstream in(deck);
  std::string line;
  std::getline(in, line);
  const std::string mark = "<!-- ";
  return line.rfind(mark, 0) == 0 ? line.substr(mark.size(), line.find(". ") - mark.size()) : line;
}

void copy_new(const fs::path &from, const fs::path &to)
{
  std::error_code error;
  RPC_REQUIRE(!fs::exists(fs::symlink_status(to, error)),
              "command line: --new does not write over \""
                  << to.string() << "\", which is there. Rename it, or name another folder with --output=DIR.");
  fs::copy_file(from, to, error);
  RPC_REQUIRE(!error, "command line: --new cannot write \"" << to.string() << "\": " << error.message()
                                                            << ". Name another folder with --output=DIR.");
}

} // namespace

std::vector<Template> templates()
{
  std::vector<Template> found;
  for (const auto &entry : fs::directory_iterator(template_folder()))
    if (entry.path().extension() == ".xml") found.push_back({entry.path().stem().string(), headline(entry.path())});
  std::sort(found.begin(), found.end(), [](const Template &a, const Template &b) { return a.name < b.name; });
  return found;
}

std::string template_menu()
{
  const std::vector<Template> all = templates();
  std::size_t width = 0;
  for (const Template &each : all) width = std::max(width, each.name.size());
  std::string text =
      "rpc --new=NAME writes NAME.xml, a commented deck to start from, into the current folder or that of "
      "--output=DIR:\n\n";
  for (const Template &each : all)
    text += "  " + each.name + std::string(width + 3 - each.name.size(), ' ') + each.line + "\n";
  return text;
}

std::vector<std::string> write_template(const std::string &name, const std::string &folder)
{
  std::vector<std::string> names;
  for (const Template &each : templates()) names.push_back(each.name);
  RPC_REQUIRE(std::find(names.begin(), names.end(), name) != names.end(),
              "command line: --new has no template \"" << name << "\"." << did_you_mean(name, names)
                                                       << " Templates: " << join(names) << ".");
  const fs::path from = template_folder(), to = folder;
  std::error_code error;
  fs::create_directories(to, error);
  std::vector<std::string> written;
  const auto path_in = [&](const std::string &file) { return folder == "." ? fs::path(file) : to / file; };
  const std::string deck = name + ".xml";
  for (const char *const ending : {".geo", ".step"}) {
    const std::string geometry = name + ending;
    if (!fs::exists(from / geometry, error)) continue;
    copy_new(from / geometry, path_in(geometry));
    written.push_back(path_in(geometry).string());
  }
  try {
    copy_new(from / deck, path_in(deck));
  } catch (const Error &) {
    for (const std::string &file : written) fs::remove(file, error);
    throw;
  }
  written.insert(written.begin(), path_in(deck).string());
  return written;
}

std::string new_deck(const std::string &name, const std::string &folder)
{
  if (name.empty() || name == "help") return template_menu();
  const std::vector<std::string> files = write_template(name, folder);
  return "wrote " + join(files) + "\n  rpc --check --input=" + files[0] +
         "   says what rpc understands of it\n  rpc --input=" + files[0] + "           solves it\n";
}

} // namespace rpc
