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
    if (!plain_text.empty() && (plain_text.back() == '"' || plain_text.back() == '\''))
      refuse(line_, name + "=" + given + " lacks its first quote. Write " + name + "=\"" +
                        plain_text.substr(0, plain_text.size() - 1) + "\".");
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

void XmlReader::check_tag(const std::string &path, const XmlElement &element)
{
  if (element.tag == "ParameterList")
    for (const char *const wrong : {"type", "value"})
      if (element.attribute(wrong))
        refuse_line(path, element.line,
                    opening(element) + " is a list and has " + wrong + "=. Write <Parameter for a value.");
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

} // namespace rpc::io
