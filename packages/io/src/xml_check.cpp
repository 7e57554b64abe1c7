// SPDX-License-Identifier: BSD-3-Clause
#include "deck_text.hpp"
#include "rpc/core/remedies.hpp"
#include "xml_deck.hpp"

#include <algorithm>
#include <regex>
#include <set>

namespace rpc::io
{
namespace
{

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

/// What Teuchos writes besides, and reads nothing of.
const std::vector<std::string> silent_attributes = {"id", "isDefault", "isUsed", "docString", "validatorId"};

/// Refuses attributes that nothing reads, such as unit="MPa". Slips for those that are read have a message of their own.
void check_attributes(const std::string &file, const XmlElement &element, const std::string &what)
{
  for (const auto &[name, value] : element.attributes) {
    if (is_one_of_these(name, deck_attributes) || is_one_of_these(name, silent_attributes) ||
        name.rfind("xmlns", 0) == 0 || name.rfind("xsi:", 0) == 0)
      continue;
    static const std::regex unit("units?|Units?|dimension|dim");
    refuse_line(file, element.line,
                what + " has " + name + "=\"" + value + "\", which is not read." +
                    (std::regex_match(name, unit) ? " Remove it: numbers count in the deck's units, see \"Units\"."
                                                  : " Remove it: a parameter has name=, type= and value=."));
  }
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
  check_attributes(file, element, what);
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

void check_xml_deck(const std::string &path, const XmlElement &root, const Teuchos::ParameterList &valid)
{
  check_tags(path, root, true);
  check_elements(path, root, "", valid);
}

} // namespace rpc::io
