// SPDX-License-Identifier: BSD-3-Clause
#include "deck_text.hpp"

#include "rpc/core/error.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

namespace rpc::io
{
namespace
{

std::optional<double> read_double(const std::string &text)
{
  char *end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') return std::nullopt;
  return value;
}

bool reads_as_integer(const std::string &text)
{
  errno = 0;
  char *end = nullptr;
  const long long value = std::strtoll(text.c_str(), &end, 10);
  return !text.empty() && *end == '\0' && errno == 0 && value == static_cast<int>(value);
}

bool reads_as_bool(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](const unsigned char c) { return std::tolower(c); });
  static const std::set<std::string> words = {"true", "false", "yes", "no", "1", "0"};
  return words.count(text) > 0;
}

} // namespace

std::string trimmed(const std::string &text)
{
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::string list_of(const std::vector<std::string> &names)
{
  std::string text;
  for (const auto &name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool reads_as(const std::string &type, const std::string &text)
{
  if (type == "int") return reads_as_integer(text);
  if (type == "double" || type == "float") {
    const auto value = read_double(text);
    return value && std::isfinite(*value);
  }
  if (type == "bool") return reads_as_bool(text);
  return true;
}

bool array_reads_as(const std::string &type, const std::string &text)
{
  if (text.size() < 2 || text.front() != '{' || text.back() != '}') return false;
  const std::string inside = trimmed(text.substr(1, text.size() - 2));
  if (inside.empty()) return true;
  std::istringstream in(inside + ",");
  for (std::string item; std::getline(in, item, ',');)
    if (!reads_as(type, trimmed(item))) return false;
  return true;
}

bool is_infinite(const std::string &text)
{
  const auto value = read_double(text);
  return value && !std::isfinite(*value);
}

void refuse_line(const std::string &path, const int line, const std::string &reason)
{
  throw Error(ExitCode::bad_input, "deck: \"" + path + "\", line " + std::to_string(line) + ": " + reason);
}

std::string other_format(const std::string &text)
{
  static const std::vector<std::pair<std::regex, const char *>> formats = {
      {std::regex(R"(\s*\*[A-Za-z*])"),
       "This looks like an input of Abaqus or CalculiX: rpc takes its mesh alone, turned by gmsh body.inp -save -o "
       "body.msh."},
      {std::regex(R"(\s*\$MeshFormat)"), "This is a mesh of gmsh: name it in the deck, as \"Mesh->File\"."},
      {std::regex(R"(\s*ISO-10303)"), "This is a geometry in STEP: rpc --new=own-mesh writes a deck that takes one."},
      {std::regex(R"(\s*(!.*\n\s*)*/(prep7|PREP7|clear|CLEAR|batch|BATCH|title|TITLE))"),
       "This looks like an input of ANSYS, which rpc does not read."},
      {std::regex(R"(\s*(SOL\s|NASTRAN|\$.*\n|BEGIN BULK|CEND))"),
       "This looks like an input of Nastran, which rpc does not read."},
      {std::regex(R"(\s*(//.*\n\s*)*(SetFactory|Point\s*\(|Merge|Mesh\.|lc\s*=))"),
       "This looks like a geometry for gmsh: name it in the deck, as \"Mesh->File\"."},
      {std::regex(R"(\s*\[)"), "This looks like an input of MOOSE or an ini file, which rpc does not read."},
      {std::regex(R"(\s*(#.*\n\s*)*(subsection|set)\s)"),
       "This looks like a parameter file of deal.II, which rpc does not read."},
      {std::regex(R"(\s*(import|from)\s)"), "This looks like a program in Python."},
  };
  const std::string head = text.substr(0, 2000); // std::regex takes stack with the length
  for (const auto &[format, remedy] : formats)
    if (std::regex_search(head, format, std::regex_constants::match_continuous)) return remedy;
  return "";
}

std::string format_remedy(const std::string &text)
{
  static const std::regex json(R"(\s*\{)"), yaml(R"(\s*(#.*\n\s*|---\s*\n)*[A-Za-z][^<>\n]*:\s)");
  if (const std::string other = other_format(text); !other.empty()) return other;
  const std::string head = text.substr(0, 2000);
  if (std::regex_search(head, json, std::regex_constants::match_continuous))
    return "This looks like JSON, which is read as YAML: name the file .yaml.";
  if (std::regex_search(head, yaml, std::regex_constants::match_continuous))
    return "This looks like YAML: name the file .yaml.";
  return "A deck in XML begins with <ParameterList name=\"...\">; rpc --new writes one to start from.";
}

} // namespace rpc::io
