// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/parameters.hpp"

#include "entry_remedies.hpp"
#include "parameter_kinds.hpp"
#include "rpc/core/remedies.hpp"
#include "unknown_name.hpp"

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

std::string quoted(const std::string &path, const std::string &name)
{
  return "\"" + (path.empty() ? name : path + "->" + name) + "\"";
}

/// `value` as an entry of the same type as `model`, where C++ and XML habits make that harmless: 1 for 1.0.
std::optional<ParameterEntry> converted(const ParameterEntry &value, const ParameterEntry &model)
{
  if (is_field(model)) {
    if (value.isType<int>() || value.isType<double>() || value.isType<std::string>()) return value;
    return std::nullopt;
  }
  if (const ChoiceValidator *const choice = choice_of(model)) {
    const bool is_bool = value.isType<bool>(); // YAML makes one of true and false
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

/// Numbers of an array's default; 0 for anything else.
std::size_t length_of(const ParameterEntry &model)
{
  if (model.isType<Array<int>>()) return Teuchos::getValue<Array<int>>(model).size();
  return model.isType<Array<double>>() ? Teuchos::getValue<Array<double>>(model).size() : 0;
}

/// What to write instead of a value that does not fit.
std::string remedy_for(const std::string &text, const ParameterEntry &model, const Wanted &wanted)
{
  if (const ChoiceValidator *const choice = choice_of(model)) {
    const std::string meant = word_remedy(text, choice->words());
    return meant.empty() ? " " + model.docString() : meant;
  }
  if (model.isType<double>()) {
    if (!text.empty() && text.front() == '{') return " It takes one number.";
    const std::string number = number_remedy(text, wanted);
    return number.empty() ? " Write a number: this parameter takes no expressions." : number;
  }
  if (model.isType<int>()) return integer_remedy(text);
  if (model.isType<bool>()) return bool_remedy(text);
  if (model.isType<Array<int>>() || model.isType<Array<double>>() || is_fields(model)) {
    const std::string axis = axis_remedy(text), for_each = one_for_each_remedy(text, length_of(model));
    return !axis.empty() ? axis : !for_each.empty() ? for_each : array_remedy(text, model.isType<Array<int>>());
  }
  return "";
}

/// The same of a value of another type, as a deck in XML or YAML has it.
std::string remedy_for(const ParameterEntry &value, const ParameterEntry &model, const Wanted &wanted)
{
  if (model.isType<std::string>() && value.isType<Array<std::string>>() && !choice_of(model) &&
      !Teuchos::getValue<Array<std::string>>(value).empty())
    return " It takes one text, such as \"" + Teuchos::getValue<Array<std::string>>(value).front() +
           "\": write another entry for each further one.";
  if (value.isList())
    return Teuchos::getValue<Teuchos::ParameterList>(value).numParams() == 0
               ? " There is no value: write one behind the colon."
               : " It has one value, and no parameters in it: write them beside it.";
  const std::string text = text_of(value);
  const auto read = read_entry(text, &model);
  if (!read || choice_of(model)) return remedy_for(text, model, wanted);
  if (model.isType<Array<int>>() && value.isType<Array<double>>()) // 8.0 prints as 8
    return " Write whole numbers without a point: " + text + ", in YAML [" + text.substr(1, text.size() - 2) + "].";
  const std::string type = model.isType<Array<int>>()           ? "Array(int)"
                           : model.isType<Array<double>>()      ? "Array(double)"
                           : model.isType<Array<std::string>>() ? "Array(string)"
                                                                : type_name(model);
  return " Its type is to be " + type + ": in XML type=\"" + type + "\"" +
         (model.isType<std::string>() ? "; in YAML it needs quotes." : "; in YAML it stands without quotes.");
}

/// A value that does not fit, with its type where that may be why.
std::string given_text(const ParameterEntry &value, const ParameterEntry &model)
{
  if (value.isList()) return "a sublist";
  if (choice_of(model)) return "\"" + text_of(value) + "\"";
  return text_of(value) + " (" + type_name(value) + ")";
}

/// @param root  what the whole deck may have
void validate_list(ParameterList &list, const ParameterList &valid, const std::string &path, const ParameterList &root)
{
  if (valid.isParameter(pass_through)) return;
  const bool named_entries = valid.isSublist(any_entry);
  for (const std::string &name : names_of(list)) {
    if (!named_entries && !valid.isParameter(name)) throw unknown_name(path, name, valid, root, list.isSublist(name));
    const ParameterEntry &model = valid.getEntry(named_entries ? any_entry : name);
    ParameterEntry &entry = list.getEntry(name);
    if (entry.isList() && model.isList()) continue;
    const auto value = entry.isList() || model.isList() ? std::nullopt : converted(entry, model);
    RPC_REQUIRE(value, "deck: " << quoted(path, name) << " must be " << rule_of(model) << ", got "
                                << given_text(entry, model) << "."
                                << (named_entries    ? entry_remedy(path, name, valid)
                                    : model.isList() ? list_remedy(name, text_of(entry), valid)
                                                     : remedy_for(entry, model, wanted_of(valid, name))));
    list.setEntry(name, *value);
  }
  const auto full = [&](const std::string &name) { return path.empty() ? name : path + "->" + name; };
  if (named_entries) {
    for (const std::string &name : names_of(list))
      validate_list(list.sublist(name), valid.sublist(any_entry), full(name), root);
    return;
  }
  for (const std::string &name : names_of(valid)) {
    const ParameterEntry &model = valid.getEntry(name);
    if (!list.isParameter(name))
      list.setEntry(name, model.isList() ? ParameterEntry(ParameterList(name), true, true) : unread(model, true));
    if (model.isList()) validate_list(list.sublist(name), valid.sublist(name), full(name), root);
  }
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
  if (entry.isType<int>()) return std::to_string(Teuchos::getValue<int>(entry));
  if (entry.isType<double>()) return number_text(Teuchos::getValue<double>(entry));
  return Teuchos::getValue<std::string>(entry);
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
    for (const auto number : numbers) texts.push_back(number_text(number));
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
  valid.set(name, words.front(), doc, Teuchos::rcp(new ChoiceValidator(words, true)));
}

void set_words(ParameterList &valid, const std::string &name, const std::vector<std::string> &words,
               const std::string &doc)
{
  valid.set(name, words.front(), doc, Teuchos::rcp(new ChoiceValidator(words, false)));
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
  validate_list(list, valid, path, valid);
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
      if (!model->isParameter(key)) throw unknown_name(path, name, *model, valid);
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
  if (!unread && !model->isParameter(rest)) throw unknown_name(path, rest, *model, valid);
  const auto value = read_entry(text, unread ? nullptr : &model->getEntry(rest));
  RPC_REQUIRE(value, "--set: " << quoted(path, rest) << " must be " << rule_of(model->getEntry(rest)) << ", got \""
                               << text << "\"." << remedy_for(text, model->getEntry(rest), wanted_of(*model, rest)));
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
  return {ExitCode::bad_input, "deck: unknown parameter " + quoted(path, name) + "." + did_you_mean(name, candidates)};
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
