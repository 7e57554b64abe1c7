// SPDX-License-Identifier: BSD-3-Clause
#include "yaml_signs.hpp"

#include <algorithm>
#include <regex>

namespace rpc::io
{
namespace
{

std::string with_slashes(std::string text)
{
  std::replace(text.begin(), text.end(), '\\', '/');
  return text;
}

/// In double quotes YAML takes "\U" for one sign.
std::string wrong_escape(const std::string &path, const std::string &value)
{
  static const std::regex escape(R"(\\[A-Za-z])");
  if (value[0] != '"' || !std::regex_search(value, escape)) return "";
  return "\"" + path + "\" = " + value + " has a \\, which in double quotes makes another sign of the next. Write " +
         last_name(path) + ": " + with_slashes(value);
}

} // namespace

std::string in_quotes(const std::string &text)
{
  if (text.find_first_of("\"\\") == std::string::npos) return '"' + text + '"';
  return text.find('\'') == std::string::npos ? '\'' + text + '\'' : "";
}

std::string last_name(const std::string &path)
{
  const std::size_t arrow = path.rfind("->");
  return arrow == std::string::npos ? path : path.substr(arrow + 2);
}

std::string wrong_signs(const std::string &path, const std::string &value)
{
  static const std::regex text_below(R"([|>][-+]?\d*)"), anchor(R"([&*][A-Za-z_].*)"), variable(R"(\$\{?\w+\}?)"),
      entry_within(R"((.*?\S)\s+(["']?)([A-Za-z][A-Za-z' ]*)\2:(\s.*)?)"), drive(R"([A-Za-z]:[\\/].*)");
  constexpr std::size_t longest = 300; // of a value that a message repeats
  if (value.empty() || value.size() > longest) return "";
  if (value[0] == '"' || value[0] == '\'') return wrong_escape(path, value);
  if (value[0] == '!' || std::regex_match(value, text_below)) return "";
  const std::string what = "\"" + path + "\" = " + value, name = last_name(path);
  std::smatch found;
  if (std::regex_match(value, anchor))
    return what + " is an anchor of YAML, which no deck has. Write the value out, or in quotes if it is a text.";
  if (std::regex_search(value, found, variable))
    return what + ": " + found[0].str() + " is not replaced by a value, as a shell does. Write the value.";
  if (!std::regex_match(value, drive) && std::regex_match(value, found, entry_within))
    return what + " holds another entry, \"" + found[3].str() +
           "\": a comma is missing before it, or a new line. Write " + name + ": " + found[1].str() + ", " +
           found[3].str() + ":" + found[4].str() + " in { }, or each on its own line.";
  const auto at = value.find_first_of(":\"\\|[]{}>#!");
  if (at == std::string::npos) return "";
  if (value[at] == '"' && value.find('"', at + 1) == std::string::npos)
    return what + " has a single \". Remove it, or write one before the value too.";
  const bool is_path = std::regex_match(value, drive) || name == "File";
  const std::string quoted = in_quotes(is_path ? with_slashes(value) : value);
  return what + " has a " + value[at] + ": in YAML such a value needs quotes. Write " +
         (quoted.empty() ? "the value in quotes." : name + ": " + quoted);
}

} // namespace rpc::io
