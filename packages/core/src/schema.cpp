// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/schema.hpp"

#include "parameter_kinds.hpp"
#include "rpc/core/parameters.hpp"
#include "unknown_name.hpp"

#include <cmath>
#include <cstdio>
#include <vector>

namespace rpc
{
namespace
{

/// A text in quotes, as JSON has it.
std::string json_text(const std::string &text)
{
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
      result += code;
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string json_texts(const std::vector<std::string> &texts)
{
  std::string result;
  for (const std::string &text : texts) result += (result.empty() ? "" : ", ") + json_text(text);
  return result;
}

bool is_true_or_false(const std::string &word)
{
  return word == "true" || word == "false";
}

/// What a value is: "\"type\": \"integer\"" and the like.
std::string json_type(const ParameterEntry &entry)
{
  const auto array_of = [](const std::string &items) {
    return "\"type\": \"array\", \"items\": {\"type\": " + items + "}";
  };
  const std::string number_or_text = R"(["number", "string"])";
  if (const ChoiceValidator *const choice = choice_of(entry)) {
    std::string words = json_texts(choice->words());
    bool has_bool = choice->has_switch();
    for (const std::string &word : choice->words()) has_bool |= is_true_or_false(word);
    if (has_bool) words += ", true, false"; // what YAML makes of true and false
    return "\"enum\": [" + words + "]";
  }
  if (is_field(entry)) return "\"type\": " + number_or_text;
  if (is_fields(entry)) return array_of(number_or_text);
  if (entry.isType<int>()) return R"("type": "integer")";
  if (entry.isType<double>()) return R"("type": "number")";
  if (entry.isType<bool>()) return R"("type": "boolean")";
  if (entry.isType<Array<int>>()) return array_of(R"("integer")");
  if (entry.isType<Array<double>>()) return array_of(R"("number")");
  if (entry.isType<Array<std::string>>()) return array_of(R"("string")");
  return R"("type": "string")";
}

/// A default that JSON can write; empty for others.
std::string json_default(const ParameterEntry &entry)
{
  if (entry.isType<bool>() || entry.isType<int>()) return text_of(entry);
  if (entry.isType<double>()) return std::isfinite(Teuchos::getValue<double>(entry)) ? text_of(entry) : "";
  if (entry.isType<std::string>()) return json_text(text_of(entry));
  return "";
}

std::string json_list(const ParameterList &list, const std::string &doc, const std::string &indent)
{
  const std::string described = doc.empty() ? "" : ", \"description\": " + json_text(doc);
  if (list.isParameter(pass_through)) return "{\"type\": \"object\"" + described + "}";
  if (list.isSublist(any_entry))
    return "{\"type\": \"object\"" + described + ", \"additionalProperties\": " +
           json_list(list.sublist(any_entry), list.getEntry(any_entry).docString(), indent) + "}";
  std::string properties;
  for (const std::string &name : names_of(list)) {
    const ParameterEntry &entry = list.getEntry(name);
    std::string content;
    if (entry.isList()) {
      content = json_list(list.sublist(name), entry.docString(), indent + "  ");
    } else {
      const std::string value = json_default(entry);
      content = "{" + json_type(entry) + ", \"description\": " + json_text(entry.docString()) +
                (value.empty() ? "" : ", \"default\": " + value) + "}";
    }
    properties += (properties.empty() ? "\n" : ",\n") + indent + "  " + json_text(name) + ": " + content;
  }
  return "{\"type\": \"object\"" + described + ", \"additionalProperties\": false, \"properties\": {" + properties +
         "}}";
}

std::string xml_text(const std::string &text)
{
  std::string result;
  for (const char c : text)
    result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  return result;
}

/// Attributes "type" and "value" of a parameter.
std::string typed(const std::string &type, const std::string &value)
{
  return "<group><attribute name=\"type\"><value>" + type + "</value></attribute><attribute name=\"value\">" + value +
         "</attribute></group>";
}

/// The ways to write a value, each with its type.
std::string xml_values(const ParameterEntry &entry)
{
  const std::string number = "<data type=\"double\"/>", whole = "<data type=\"int\"/>", any = "<text/>";
  const std::string logical = "<choice><value>true</value><value>false</value></choice>";
  const std::string braces = R"(<data type="string"><param name="pattern">\s*\{[^\}]*\}\s*</param></data>)";
  std::vector<std::string> ways;
  if (const ChoiceValidator *const choice = choice_of(entry)) {
    std::string words;
    bool has_bool = choice->has_switch();
    for (const std::string &word : choice->words()) {
      words += "<value>" + xml_text(word) + "</value>";
      has_bool |= is_true_or_false(word);
    }
    ways.push_back(typed("string", "<choice>" + words + "</choice>"));
    if (has_bool) ways.push_back(typed("bool", logical));
  } else if (is_field(entry)) {
    ways = {typed("double", any), typed("int", whole), typed("string", any)};
  } else if (is_fields(entry)) {
    ways = {typed("Array(double)", braces), typed("Array(int)", braces), typed("Array(string)", braces)};
  } else if (entry.isType<int>()) {
    ways = {typed("int", whole)};
  } else if (entry.isType<double>()) {
    ways = {typed("double", number), typed("int", whole)};
  } else if (entry.isType<bool>()) {
    ways = {typed("bool", logical)};
  } else if (entry.isType<Array<int>>()) {
    ways = {typed("Array(int)", braces)};
  } else if (entry.isType<Array<double>>()) {
    ways = {typed("Array(double)", braces), typed("Array(int)", braces)};
  } else if (entry.isType<Array<std::string>>()) {
    ways = {typed("Array(string)", braces)};
  } else {
    ways = {typed("string", any)};
  }
  std::string all;
  for (const std::string &way : ways) all += way;
  return ways.size() == 1 ? all : "<choice>" + all + "</choice>";
}

std::string xml_name(const std::string &name)
{
  return name == any_entry
             ? "<attribute name=\"name\"/>"
             : "<attribute name=\"name\"><value type=\"string\">" + xml_text(name) + "</value></attribute>";
}

std::string documentation(const std::string &doc)
{
  return doc.empty() ? "" : "<a:documentation>" + xml_text(doc) + "</a:documentation>";
}

/// What a list may hold.
std::string xml_contents(const ParameterList &list, const std::string &indent)
{
  if (list.isParameter(pass_through)) return indent + "<ref name=\"anything\"/>\n";
  std::string choices;
  for (const std::string &name : names_of(list)) {
    const ParameterEntry &entry = list.getEntry(name);
    if (entry.isList())
      choices += indent + "  <element name=\"ParameterList\">" + documentation(entry.docString()) + xml_name(name) +
                 "\n" + xml_contents(list.sublist(name), indent + "    ") + indent + "  </element>\n";
    else
      choices += indent + "  <element name=\"Parameter\">" + documentation(entry.docString()) + xml_name(name) +
                 xml_values(entry) + "</element>\n";
  }
  return indent + "<zeroOrMore><choice>\n" + choices + indent + "</choice></zeroOrMore>\n";
}

} // namespace

std::string json_schema(const ParameterList &valid)
{
  return "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": \"Deck of rpc\",\n"
         "  \"description\": \"Contact of an elastic body with a rigid-plastic foundation. The deck may stand in a "
         "list of any "
         "one name.\",\n  \"if\": {\"maxProperties\": 1, \"not\": {\"propertyNames\": {\"enum\": [" +
         json_texts(names_of(valid)) +
         "]}}},\n  \"then\": {\"additionalProperties\": {\"$ref\": \"#/$defs/deck\"}},\n"
         "  \"else\": {\"$ref\": \"#/$defs/deck\"},\n  \"$defs\": {\n    \"deck\": " +
         json_list(valid, "", "    ") + "\n  }\n}\n";
}

std::string relax_ng_schema(const ParameterList &valid)
{
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<grammar xmlns=\"http://relaxng.org/ns/structure/1.0\"\n"
         "         xmlns:a=\"http://relaxng.org/ns/compatibility/annotations/1.0\"\n"
         "         datatypeLibrary=\"http://www.w3.org/2001/XMLSchema-datatypes\">\n"
         "  <start>\n    <element name=\"ParameterList\"><optional><attribute name=\"name\"/></optional>\n" +
         xml_contents(valid, "      ") +
         "    </element>\n  </start>\n"
         "  <define name=\"anything\">\n    <zeroOrMore><choice>\n"
         "      <element name=\"ParameterList\"><attribute name=\"name\"/><ref name=\"anything\"/></element>\n"
         "      <element name=\"Parameter\"><attribute name=\"name\"/><attribute name=\"type\"/><attribute "
         "name=\"value\"/></element>\n    </choice></zeroOrMore>\n  </define>\n</grammar>\n";
}

} // namespace rpc
