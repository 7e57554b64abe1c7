// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/parameters.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_ParameterEntryValidator.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>

namespace rpc
{
namespace
{

using Teuchos::Array;
using Teuchos::ParameterEntry;
using Teuchos::ParameterList;

constexpr const char *any_entry = "*";     // template of user-named sublists
constexpr const char *pass_through = "**"; // content is read by a library

/// Marks a parameter as a field. Teuchos asks a validator for more than its rule; the rule itself is in validate().
class FieldValidator : public Teuchos::ParameterEntryValidator
{
public:
  const std::string getXMLTypeName() const override { return "field"; }
  void printDoc(const std::string &doc, std::ostream &out) const override { out << doc; }
  ValidStringsList validStringValues() const override { return Teuchos::null; }
  void validate(const ParameterEntry &, const std::string &, const std::string &) const override {}
};

/// Marks a parameter as a choice among words; true and false stand for the first and the last.
class ChoiceValidator : public Teuchos::ParameterEntryValidator
{
public:
  explicit ChoiceValidator(std::vector<std::string> words) : words_(std::move(words)) {}
  const std::string getXMLTypeName() const override { return "choice"; }
  void printDoc(const std::string &doc, std::ostream &out) const override { out << doc; }
  ValidStringsList validStringValues() const override { return Teuchos::null; }
  void validate(const ParameterEntry &, const std::string &, const std::string &) const override {}

  const std::vector<std::string> &words() const { return words_; }
  /// The word that is meant; none if it is not among them.
  std::optional<std::string> word_of(const std::string &text) const
  {
    if (text == "true") return words_.front();
    if (text == "false") return words_.back();
    if (std::find(words_.begin(), words_.end(), text) == words_.end()) return std::nullopt;
    return text;
  }

private:
  std::vector<std::string> words_;
};

const ChoiceValidator *choice_of(const ParameterEntry &entry)
{
  return dynamic_cast<const ChoiceValidator *>(entry.validator().get());
}

bool has_field_validator(const ParameterEntry &entry)
{
  return dynamic_cast<const FieldValidator *>(entry.validator().get()) != nullptr;
}
bool is_fields(const ParameterEntry &entry)
{
  return has_field_validator(entry) && entry.isType<Array<std::string>>();
}
bool is_field(const ParameterEntry &entry)
{
  return has_field_validator(entry) && !is_fields(entry);
}

std::string quoted(const std::string &path, const std::string &name)
{
  return "\"" + (path.empty() ? name : path + "->" + name) + "\"";
}

std::string type_name(const ParameterEntry &entry)
{
  if (entry.isList()) return "sublist";
  if (is_field(entry)) return "number or expression";
  if (is_fields(entry)) return "array of numbers or expressions";
  if (entry.isType<int>()) return "int";
  if (entry.isType<double>()) return "double";
  if (entry.isType<bool>()) return "bool";
  if (entry.isType<std::string>()) return "string";
  if (entry.isType<Array<int>>()) return "array of int";
  if (entry.isType<Array<double>>()) return "array of double";
  if (entry.isType<Array<std::string>>()) return "array of string";
  return entry.getAny(false).typeName();
}

/// `value` as an entry of the same type as `model`, where C++ and XML habits make that harmless: 1 for 1.0.
std::optional<ParameterEntry> converted(const ParameterEntry &value, const ParameterEntry &model)
{
  if (is_field(model)) {
    if (value.isType<int>() || value.isType<double>() || value.isType<std::string>()) return value;
    return std::nullopt;
  }
  if (const ChoiceValidator *const choice = choice_of(model)) {
    const bool is_bool = value.isType<bool>();
    if (!is_bool && !value.isType<std::string>()) return std::nullopt;
    const auto word = choice->word_of(is_bool ? (Teuchos::getValue<bool>(value) ? "true" : "false")
                                              : Teuchos::getValue<std::string>(value));
    if (!word) return std::nullopt;
    return ParameterEntry(*word);
  }
  if (is_fields(model) && (value.isType<Array<int>>() || value.isType<Array<double>>())) return value;
  if (value.getAny(false).type() == model.getAny(false).type()) return value;
  if (model.isType<double>() && value.isType<int>())
    return ParameterEntry(static_cast<double>(Teuchos::getValue<int>(value)));
  if (model.isType<Array<double>>() && value.isType<Array<int>>()) {
    const auto &ints = Teuchos::getValue<Array<int>>(value);
    return ParameterEntry(Array<double>(ints.begin(), ints.end()));
  }
  return std::nullopt;
}

template <class T>
std::optional<T> read_as(const std::string &text)
{
  std::istringstream in(text);
  T value{};
  if (!(in >> std::boolalpha >> value)) return std::nullopt;
  in >> std::ws;
  if (!in.eof()) return std::nullopt;
  return value;
}

/// "{1, 2}", each item by the rules for a single one: Teuchos itself reads "2.5" as the int 2 and "abc" as the double
/// 0.
template <class T>
std::optional<Array<T>> read_array(const std::string &text)
{
  const auto first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  if (first == std::string::npos || first == last || text[first] != '{' || text[last] != '}') return std::nullopt;
  const std::string inside = text.substr(first + 1, last - first - 1);
  Array<T> values;
  if (inside.find_first_not_of(' ') == std::string::npos) return values;
  std::istringstream in(inside + ",");
  for (std::string item; std::getline(in, item, ',');) {
    const auto value = read_as<T>(item);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

/// "0, min(t, 1) - 0.5": the texts between commas that stand in no parentheses, without blanks around them.
std::vector<std::string> split_fields(const std::string &texts)
{
  std::vector<std::string> fields;
  int depth = 0;
  std::string field;
  const auto add = [&] {
    const auto begin = field.find_first_not_of(' '), end = field.find_last_not_of(' ');
    fields.push_back(begin == std::string::npos ? "" : field.substr(begin, end - begin + 1));
    field.clear();
  };
  for (const char c : texts) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0)
      add();
    else
      field += c;
  }
  add();
  return fields;
}

/// "{0, min(t, 1) - 0.5}".
std::optional<Array<std::string>> read_fields(const std::string &text)
{
  const auto first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  if (first == std::string::npos || first == last || text[first] != '{' || text[last] != '}') return std::nullopt;
  const std::string inside = text.substr(first + 1, last - first - 1);
  if (inside.find_first_not_of(' ') == std::string::npos) return Array<std::string>();
  return Array<std::string>(split_fields(inside));
}

/// The text as the type of `model`, or as the first type that fits where there is no model.
std::optional<ParameterEntry> read_entry(const std::string &text, const ParameterEntry *model)
{
  const auto entry_of = [](const auto &value) -> std::optional<ParameterEntry> {
    if (!value) return std::nullopt;
    return ParameterEntry(*value);
  };
  if (!model) {
    if (const auto value = entry_of(read_as<int>(text))) return value;
    if (const auto value = entry_of(read_as<double>(text))) return value;
    if (const auto value = entry_of(read_as<bool>(text))) return value;
    return ParameterEntry(text);
  }
  if (const ChoiceValidator *const choice = choice_of(*model)) return entry_of(choice->word_of(text));
  if (is_field(*model) || model->isType<std::string>()) return ParameterEntry(text);
  if (is_fields(*model)) return entry_of(read_fields(text));
  if (model->isType<int>()) return entry_of(read_as<int>(text));
  if (model->isType<double>()) return entry_of(read_as<double>(text));
  if (model->isType<bool>()) return entry_of(read_as<bool>(text));
  if (model->isType<Array<int>>()) return entry_of(read_array<int>(text));
  if (model->isType<Array<double>>()) return entry_of(read_array<double>(text));
  if (model->isType<Array<std::string>>()) return entry_of(read_array<std::string>(text));
  return std::nullopt;
}

/// What a value has to be, after "must be ".
std::string rule_of(const ParameterEntry &model)
{
  if (is_fields(model))
    return "an array of numbers, such as {0, 0.5}, or of strings with expressions, such as {0, 0.1*t}";
  if (const ChoiceValidator *const choice = choice_of(model)) return "one of " + join(choice->words());
  if (model.isType<double>()) return "a double, and finite";
  if (model.isType<bool>()) return "a bool: true or false";
  if (model.isType<int>()) return "an int";
  if (model.isType<Array<int>>()) return "an array of int, such as {160, 32}";
  if (model.isType<Array<double>>()) return "an array of double, such as {0, 2.5}, all finite";
  if (model.isType<Array<std::string>>()) return "an array of string, such as {a, b}";
  return "a " + type_name(model);
}

/// A default as a deck would have it.
std::string text_of(const ParameterEntry &entry)
{
  if (entry.isType<bool>()) return Teuchos::getValue<bool>(entry) ? "true" : "false";
  if (!entry.isType<Array<double>>()) return Teuchos::toString(entry.getAny(false));
  std::ostringstream text; // Teuchos writes all the digits
  text << "{";
  for (const double value : Teuchos::getValue<Array<double>>(entry)) text << (text.tellp() > 1 ? ", " : "") << value;
  return text.str() + "}";
}

std::string unknown_name_message(const std::string &path, const std::string &name, const ParameterList &valid)
{
  const auto names = names_of(valid);
  return unknown_parameter(path, name, names).what() + std::string(" Valid here: ") + join(names) + ".";
}

} // namespace

ParameterEntry unread(const ParameterEntry &entry, const bool is_default)
{
  ParameterEntry copy(entry);
  copy.setAnyValue(entry.getAny(false), is_default);
  return copy;
}

void set_field(ParameterList &valid, const std::string &name, const std::string &default_value, const std::string &doc)
{
  valid.set(name, default_value, doc, Teuchos::rcp(new FieldValidator));
}

std::string field_text(const ParameterList &list, const std::string &name)
{
  const ParameterEntry &entry = list.getEntry(name);
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  if (entry.isType<int>())
    text << Teuchos::getValue<int>(entry);
  else if (entry.isType<double>())
    text << Teuchos::getValue<double>(entry);
  else
    text << Teuchos::getValue<std::string>(entry);
  return text.str();
}

void set_fields(ParameterList &valid, const std::string &name, const std::string &doc)
{
  valid.set(name, Array<std::string>(), doc, Teuchos::rcp(new FieldValidator));
}

std::vector<std::string> field_texts(const ParameterList &list, const std::string &name)
{
  const ParameterEntry &entry = list.getEntry(name);
  if (entry.isType<Array<std::string>>()) {
    // What Teuchos reads from a deck it has cut at all commas, those between parentheses too.
    const auto &pieces = Teuchos::getValue<Array<std::string>>(entry);
    std::string texts;
    for (int k = 0; k < static_cast<int>(pieces.size()); ++k) texts += (k > 0 ? "," : "") + pieces[k];
    return pieces.empty() ? std::vector<std::string>() : split_fields(texts);
  }
  std::vector<std::string> texts;
  const auto add = [&](const auto &numbers) {
    for (const auto number : numbers) {
      std::ostringstream text;
      text.precision(std::numeric_limits<double>::max_digits10);
      text << number;
      texts.push_back(text.str());
    }
  };
  if (entry.isType<Array<int>>())
    add(Teuchos::getValue<Array<int>>(entry));
  else
    add(Teuchos::getValue<Array<double>>(entry));
  return texts;
}

void set_choice(ParameterList &valid, const std::string &name, const std::vector<std::string> &words,
                const std::string &doc)
{
  valid.set(name, words.front(), doc, Teuchos::rcp(new ChoiceValidator(words)));
}

void set_pass_through(ParameterList &valid, const std::string &name, const std::string &doc)
{
  valid.sublist(name, false, doc).set(pass_through, true);
}

void set_named_entries(ParameterList &valid, const std::string &name, const ParameterList &entry,
                       const std::string &doc)
{
  valid.sublist(name, false, doc).sublist(any_entry, false, doc) = entry; // twice: copies of the list lose its own doc
}

void validate(ParameterList &list, const ParameterList &valid, const std::string &path)
{
  if (valid.isParameter(pass_through)) return;
  const bool named_entries = valid.isSublist(any_entry);
  for (const std::string &name : names_of(list)) {
    if (!named_entries && !valid.isParameter(name))
      throw Error(ExitCode::bad_input, unknown_name_message(path, name, valid));
    const ParameterEntry &model = valid.getEntry(named_entries ? any_entry : name);
    ParameterEntry &entry = list.getEntry(name);
    if (entry.isList() && model.isList()) continue;
    const auto value = entry.isList() || model.isList() ? std::nullopt : converted(entry, model);
    RPC_REQUIRE(value, "deck: " << quoted(path, name) << " must be " << rule_of(model) << ", got "
                                << (entry.isList() ? "a sublist" : text_of(entry) + " (" + type_name(entry) + ")"));
    list.setEntry(name, *value);
  }
  if (named_entries) {
    for (const std::string &name : names_of(list))
      validate(list.sublist(name), valid.sublist(any_entry), path.empty() ? name : path + "->" + name);
    return;
  }
  for (const std::string &name : names_of(valid)) {
    const ParameterEntry &model = valid.getEntry(name);
    if (!list.isParameter(name))
      list.setEntry(name, model.isList() ? ParameterEntry(ParameterList(name), true, true) : unread(model, true));
    if (model.isList()) validate(list.sublist(name), valid.sublist(name), path.empty() ? name : path + "->" + name);
  }
}

void assign(ParameterList &list, const ParameterList &valid, const std::string &assignment)
{
  const auto equals = assignment.find('=');
  RPC_REQUIRE(equals != std::string::npos && equals > 0,
              "--set must read \"Sublist->Parameter=value\", got \"" << assignment << "\"");
  std::string rest = assignment.substr(0, equals);
  const std::string text = assignment.substr(equals + 1);

  ParameterList *target = &list;
  const ParameterList *model = &valid; // null below a pass-through sublist
  std::string path;
  for (auto arrow = rest.find("->"); arrow != std::string::npos; arrow = rest.find("->")) {
    const std::string name = rest.substr(0, arrow);
    rest = rest.substr(arrow + 2);
    if (model && !model->isParameter(pass_through)) {
      const std::string key = model->isSublist(any_entry) ? any_entry : name;
      RPC_REQUIRE(model->isParameter(key), unknown_name_message(path, name, *model));
      RPC_REQUIRE(model->isSublist(key), "--set: " << quoted(path, name) << " is a parameter, not a sublist");
      model = &model->sublist(key);
    }
    RPC_REQUIRE(!target->isParameter(name) || target->isSublist(name),
                "--set: " << quoted(path, name) << " is a parameter, not a sublist");
    target = &target->sublist(name);
    path = path.empty() ? name : path + "->" + name;
  }
  const bool unread = model->isParameter(pass_through);
  const bool named_entries = model->isSublist(any_entry);
  RPC_REQUIRE(unread || (!named_entries && !model->isSublist(rest)) || rest.empty(),
              "--set: " << quoted(path, rest) << " is a sublist. Set one of its parameters: \""
                        << (path.empty() ? "" : path + "->") << rest << "->Parameter=value\"");
  RPC_REQUIRE(unread || model->isParameter(rest), unknown_name_message(path, rest, *model));
  const auto value = read_entry(text, unread ? nullptr : &model->getEntry(rest));
  RPC_REQUIRE(value, "--set: " << quoted(path, rest) << " must be " << rule_of(model->getEntry(rest)) << ", got \""
                               << text << "\"");
  target->setEntry(rest, *value);
}

std::vector<std::string> names_of(const ParameterList &list)
{
  std::vector<std::string> names;
  for (auto it = list.begin(); it != list.end(); ++it) names.push_back(list.name(it));
  return names;
}

Error unknown_parameter(const std::string &path, const std::string &name, const std::vector<std::string> &candidates)
{
  const std::string nearest = nearest_name(name, candidates);
  return {ExitCode::bad_input, "deck: unknown parameter " + quoted(path, name) + "." +
                                   (nearest.empty() ? "" : " Did you mean \"" + nearest + "\"?")};
}

void require_known(const ParameterList &given, const std::vector<std::string> &known, const std::string &path)
{
  for (const std::string &name : names_of(given))
    if (std::find(known.begin(), known.end(), name) == known.end()) throw unknown_parameter(path, name, known);
}

std::string join(const std::vector<std::string> &names)
{
  std::string text;
  for (const auto &name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void print_parameters(std::ostream &out, const ParameterList &valid, const std::string &path)
{
  for (const std::string &name : names_of(valid)) {
    const ParameterEntry &entry = valid.getEntry(name);
    if (entry.isList() || name == pass_through) continue;
    const bool no_default = entry.isType<double>() && std::isnan(Teuchos::getValue<double>(entry));
    out << "- `" << name << "` (" << type_name(entry) << ", "
        << (no_default ? "no default" : "default `" + text_of(entry) + "`") << "): " << entry.docString() << "\n";
  }
  for (const std::string &name : names_of(valid)) {
    const ParameterEntry &entry = valid.getEntry(name);
    if (!entry.isList()) continue;
    const std::string shown = name == any_entry ? "<any name>" : name;
    const std::string full = path.empty() ? shown : path + "->" + shown;
    const ParameterList &list = valid.sublist(name);
    if (!list.isSublist(any_entry)) { // otherwise there is nothing to say but what follows about its entries
      out << "\n### " << full << "\n\n" << entry.docString() << (entry.docString().empty() ? "" : "\n");
      if (!entry.docString().empty() && !list.isParameter(pass_through)) out << "\n";
    }
    print_parameters(out, list, full);
  }
}

} // namespace rpc
