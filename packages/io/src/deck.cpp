// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/deck.hpp"

#include "deck_text.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/remedies.hpp"
#include "xml_deck.hpp"
#include "yaml_deck.hpp"

#include <Teuchos_StringInputSource.hpp>
#include <Teuchos_XMLObject.hpp>
#include <Teuchos_XMLParameterListReader.hpp>
#include <Teuchos_YamlParameterListCoreHelpers.hpp>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

namespace rpc::io
{
namespace
{

using Teuchos::ParameterList;
using Teuchos::XMLObject;

/// Lines end by \n alone, whatever an editor has written.
void with_plain_line_ends(std::string &text)
{
  std::size_t to = 0;
  for (std::size_t from = 0; from < text.size(); ++from) {
    if (text[from] == '\r' && from + 1 < text.size() && text[from + 1] == '\n') continue;
    text[to++] = text[from] == '\r' ? '\n' : text[from];
  }
  text.resize(to);
}

std::string read_text(const std::string &path)
{
  const std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  RPC_REQUIRE(file, "deck: cannot open \"" << path << "\": " << std::strerror(errno));
  std::string text;
  char buffer[1 << 14];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, file.get())) text.append(buffer, count);
  RPC_REQUIRE(!std::ferror(file.get()), "deck: cannot read \"" << path << "\": " << std::strerror(errno));
  if (text.rfind("\xEF\xBB\xBF", 0) == 0) text.erase(0, 3); // a mark that some editors put before the text
  const bool utf_16 = text.rfind("\xFF\xFE", 0) == 0 || text.rfind("\xFE\xFF", 0) == 0;
  RPC_REQUIRE(!utf_16,
              "deck: \"" << path << "\" is written in UTF-16. Save it as UTF-8, the encoding of that name in editors");
  with_plain_line_ends(text);
  RPC_REQUIRE(!trimmed(text).empty(), "deck: \"" << path << "\" is empty");
  return text;
}

/// Teuchos' readers call themselves for a list within a list, and run out of stack.
constexpr int deepest = 100;

bool is_name_start(const unsigned char c)
{
  return std::isalpha(c) || c == '_';
}

/// Refuses a text with too many lists within lists. What stands in quotes does not count.
void check_depth(const std::string &path, const std::string &text, const bool yaml)
{
  int depth = 0;
  char quote = 0;
  for (std::size_t n = 0; n + 1 < text.size() && depth <= deepest; ++n) {
    const char c = text[n], next = text[n + 1];
    if (quote != 0) {
      if (c == quote) quote = 0;
      continue;
    }
    if (c == '"') quote = c;
    if (yaml)
      depth += (c == '{' || c == '[') - (c == '}' || c == ']');
    else
      depth += (c == '<' && is_name_start(next)) - (c == '<' && next == '/') - (c == '/' && next == '>');
  }
  RPC_REQUIRE(depth <= deepest, "deck: \"" << path << "\": lists within lists must not be deeper than " << deepest);
}

bool is_yaml(const std::string &path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](const unsigned char c) { return std::tolower(c); });
  return extension == ".yaml" || extension == ".yml";
}

std::vector<std::string> lines_of(const std::string &text)
{
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

constexpr const char *no_list = "it has no list of parameters. Write its name, such as deck:, and the lists below it";

/// "deck: "path", line n: reason"
[[noreturn]] void refuse(const std::string &path, const std::exception &error, const int lines_added = 0)
{
  const std::string what = error.what();
  std::smatch line;
  std::string where;
  if (std::regex_search(what, line, std::regex(R"(at line (\d+)|\(line (\d+))"))) {
    const int number = std::stoi(line[1].matched ? line[1].str() : line[2].str()) - lines_added;
    if (number > 0) where = ", line " + std::to_string(number);
  }
  std::string reason = one_line(what);
  static const std::regex anonymous(R"( in list "ANONYMOUS"$)"); // the root that a deck need not name
  reason = std::regex_replace(reason, anonymous, "");
  if (reason.empty()) reason = "it is not written as a deck is. Look for a bracket, quote or comma that is missing";
  if (reason == "Error!") reason = no_list; // of Teuchos, where a value stands in the place of a list
  static const std::regex unexpected(R"(Expected one of .*Got: (.*))");
  std::smatch got;
  if (std::regex_match(reason, got, unexpected))
    reason = "\"" + trimmed(got[1].str()) +
             "\" cannot stand where it does. Look for a comma, bracket or quote that is missing before it; a text with "
             "such signs needs quotes";
  throw Error(ExitCode::bad_input, "deck: \"" + path + "\"" + where + ": " + reason);
}

/// A double inf or nan becomes a string.
void write_infinities_as_strings(const XMLObject &xml)
{
  for (int n = 0; n < xml.numChildren(); ++n) {
    XMLObject child = xml.getChild(n);
    if (child.getTag() == "Parameter" && child.hasAttribute("type") && child.hasAttribute("value") &&
        child.getAttribute("type") == "double" && is_infinite(trimmed(child.getAttribute("value"))))
      child.addAttribute("type", "string");
    write_infinities_as_strings(child);
  }
}

ParameterList read_xml(const std::string &path, const std::string &text, const ParameterList &valid)
{
  check_depth(path, text, false);
  check_xml_deck(path, read_xml_elements(path, text), valid);
  try {
    Teuchos::StringInputSource source(text);
    const XMLObject xml = source.getObject();
    write_infinities_as_strings(xml);
    return Teuchos::XMLParameterListReader().toParameterList(xml);
  } catch (const Error &) {
    throw;
  } catch (const std::exception &error) {
    refuse(path, error);
  }
}

/// Number of names at the outermost level of a YAML text.
int count_root_names(const std::vector<std::string> &lines)
{
  static const std::regex name(R"([^\s#%-].*:(\s.*)?)");
  return static_cast<int>(
      std::count_if(lines.begin(), lines.end(), [](const std::string &line) { return std::regex_match(line, name); }));
}

/// Whether a YAML value starts at text[n]: behind a name's colon, in a list, or as an item of one.
bool starts_value(const std::string &text, const std::size_t n)
{
  const auto before = n == 0 ? std::string::npos : text.find_last_not_of(" \t", n - 1);
  if (before == std::string::npos) return false;
  if (std::strchr("[{,", text[before])) return true;
  if (before + 1 == n) return false; // no blank between
  if (text[before] != '-') return text[before] == ':';
  const auto before_item = before == 0 ? std::string::npos : text.find_last_not_of(" \t", before - 1);
  return before_item == std::string::npos || text[before_item] == '\n';
}

/// The text with `.inf`, YAML's number, written as `inf`, which Teuchos and the fields know. What stands in quotes is no
/// number.
std::string with_infinities(const std::string &text)
{
  static const std::regex number(R"(([-+]?)\.(inf|Inf|INF)(?=[ \t\r]*([,\]}\n]|$)|[ \t]+#))");
  std::string result;
  char quote = 0;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const char c = text[n];
    const bool behind_blank = n == 0 || std::strchr(" \t\r\n[{,", text[n - 1]);
    if (quote != 0) {
      if (c == quote && (quote == '\'' || text[n - 1] != '\\')) quote = 0;
    } else if (behind_blank && (c == '"' || c == '\'')) {
      quote = c;
    } else if (behind_blank && c == '#') {
      const std::size_t end = std::min(text.find('\n', n), text.size());
      result.append(text, n, end - n);
      n = end - 1;
      continue;
    } else if ((c == '.' || c == '-' || c == '+') && starts_value(text, n)) {
      std::smatch found;
      if (std::regex_search(text.begin() + n, text.end(), found, number, std::regex_constants::match_continuous)) {
        result += found[1].str() + "inf";
        n += found.length() - 1;
        continue;
      }
    }
    result += c;
  }
  return result;
}

constexpr const char *byte_mark = "~~"; // before two hexadecimal digits: Teuchos reads no letters but those of ASCII

std::string with_bytes_marked(const std::string &text)
{
  static constexpr char digits[] = "0123456789ABCDEF";
  std::string marked;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const auto c = static_cast<unsigned char>(text[n]);
    if (c < 0x80 && text.compare(n, 2, byte_mark) != 0)
      marked += text[n];
    else
      marked += byte_mark + std::string{digits[c / 16], digits[c % 16]};
  }
  return marked;
}

std::string with_bytes(const std::string &marked)
{
  std::string text;
  for (std::size_t n = 0; n < marked.size(); ++n) {
    const bool is_byte = marked.compare(n, 2, byte_mark) == 0 && n + 3 < marked.size() &&
                         std::isxdigit(static_cast<unsigned char>(marked[n + 2])) &&
                         std::isxdigit(static_cast<unsigned char>(marked[n + 3]));
    if (is_byte) {
      text += static_cast<char>(std::stoi(marked.substr(n + 2, 2), nullptr, 16));
      n += 3;
    } else {
      text += marked[n];
    }
  }
  return text;
}

/// A list with the letters that with_bytes_marked() has marked, in names and texts.
ParameterList with_bytes(const ParameterList &marked)
{
  ParameterList list(with_bytes(marked.name()));
  for (auto at = marked.begin(); at != marked.end(); ++at) {
    const std::string name = with_bytes(marked.name(at));
    const Teuchos::ParameterEntry &entry = marked.entry(at);
    if (entry.isList()) {
      list.sublist(name) = with_bytes(Teuchos::getValue<ParameterList>(entry));
      list.sublist(name).setName(list.name() + "->" + name);
    } else if (entry.isType<std::string>()) {
      list.set(name, with_bytes(Teuchos::getValue<std::string>(entry)));
    } else {
      list.setEntry(name, entry);
    }
  }
  return list;
}

/// Refuses an outermost list without entries that has those beside it that are to be its own, as a deck has whose lines have lost their blanks.
void check_outermost(const std::string &path, const ParameterList &list, const ParameterList &valid)
{
  if (list.numParams() == 0 || valid.numParams() == 0 || valid.isParameter(list.name(list.begin()))) return;
  const Teuchos::ParameterEntry &first = list.entry(list.begin());
  if (first.isList() && Teuchos::getValue<ParameterList>(first).numParams() == 0)
    refuse_line(path, 1,
                "\"" + list.name(list.begin()) +
                    "\" has no entries, for those below it are not indented. Indent them by two blanks, or remove this "
                    "line.");
}

ParameterList read_yaml(const std::string &path, const std::string &given, const ParameterList &valid)
{
  check_depth(path, given, true);
  read_yaml_lines(path, given);
  const std::string whole = with_bytes_marked(with_infinities(given));
  const std::vector<std::string> lines = lines_of(whole);
  static const std::regex nothing(R"(\s*(#.*)?|---\s*|\.\.\.\s*|%.*)");
  const auto is_nothing = [](const std::string &line) { return std::regex_match(line, nothing); };
  RPC_REQUIRE(!std::all_of(lines.begin(), lines.end(), is_nothing), "deck: \"" << path << "\": " << no_list);
  // Teuchos wants one name at the outermost level, and loses parameters without a word if there are more.
  const bool anonymous = count_root_names(lines) > 1;
  std::string text = anonymous ? "ANONYMOUS:\n" : "";
  for (const std::string &line : lines) {
    const bool marker = !line.empty() && (line == "---" || line == "..." || line[0] == '%');
    if (!anonymous)
      text += line;
    else if (!marker && !line.empty())
      text += "  " + line;
    text += "\n";
  }
  try {
    const ParameterList read = *Teuchos::getParametersFromYamlString(text);
    const bool marked = with_bytes_marked(given).size() > given.size();
    const ParameterList list = marked ? with_bytes(read) : read;
    if (anonymous) check_outermost(path, list, valid);
    return list;
  } catch (const Error &) {
    throw;
  } catch (const std::exception &error) {
    refuse(path, error, anonymous ? 1 : 0);
  }
}

/// Folder of the running program, or where it would be installed if the system does not tell.
std::filesystem::path program_folder()
{
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path(RPC_INSTALL_BIN_DIR) : program.parent_path();
}

/// Decks in a folder; none if it cannot be read.
std::vector<std::string> decks_in(const std::filesystem::path &folder)
{
  std::vector<std::string> names;
  std::error_code failed;
  for (std::filesystem::directory_iterator at(folder.empty() ? "." : folder, failed), end; !failed && at != end;
       at.increment(failed)) {
    const std::string name = at->path().filename().string();
    if (is_yaml(name) || at->path().extension() == ".xml") names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string find_file(const std::string &name)
{
  namespace fs = std::filesystem;
  std::error_code error;
  RPC_REQUIRE(!fs::is_directory(name, error), "deck: \"" << name << "\" is a folder; there is no file of that name");
  std::vector<fs::path> places = {name};
  if (!fs::path(name).is_absolute()) {
    for (const std::string &folder : deck_folders()) places.push_back(fs::path(folder) / name);
  }
  std::string searched;
  std::vector<std::string> others;
  for (const auto &place : places) {
    if (fs::exists(place, error) && !fs::is_directory(place, error)) return place.string();
    searched += (searched.empty() ? "" : ", ") + place.string();
    for (const std::string &other : decks_in(place.parent_path())) others.push_back(other);
  }
  throw Error(ExitCode::bad_input, "deck: there is no file \"" + name + "\"; searched: " + searched + "." +
                                       file_remedy(fs::path(name).filename().string(), others));
}

/// Lines of the lists and parameters of an XML deck.
void add_lines(const XmlElement &list, const std::string &path, std::map<std::string, int> &lines)
{
  for (const XmlElement &child : list.children) {
    const std::string *const name = child.attribute("name");
    if (!name) continue;
    const std::string full = path.empty() ? *name : path + "->" + *name;
    lines.emplace(full, child.line);
    add_lines(child, full, lines);
  }
}

std::map<std::string, int> lines_in(const std::string &path)
{
  const std::string text = read_text(path);
  if (is_yaml(path)) return read_yaml_lines(path, text);
  std::map<std::string, int> lines;
  add_lines(read_xml_elements(path, text), "", lines);
  return lines;
}

/// Whether a path is another one, or of a list above it or of something in it.
bool are_related(const std::string &a, const std::string &b)
{
  const std::string shorter = a.size() < b.size() ? a : b, longer = a.size() < b.size() ? b : a;
  return longer == shorter || longer.rfind(shorter + "->", 0) == 0;
}

} // namespace

std::vector<std::string> deck_folders()
{
  std::vector<std::string> folders;
  if (const char *folder = std::getenv("RPC_INPUT_DIR")) folders.push_back(folder);
  folders.push_back((program_folder() / RPC_INPUT_FROM_BIN).lexically_normal().string());
  folders.push_back(RPC_SOURCE_INPUT_DIR);
  return folders;
}

std::string find_deck(const std::string &name, const Teuchos::Comm<int> &comm)
{
  return text_of_root(comm, ExitCode::bad_input, [&] { return find_file(name); });
}

std::string with_place(const std::string &message, const std::string &path, const std::vector<std::string> &assignments)
{
  const std::string start = "deck: ";
  const std::size_t open = message.find('"'), close = message.find('"', open == std::string::npos ? open : open + 1);
  if (message.rfind(start, 0) != 0 || close == std::string::npos) return message;
  std::string parameter = message.substr(open + 1, close - open - 1);
  if (parameter == path || message.rfind("deck: there is no file", 0) == 0) return message;
  for (const std::string &assignment : assignments)
    if (are_related(parameter, assignment.substr(0, assignment.find('=')))) return message;
  std::string where = "\"" + path + "\"";
  try {
    const std::map<std::string, int> lines = lines_in(path);
    for (;;) {
      if (const auto found = lines.find(parameter); found != lines.end()) {
        where += ", line " + std::to_string(found->second);
        break;
      }
      const std::size_t arrow = parameter.rfind("->");
      if (arrow == std::string::npos) break;
      parameter.resize(arrow);
    }
  } catch (const Error &) { // it is gone, or was never read
    return message;
  }
  return start + where + ": " + message.substr(start.size());
}

ParameterList read_deck(const std::string &path, const Teuchos::Comm<int> &comm, const ParameterList &valid)
{
  const std::string text = text_of_root(comm, ExitCode::bad_input, [&] { return read_text(path); });
  return is_yaml(path) ? read_yaml(path, text, valid) : read_xml(path, text, valid);
}

} // namespace rpc::io
