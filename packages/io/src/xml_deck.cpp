// SPDX-License-Identifier: BSD-3-Clause
#include "xml_deck.hpp"

#include "deck_text.hpp"
#include "rpc/core/error.hpp"
#include "rpc/core/remedies.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <regex>
#include <set>

namespace rpc::io
{
namespace
{

bool is_name_character(const char c)
{
  return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("_-.:", c);
}

/// <ParameterList name="Mesh">, as the deck has it, without what else it may hold.
std::string opening(const XmlElement &element)
{
  const std::string *const name = element.attribute("name");
  return "<" + element.tag + (name ? " name=\"" + *name + "\"" : "") + ">";
}

/// Reads tags one after another; the elements that are open stand in a row.
class XmlReader
{
public:
  XmlReader(const std::string &path, const std::string &text) : path_(path), text_(text) {}

  XmlElement read()
  {
    while (at_ < text_.size()) {
      if (text_[at_] != '<')
        read_words();
      else if (starts("<!--"))
        skip_comment();
      else if (starts("<![CDATA["))
        skip("]]>", "CDATA section");
      else if (starts("<?"))
        skip("?>", "declaration");
      else if (starts("<!DOCTYPE"))
        skip(">", "declaration");
      else if (starts("<!"))
        refuse(line_, "\"" + text_.substr(at_, text_.find_first_of("\n>", at_) - at_) +
                          "\" is no comment and no tag. Write a comment as <!-- ... -->.");
      else if (starts("</"))
        read_closing();
      else
        read_opening();
    }
    if (!open_.empty()) refuse_unclosed();
    if (!has_root_) refuse(1, "holds no <ParameterList>. " + format_remedy(text_));
    return root_;
  }

private:
  [[noreturn]] void refuse(const int line, const std::string &reason) const { refuse_line(path_, line, reason); }

  bool starts(const char *const mark) const { return text_.compare(at_, std::strlen(mark), mark) == 0; }

  void advance(const std::size_t count)
  {
    for (std::size_t n = 0; n < count; ++n, ++at_) {
      if (text_[at_] != '\n') continue;
      ++line_;
      line_start_ = at_ + 1;
    }
  }

  void skip_blanks()
  {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) advance(1);
  }

  void skip(const char *const end, const std::string &what)
  {
    const std::size_t found = text_.find(end, at_ + 2);
    if (found == std::string::npos)
      refuse(line_, "the " + what + " that begins here does not end. Write " + end + " behind it.");
    advance(found + std::strlen(end) - at_);
  }

  /// A comment that is not ended would reach to the end of the next one, and the lists between would be lost.
  void skip_comment()
  {
    const std::size_t end = text_.find("-->", at_ + 4), next = text_.find("<!--", at_ + 4);
    if (next < end) {
      const auto lines = std::count(text_.begin() + at_, text_.begin() + next, '\n');
      refuse(line_, "the comment that begins here does not end before the next one, of line " +
                        std::to_string(line_ + lines) + ". Write --> behind it.");
    }
    skip("-->", "comment");
  }

  /// Between tags there are to be blanks only.
  void read_words()
  {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] == '<') return;
    const std::size_t end = std::min(text_.find_first_of("<\n", at_), text_.size());
    const std::string words = trimmed(text_.substr(at_, end - at_));
    if (!has_root_ && open_.empty()) refuse(line_, "\"" + words + "\" is no XML. " + format_remedy(text_));
    if (!open_.empty() && open_.back().tag != "ParameterList" && open_.back().tag != "Parameter") {
      const XmlElement &element = open_.back(); // <Side>bottom</Side>
      refuse(element.line, "a deck has no tag <" + element.tag + ">. Write <Parameter name=\"" + element.tag +
                               "\" type=\"string\" value=\"" + words + "\"/>.");
    }
    refuse(line_, "\"" + words +
                      "\" stands between tags, where nothing is read. Write a value as value=\"...\", a comment as "
                      "<!-- ... -->, or "
                      "remove it.");
  }

  std::string read_name()
  {
    const std::size_t start = at_;
    while (at_ < text_.size() && is_name_character(text_[at_])) ++at_;
    return text_.substr(start, at_ - start);
  }

  void read_opening()
  {
    XmlElement element;
    element.line = line_;
    element.column = static_cast<int>(at_ - line_start_);
    advance(1);
    element.tag = read_name();
    if (element.tag.empty()) refuse(line_, "a name is missing behind \"<\". In a value write &lt; for \"<\".");
    if (open_.empty() && has_root_)
      refuse(line_, opening(element) + " begins behind the end of the deck, which is one <ParameterList>. Remove a "
                                       "closing tag before it, or put it into the list.");
    bool closes = false;
    for (;;) {
      skip_blanks();
      if (at_ >= text_.size())
        refuse(element.line, "<" + element.tag + " does not end. Write \"/>\" or \">\" behind it.");
      if (text_[at_] == '>') break;
      if (starts("/>")) {
        closes = true;
        break;
      }
      if (text_[at_] == '<')
        refuse(element.line, "<" + element.tag + " does not end before the next tag. Write \"" +
                                 (element.tag == "Parameter" ? "/>" : ">") + "\" behind it.");
      read_attribute(element);
    }
    advance(closes ? 2 : 1);
    check_tag(path_, element);
    open_.push_back(element);
    if (closes) close_last();
  }

  void read_attribute(XmlElement &element)
  {
    const int line = line_;
    const std::string name = read_name();
    if (name.empty()) {
      const std::size_t end = std::min(text_.find_first_of(" \n>", at_ + 1), text_.size());
      refuse(line_, "\"" + text_.substr(at_, end - at_) + "\" in the tag " + opening(element) + " is not read. " +
                        attribute_rule);
    }
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != '=')
      refuse(line, "\"" + name + "\" in the tag " + opening(element) + " needs a value: " + name + "=\"...\".");
    advance(1);
    skip_blanks();
    const char quote = at_ < text_.size() ? text_[at_] : ' ';
    if (quote != '"' && quote != '\'') refuse_unquoted(name);
    advance(1);
    const int begin = line_;
    std::string value;
    while (at_ < text_.size() && text_[at_] != quote) {
      if (text_[at_] == '<') refuse_open_value(name, begin, value, quote);
      value += text_[at_] == '&' ? read_entity(name) : std::string(1, text_[at_]);
      advance(1);
    }
    if (at_ >= text_.size()) refuse_open_value(name, begin, value, quote);
    advance(1);
    for (const auto &other : element.attributes)
      if (other.first == name) refuse(line, "the tag " + opening(element) + " has " + name + "= twice. Remove one.");
    element.attributes.emplace_back(name, value);
  }

  [[noreturn]] void refuse_unquoted(const std::string &name) const
  {
    std::size_t end = std::min(text_.find_first_of(" \n/>", at_), text_.size());
    std::string given = text_.substr(at_, end - at_), plain_text = given;
    for (const char *const mark : {"\u201c", "\u201d", "\u201e", "\u00ab", "\u00bb", "\u2019", "\u2018"})
      for (auto found = plain_text.find(mark); found != std::string::npos; found = plain_text.find(mark))
        plain_text.erase(found, std::strlen(mark));
    refuse(line_, name + "=" + given + (plain_text != given ? " has typographic quotes" : " has no quotes") +
                      ". Write " + name + "=\"" + plain_text + "\".");
  }

  /// A "<" or the end comes before the closing quote: it is missing, or "<" stands in an expression.
  [[noreturn]] void refuse_open_value(const std::string &name, const int line, const std::string &value,
                                      const char quote) const
  {
    const std::string first = trimmed(value.substr(0, value.find_first_of("\n")));
    const bool one_line = value.find('\n') == std::string::npos;
    const std::size_t end_of_line = std::min(text_.find('\n', at_), text_.size());
    const bool closes_later = one_line && text_.find(quote, at_) < end_of_line;
    if (closes_later && value.find("/>") == std::string::npos) {
      std::string whole = value + text_.substr(at_, text_.find(quote, at_) - at_);
      for (auto mark = whole.find('<'); mark != std::string::npos; mark = whole.find('<'))
        whole.replace(mark, 1, "&lt;");
      refuse(line, "in a value of XML \"<\" is written &lt;. Write " + name + "=\"" + whole + "\".");
    }
    refuse(line,
           "the quote of " + name + "=" + quote + first + " does not close. Write " + quote + " behind the value.");
  }

  /// The character of "&lt;"; at_ goes to its last one.
  std::string read_entity(const std::string &attribute)
  {
    const std::size_t end = text_.find(';', at_);
    const std::string name = end == std::string::npos || end - at_ > 10 ? "" : text_.substr(at_ + 1, end - at_ - 1);
    static const std::vector<std::pair<std::string, std::string>> known = {
        {"lt", "<"}, {"gt", ">"}, {"amp", "&"}, {"quot", "\""}, {"apos", "'"}};
    const auto found = std::find_if(known.begin(), known.end(), [&](const auto &each) { return each.first == name; });
    const bool numbered = name.size() > 1 && name[0] == '#';
    if (found == known.end() && !numbered)
      refuse(line_, "in " + attribute + "=\"...\" \"&\" is written &amp;, and \"&&\" of an expression &amp;&amp;.");
    at_ = end;
    return numbered ? "?" : found->second;
  }

  void read_closing()
  {
    const int line = line_;
    const int column = static_cast<int>(at_ - line_start_);
    advance(2);
    const std::string tag = read_name();
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != '>') refuse(line, "</" + tag + " does not end. Write </" + tag + ">.");
    advance(1);
    if (open_.empty())
      refuse(line, "</" + tag + "> closes nothing. Remove it, or look for a closing tag too many above.");
    const XmlElement &last = open_.back();
    if (last.tag != tag) {
      const std::string where = opening(last) + " of line " + std::to_string(last.line);
      if (last.tag == "Parameter")
        refuse(last.line, opening(last) + " is not closed when </" + tag + "> of line " + std::to_string(line) +
                              " comes. End it with \"/>\".");
      const std::string meant = last.tag == "ParameterList" ? "" : did_you_mean(last.tag, {tag});
      refuse(line, "</" + tag + "> does not close what is open, " + where + "." +
                       (meant.empty() ? " Write </" + last.tag + ">." : meant));
    }
    if (column != last.column && last.line != line && suspect_line_ == 0) { // a closing tag is missing or too many
      suspect_line_ = last.line;
      suspect_ = opening(last);
    }
    close_last();
  }

  void close_last()
  {
    XmlElement element = open_.back();
    open_.pop_back();
    if (!open_.empty()) {
      open_.back().children.push_back(std::move(element));
      return;
    }
    root_ = std::move(element);
    has_root_ = true;
  }

  [[noreturn]] void refuse_unclosed() const
  {
    std::string lists;
    for (const XmlElement &each : open_)
      lists += (lists.empty() ? "" : ", ") + opening(each) + " of line " + std::to_string(each.line);
    std::string guess;
    if (suspect_line_ > 0 && suspect_line_ != open_.back().line)
      guess = " By the indentation it is " + suspect_ + " of line " + std::to_string(suspect_line_) +
              " that is not closed.";
    refuse(line_, "the file ends while " + lists + (open_.size() == 1 ? " is" : " are") + " open. Write </" +
                      open_.back().tag + "> where " + (open_.size() == 1 ? "it" : "each") + " ends." + guess);
  }

  const std::string &path_, &text_;
  std::size_t at_ = 0, line_start_ = 0;
  int line_ = 1;
  std::vector<XmlElement> open_;
  XmlElement root_;
  bool has_root_ = false;
  std::string suspect_; // an element that closes at another column than it opens at
  int suspect_line_ = 0;

  static constexpr const char *attribute_rule = "A parameter is <Parameter name=\"...\" type=\"...\" value=\"...\"/>.";

  static void check_tag(const std::string &path, const XmlElement &element);
};

const std::vector<std::string> deck_tags = {"ParameterList", "Parameter"};
const std::vector<std::string> deck_attributes = {"name", "type", "value"};
const std::vector<std::string> deck_types = {"double",        "int",        "string",       "bool",
                                             "Array(double)", "Array(int)", "Array(string)"};
/// What Teuchos reads besides.
const std::vector<std::string> other_types = {
    "float", "short",         "unsigned short",         "unsigned int", "unsigned long",
    "long",  "long long int", "unsigned long long int", "char",         "Array(float)"};
const std::vector<std::string> other_tags = {"Validators", "Validator", "Dependencies", "Dependency"};

bool is_one_of_these(const std::string &text, const std::vector<std::string> &names)
{
  return std::find(names.begin(), names.end(), text) != names.end();
}

void XmlReader::check_tag(const std::string &path, const XmlElement &element)
{
  if (element.tag == "ParameterList")
    for (const char *const wrong : {"type", "value"})
      if (element.attribute(wrong))
        refuse_line(path, element.line,
                    opening(element) + " is a list and has " + wrong + "=. Write <Parameter for a value.");
}

void check_tags(const std::string &path, const XmlElement &element, const bool root)
{
  if (root && element.tag != "ParameterList")
    refuse_line(path, element.line,
                "expected tag ParameterList first, got <" + element.tag + ">. A deck is " +
                    "<ParameterList name=\"...\"> ... </ParameterList>." +
                    did_you_mean(element.tag, {"ParameterList"}));
  if (!is_one_of_these(element.tag, deck_tags))
    refuse_line(path, element.line,
                "a deck has no tag <" + element.tag + ">, but <ParameterList> for lists and " +
                    "<Parameter> for values." + did_you_mean(element.tag, deck_tags));
}

std::string example_type(const std::string &value)
{
  if (value.empty()) return "string";
  if (value.front() == '{') return "Array(double)";
  if (value == "true" || value == "false") return "bool";
  return reads_as("int", value) ? "int" : reads_as("double", value) ? "double" : "string";
}

/// What a parameter's tag needs, and its value's type.
void check_parameter(const std::string &file, const XmlElement &element, const std::string &path,
                     const Teuchos::ParameterList &valid)
{
  const std::string what = path.empty() ? "the parameter" : "\"" + path + "\"";
  for (const std::string &needed : deck_attributes) {
    if (element.attribute(needed)) continue;
    std::string meant;
    for (const auto &given : element.attributes)
      if (!is_one_of_these(given.first, deck_attributes) && !did_you_mean(given.first, {needed}).empty())
        meant = " For " + given.first + "=\"" + given.second + "\" write " + needed + "=\"" + given.second + "\".";
    const std::string *const value = element.attribute("value");
    refuse_line(file, element.line,
                what + " has no " + needed + "=. " +
                    (!meant.empty()     ? meant.substr(1)
                     : needed == "type" ? "Write type=\"" + example_type(value ? trimmed(*value) : "") + "\"."
                                        : "Write " + needed + "=\"...\"."));
  }
  const std::string type = *element.attribute("type");
  const std::string value = trimmed(*element.attribute("value"));
  if (!is_one_of_these(type, deck_types) && !is_one_of_these(type, other_types) && type.rfind("TwoDArray", 0) != 0)
    refuse_line(file, element.line,
                what + " has the unknown type \"" + type + "\". Types are " + list_of(deck_types) + "." +
                    did_you_mean(type, deck_types));
  static const std::regex array(R"(Array\((.*)\))");
  std::smatch item;
  if (std::regex_match(type, item, array)) {
    if (!array_reads_as(item[1], value))
      refuse_line(file, element.line,
                  what + " = \"" + value + "\" does not read as " + type + ", such as {0, 1}." +
                      (item[1] == "string"          ? ""
                       : axis_remedy(value).empty() ? array_remedy(value, item[1] == "int")
                                                    : axis_remedy(value)));
    return;
  }
  if (type == "double" && is_infinite(value)) return;
  if (reads_as(type, value)) return;
  const Wanted wanted = wanted_of(valid, path);
  const bool only_number = wanted.expression && !*wanted.expression;
  const std::string remedy = type == "int"    ? integer_remedy(value)
                             : type == "bool" ? bool_remedy(value)
                                              : number_remedy(value, wanted);
  static const std::regex words(R"([A-Za-z_][A-Za-z_ ]*)"), list(R"(\{.*\})");
  const std::string other = std::regex_match(value, list)    ? " For a list write type=\"Array(" + type + ")\"."
                            : only_number && !value.empty()  ? " Write a number: this parameter takes no expressions."
                            : std::regex_match(value, words) ? " For a word write type=\"string\"."
                            : value.empty()                  ? " Write a value, or remove the parameter."
                            : remedy.empty()                 ? " For an expression write type=\"string\"."
                                                             : "";
  refuse_line(file, element.line,
              what + " = \"" + value + "\" does not read as " + type + "." + (remedy.empty() ? other : remedy));
}

void check_elements(const std::string &file, const XmlElement &list, const std::string &path,
                    const Teuchos::ParameterList &valid)
{
  std::set<std::string> names;
  for (const XmlElement &child : list.children) {
    if (is_one_of_these(child.tag, other_tags)) continue; // Teuchos' own
    check_tags(file, child, false);
    const std::string *const name = child.attribute("name");
    if (!name) {
      if (child.tag == "Parameter") check_parameter(file, child, "", valid);
      refuse_line(file, child.line,
                  "<ParameterList> in " + (path.empty() ? "the deck" : "\"" + path + "\"") +
                      " has no name. Write <ParameterList name=\"...\">.");
    }
    const std::string full = path.empty() ? *name : path + "->" + *name;
    if (!names.insert(*name).second)
      refuse_line(file, child.line, "\"" + full + "\" is given twice. Remove one of them.");
    if (child.tag == "ParameterList")
      check_elements(file, child, full, valid);
    else if (!child.children.empty())
      refuse_line(file, child.line,
                  "\"" + full +
                      "\" is a <Parameter> with tags in it. End it with \"/>\", or write "
                      "<ParameterList> for a list.");
    else
      check_parameter(file, child, full, valid);
  }
}

} // namespace

const std::string *XmlElement::attribute(const std::string &name) const
{
  for (const auto &each : attributes)
    if (each.first == name) return &each.second;
  return nullptr;
}

XmlElement read_xml_elements(const std::string &path, const std::string &text)
{
  return XmlReader(path, text).read();
}

void check_xml_deck(const std::string &path, const XmlElement &root, const Teuchos::ParameterList &valid)
{
  check_tags(path, root, true);
  check_elements(path, root, "", valid);
}

} // namespace rpc::io
