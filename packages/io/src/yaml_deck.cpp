// SPDX-License-Identifier: BSD-3-Clause
#include "yaml_deck.hpp"

#include "deck_text.hpp"
#include "rpc/core/remedies.hpp"
#include "yaml_signs.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <regex>
#include <sstream>
#include <vector>

namespace rpc::io
{
namespace
{

/// A list that is written by indentation.
struct OpenList {
  std::string path;
  int indent = -1;         // of its name
  int entries_indent = -1; // of its entries; -1: none yet
};

std::string without_quotes(const std::string &name)
{
  const bool quoted = name.size() > 1 && (name.front() == '"' || name.front() == '\'') && name.back() == name.front();
  return quoted ? name.substr(1, name.size() - 2) : name;
}

std::string without_comment(const std::string &value)
{
  const std::size_t at = std::min(value.find(" #"), value.find("\t#"));
  return at == std::string::npos ? value : trimmed(value.substr(0, at));
}

/// Number of names at the outermost level.
int count_of_names(const std::string &text)
{
  static const std::regex name(R"([^\s#%{}\[\]-].*:(\s.*)?)");
  std::istringstream in(text);
  int count = 0;
  for (std::string line; std::getline(in, line);) count += std::regex_match(line, name) ? 1 : 0;
  return count;
}

class YamlReader
{
public:
  YamlReader(const std::string &path, const std::string &text)
      : path_(path), text_(text), has_root_(count_of_names(text) == 1)
  {
  }

  std::map<std::string, int> read()
  {
    while (at_ < text_.size()) read_line();
    return without_root();
  }

private:
  [[noreturn]] void refuse(const int line, const std::string &reason) const { refuse_line(path_, line, reason); }

  void add(const std::string &path, const int line)
  {
    const auto [found, is_new] = lines_.emplace(path, line);
    if (!is_new)
      refuse(line, "\"" + shown(path) + "\" is given twice, first in line " + std::to_string(found->second) +
                       ". Remove one of them.");
  }

  void read_line()
  {
    std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::size_t first = text_.find_first_not_of(" \t\r", at_);
    const std::string content = first < end ? trimmed(text_.substr(first, end - first)) : "";
    const bool marker =
        content == "---" || content == "..." || content[0] == '%' || content[0] == '#' || content.empty();
    if (!marker) {
      if (const auto tab = text_.find('\t', at_); tab < first)
        refuse(line_, "a tab stands before \"" + content + "\". YAML is indented by blanks: write two for each level.");
      const int indent = static_cast<int>(first - at_);
      if (skipped_indent_ >= 0 && indent > skipped_indent_) { // of a text in several lines, or of items
        if (skipped_is_plain_ && colon(first, end) != std::string::npos)
          refuse(line_, "\"" + content + "\" is indented by " + std::to_string(indent) +
                            " blanks, more than the value above it, which is no list. "
                            "Give all entries of a list the same indentation.");
        return next_line(end);
      }
      skipped_indent_ = -1;
      if (open_.size() == 1 && lines_.empty() && indent > 0)
        refuse(line_, "\"" + content +
                          "\" is indented, and no list is open. Write the name of the outermost list above it, "
                          "such as deck:");
      if (content.rfind("\u00a0", 0) == 0)
        refuse(line_, "the line begins with a blank that does not break lines, as word processors and web pages have "
                      "them. Write blanks of the keyboard.");
      if (content[0] == '-' && (content.size() == 1 || content[1] == ' ')) {
        refuse_items_with_names(content);
        skipped_indent_ = indent;
        skipped_is_plain_ = false;
        return next_line(end);
      }
      at_ = first;
      return read_entry(indent, content);
    }
    next_line(end);
  }

  void next_line(const std::size_t end)
  {
    at_ = std::min(end + 1, text_.size());
    ++line_;
  }

  /// Where the colon behind a name stands, npos if there is none before `end`.
  std::size_t colon(const std::size_t from, const std::size_t end) const
  {
    std::size_t at = from;
    if (text_[at] == '"' || text_[at] == '\'') {
      at = text_.find(text_[at], at + 1);
      if (at == std::string::npos) return at;
    }
    for (; at < end; ++at)
      if (text_[at] == ':' && (at + 1 >= text_.size() || std::isspace(static_cast<unsigned char>(text_[at + 1]))))
        return at;
    return std::string::npos;
  }

  void read_entry(const int indent, const std::string &content)
  {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    if (indent == 0 && (content[0] == '{' || content[0] == '[')) return read_flow(""); // JSON
    const std::size_t mark = colon(at_, end);
    const bool quoted = content[0] == '"' || content[0] == '\'';
    if (quoted && content.find(content[0], 1) == std::string::npos)
      refuse(line_, "the quote at the beginning of " + content +
                        " does not close. Write a second one behind the name, or none.");
    if (mark == std::string::npos || (!quoted && text_.find_first_of("{[", at_) < mark)) refuse_without_colon(content);
    const std::string written = trimmed(text_.substr(at_, mark - at_));
    if (!quoted && (written.find('"') != std::string::npos || written.find(" = ") != std::string::npos))
      refuse_without_colon(content);
    const std::string name = without_quotes(written);
    while (open_.back().indent >= indent) open_.pop_back();
    OpenList &list = open_.back();
    if (list.entries_indent >= 0 && list.entries_indent != indent)
      refuse(line_, "\"" + name + "\" is indented by " + std::to_string(indent) + " blanks, the entries above it " +
                        (list.path.empty() ? "" : "in \"" + shown(list.path) + "\" ") + "by " +
                        std::to_string(list.entries_indent) + ". Give all entries of a list the same indentation.");
    list.entries_indent = indent;
    const std::string full = list.path.empty() ? name : list.path + "->" + name;
    add(full, line_);
    open_.push_back({full, indent, -1});
    at_ = mark + 1;
    const std::size_t value = text_.find_first_not_of(" \t\r", at_);
    if (value < end && (text_[value] == '{' || text_[value] == '[')) {
      at_ = value;
      skipped_indent_ = indent;
      skipped_is_plain_ = true;
      return read_flow(full);
    }
    const std::string rest = value < end ? trimmed(text_.substr(value, end - value)) : "";
    if (!rest.empty() && rest[0] != '#') {
      skipped_indent_ = indent;
      refuse_percent(rest, full, line_);
      const bool has_quotes = rest[0] == '"' || rest[0] == '\'';
      skipped_is_plain_ = has_quotes ? rest.find(rest[0], 1) != std::string::npos : !std::strchr("|>&*!", rest[0]);
      if ((rest[0] == '"' || rest[0] == '\'') && rest.find(rest[0], 1) == std::string::npos &&
          !closes_below(rest[0], end))
        refuse(line_, "the quote of \"" + shown(full) + "\" = " + rest + " does not close. Write " + rest[0] +
                          " behind the value.");
      refuse_signs(has_quotes ? rest : without_comment(rest), full, line_);
    }
    next_line(end);
  }

  /// "- X: 0" of a list of entries, which has no items.
  void refuse_items_with_names(const std::string &content) const
  {
    static const std::regex item(R"(-\s+([A-Za-z][A-Za-z' ]*):(\s.*)?)");
    std::smatch found;
    if (std::regex_match(content, found, item))
      refuse(line_, "\"" + content + "\" has a dash. A list of parameters has none: write " + found[1].str() + ":" +
                        found[2].str());
  }

  /// YAML reads it as a mark of its own.
  void refuse_percent(const std::string &value, const std::string &path, const int line) const
  {
    if (value.empty() || std::strchr("\"'", value[0]) ||
        value.substr(0, value.find('#')).find('%') == std::string::npos)
      return;
    const std::string remedy = number_remedy(value);
    refuse(line, "\"" + shown(path) + "\" = " + value + " has a %, which no deck has outside of quotes." +
                     (remedy.empty() ? " Write a number alone, or quotes around a text." : remedy));
  }

  void refuse_signs(const std::string &value, const std::string &path, const int line) const
  {
    const std::string reason = wrong_signs(shown(path), value);
    if (!reason.empty()) refuse(line, reason);
  }

  /// What stands behind the end of a list in brackets.
  void refuse_rest(const std::string &path)
  {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string rest = trimmed(text_.substr(at_, end - at_));
    if (!rest.empty() && rest[0] != '#')
      refuse(line_, "\"" + rest.substr(0, 60) + "\" stands behind " +
                        (path.empty() ? "the end of the deck" : "the end of \"" + shown(path) + "\"") +
                        ". Remove it, or write it on a line of its own.");
  }

  bool closes_below(const char quote, const std::size_t end) const
  {
    return text_.find(quote, end) != std::string::npos;
  }

  [[noreturn]] void refuse_without_colon(const std::string &content) const
  {
    static const std::regex tight(R"(([A-Za-z][A-Za-z' ]*):(\S.*))"), equals(R"(([A-Za-z][A-Za-z' ]*?)\s*=\s*(.*))");
    static const std::regex value(R"(([A-Za-z][A-Za-z' ]*?)\s+([-+\d.\[{"].*))"),
        words(R"(([A-Za-z][A-Za-z' ]*)\s+(\S+))");
    static const std::regex unit(R"(([A-Za-z][A-Za-z' ]*?)\s*\[[^\],\d][^\],]*\]\s*:\s+(.*))");
    std::smatch found;
    if (content[0] == '*' || lines_.empty())
      if (const std::string other = other_format(lines_.empty() ? text_ : content); !other.empty())
        refuse(line_, "\"" + content + "\" is no entry, which is a name, a colon, a blank and a value. " + other);
    if (std::regex_match(content, found, unit))
      refuse(line_, "\"" + content + "\" has a unit in its name. Write " + found[1].str() + ": " + found[2].str() +
                        ", in the deck's units, see \"Units\".");
    if (std::regex_match(content, found, tight) || std::regex_match(content, found, equals) ||
        std::regex_match(content, found, value) || std::regex_match(content, found, words))
      refuse(line_, "\"" + content + "\" lacks a colon with a blank behind it. Write " + found[1].str() + ": " +
                        found[2].str());
    refuse(line_, "\"" + content + "\" is no entry, which is a name, a colon, a blank and a value. " +
                      (content[0] == '<' ? "This looks like XML: name the file .xml."
                                         : "Write it so, or put # before a comment."));
  }

  void skip_flow_blanks()
  {
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '#' && at_ > 0 && std::isspace(static_cast<unsigned char>(text_[at_ - 1])))
        at_ = std::min(text_.find('\n', at_), text_.size());
      if (at_ >= text_.size() || !std::isspace(static_cast<unsigned char>(text_[at_]))) return;
      if (text_[at_] == '\n') ++line_;
    }
  }

  /// A text up to one of the marks, quotes included; a name ends at its colon too.
  std::string read_flow_text(const char *const marks, const bool is_name = false)
  {
    skip_flow_blanks();
    const std::size_t begin = at_;
    if (at_ < text_.size() && (text_[at_] == '"' || text_[at_] == '\'')) {
      const std::size_t end = text_.find(text_[at_], at_ + 1);
      if (end == std::string::npos) refuse(line_, std::string("the quote ") + text_[at_] + " does not close.");
      line_ += static_cast<int>(std::count(text_.begin() + at_, text_.begin() + end, '\n'));
      at_ = end + 1;
      return text_.substr(begin, at_ - begin);
    }
    for (; at_ < text_.size() && !std::strchr(marks, text_[at_]) && text_[at_] != '\n'; ++at_) {
      const bool before_blank = at_ + 1 >= text_.size() || std::isspace(static_cast<unsigned char>(text_[at_ + 1]));
      if (is_name && text_[at_] == ':' && before_blank) break;
      if (text_[at_] == '#' && at_ > begin && text_[at_ - 1] == ' ') break;
    }
    return trimmed(text_.substr(begin, at_ - begin));
  }

  /// "{...}" or "[...]" at at_, and the rest of its line when it is the outermost.
  void read_flow(const std::string &path, const int depth = 0)
  {
    const int line = line_;
    const bool map = text_[at_] == '{';
    const char close = map ? '}' : ']';
    ++at_;
    std::string last; // value
    bool needs_comma = false;
    for (;;) {
      skip_flow_blanks();
      const bool lacks_comma = needs_comma && at_ < text_.size() && !std::strchr(",]}", text_[at_]);
      if (at_ >= text_.size() || lacks_comma)
        refuse(line, std::string("the \"") + (map ? "{" : "[") + "\" of \"" + shown(path) + "\" is not closed" +
                         (lacks_comma ? ", or a comma is missing in line " + std::to_string(line_) : "") + ". Write " +
                         close + " behind its last entry.");
      if (text_[at_] == close) break;
      if (text_[at_] == ',') {
        ++at_;
        needs_comma = false;
        continue;
      }
      if (text_[at_] == ']' || text_[at_] == '}')
        refuse(line_, std::string("\"") + text_[at_] + "\" does not close what is open, the \"" + (map ? "{" : "[") +
                          "\" of \"" + shown(path) + "\" of line " + std::to_string(line) + ". Write " + close + ".");
      if (map)
        last = read_flow_entry(path, last, depth);
      else if (text_[at_] == '{' || text_[at_] == '[')
        read_flow(path, depth + 1);
      else
        refuse_signs(read_flow_text(",]}"), path, line_);
      needs_comma = true;
    }
    ++at_;
    if (depth > 0) return;
    refuse_rest(path);
    next_line(std::min(text_.find('\n', at_), text_.size()));
  }

  std::string read_flow_entry(const std::string &path, const std::string &last, const int depth)
  {
    const int line = line_;
    const std::size_t begin = at_;
    const std::string name = without_quotes(read_flow_text(",]}", true));
    skip_flow_blanks();
    if (at_ >= text_.size() || text_[at_] != ':') {
      refuse_value_in_braces(path, begin, line);
      refuse_comma_within(path, last, begin, line);
      static const std::regex digits(R"(\d+([eE][-+]?\d+)?)"), number(R"([-+]?\d+)");
      const bool comma = std::regex_match(name, digits) && std::regex_match(last, number);
      refuse(line, "\"" + name + "\" in the \"{\" of \"" + shown(path) + "\" lacks a colon with a blank behind it." +
                       (comma ? " For a decimal comma write a point: " + last + "." + name +
                                    ". Several numbers stand in [" + last + ", " + name + "]."
                              : " Write " + name + ": and a value."));
    }
    ++at_;
    const std::string full = path.empty() ? name : path + "->" + name;
    add(full, line);
    skip_flow_blanks();
    if (at_ < text_.size() && (text_[at_] == '{' || text_[at_] == '[')) {
      read_flow(full, depth + 1);
      return "";
    }
    const std::string value = read_flow_text(",}");
    refuse_percent(value, full, line);
    refuse_signs(value, full, line);
    return value;
  }

  /// "{2.0, 1.0}" or "{-2*x}", which have no names.
  /// @param begin  of the first entry
  void refuse_value_in_braces(const std::string &path, const std::size_t begin, const int line) const
  {
    const std::size_t end = text_.find_first_of("}\n", begin);
    if (end == std::string::npos || text_[end] != '}' || text_[text_.find_last_not_of(' ', begin - 1)] != '{') return;
    const std::string content = trimmed(text_.substr(begin, end - begin));
    constexpr std::size_t longest = 300; // of a text that a message repeats
    if (content.size() > longest || content.find(": ") != std::string::npos) return;
    const bool several = content.find(',') != std::string::npos;
    const std::string start = "{" + content + "} of \"" + shown(path) + "\" has no names. Write " + last_name(path);
    if (several && !content.empty() && std::strchr("+-.0123456789", content[0]))
      refuse(line, start + ": [" + content + "] for a list of numbers.");
    if (!several && content.find_first_of("+-*/()0123456789") != std::string::npos)
      refuse(line, start + ": " + (content.find_first_of("*/(") == std::string::npos ? content : in_quotes(content)) +
                       " for a value.");
  }

  /// "{Y: max(x, 1)}", whose comma ends the entry.
  /// @param last   value before the comma
  /// @param begin  of what follows it
  void refuse_comma_within(const std::string &path, const std::string &last, const std::size_t begin,
                           const int line) const
  {
    const auto open = [](const std::string &text) {
      return std::count(text.begin(), text.end(), '(') - std::count(text.begin(), text.end(), ')');
    };
    constexpr std::size_t longest = 300; // of a text that a message repeats
    if (last.size() > longest || open(last) <= 0) return;
    std::string whole = last + ",";
    if (text_[begin - 1] == ' ') whole += ' ';
    for (std::size_t at = begin;
         at < text_.size() && text_[at] != '\n' && open(whole) > 0 && whole.size() < 2 * longest; ++at)
      whole += text_[at];
    refuse(line, "the comma of " + last + ", ... in the \"{\" of \"" + shown(path) +
                     "\" ends the value. A value with commas needs quotes: write " + in_quotes(whole));
  }

  std::map<std::string, int> without_root() const
  {
    std::map<std::string, int> result;
    for (const auto &[path, line] : lines_) result.emplace(shown(path), line);
    return result;
  }

  /// A path without the root's name, where the outermost list is that of the root.
  std::string shown(const std::string &path) const
  {
    const std::size_t arrow = path.find("->");
    return has_root_ && arrow != std::string::npos ? path.substr(arrow + 2) : path;
  }

  const std::string &path_, &text_;
  const bool has_root_;
  std::size_t at_ = 0;
  int line_ = 1;
  int skipped_indent_ = -1;       // lines that are indented by more go on with a value; -1: none do
  bool skipped_is_plain_ = false; // a value that ends on its line or holds no colon
  std::vector<OpenList> open_ = {OpenList{}};
  std::map<std::string, int> lines_;
};

} // namespace

std::map<std::string, int> read_yaml_lines(const std::string &path, const std::string &text)
{
  return YamlReader(path, text).read();
}

} // namespace rpc::io
