// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace rpc
{

/// A commented deck to start from.
struct Template {
  std::string name; ///< "hertz-3d"
  std::string line; ///< what it is, in one line
};

/// The templates that come with rpc, by name: in templates/ of the folder of its decks.
/// @throws rpc::Error (bad_input) where that folder is not there, naming the places searched
std::vector<Template> templates();

/// What --new prints: a line for each template.
std::string template_menu();

/// Writes the deck of a template, and its geometry if it has one, into a folder, which is made if missing.
/// @return their paths, the deck first
/// @throws rpc::Error (bad_input) on an unknown name, on a file that is there already, and where nothing can be written
std::vector<std::string> write_template(const std::string &name, const std::string &folder);

/// What --new does: writes a template, or lists them.
/// @param name  of the template; empty or help: the menu
/// @return what the console gets
std::string new_deck(const std::string &name, const std::string &folder);

} // namespace rpc
