// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_Array.hpp>
#include <Teuchos_ParameterEntryValidator.hpp>
#include <Teuchos_ParameterList.hpp>
#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// What kinds of parameters there are besides Teuchos' types, and how decks have their values.
namespace rpc
{

using Teuchos::Array;
using Teuchos::ParameterEntry;
using Teuchos::ParameterList;

/// Marks a parameter as a field. Teuchos asks a validator for more than its rule; the rule itself is in validate().
class FieldValidator : public Teuchos::ParameterEntryValidator
{
public:
  const std::string getXMLTypeName() const override { return "field"; }
  void printDoc(const std::string &doc, std::ostream &out) const override { out << doc; }
  ValidStringsList validStringValues() const override { return Teuchos::null; }
  void validate(const ParameterEntry &, const std::string &, const std::string &) const override {}
};

/// Marks a parameter as one of some words.
class ChoiceValidator : public Teuchos::ParameterEntryValidator
{
public:
  /// @param has_switch  true and false stand for the first and the last word
  ChoiceValidator(std::vector<std::string> words, const bool has_switch)
      : words_(std::move(words)), has_switch_(has_switch)
  {
  }
  const std::string getXMLTypeName() const override { return "choice"; }
  void printDoc(const std::string &doc, std::ostream &out) const override { out << doc; }
  ValidStringsList validStringValues() const override { return Teuchos::null; }
  void validate(const ParameterEntry &, const std::string &, const std::string &) const override {}

  bool has_switch() const { return has_switch_; }
  const std::vector<std::string> &words() const { return words_; }
  /// The word that is meant; none if it is not among them.
  std::optional<std::string> word_of(const std::string &text) const
  {
    if (has_switch_ && text == "true") return words_.front();
    if (has_switch_ && text == "false") return words_.back();
    if (std::find(words_.begin(), words_.end(), text) == words_.end()) return std::nullopt;
    return text;
  }

private:
  std::vector<std::string> words_;
  bool has_switch_;
};

inline const ChoiceValidator *choice_of(const ParameterEntry &entry)
{
  return dynamic_cast<const ChoiceValidator *>(entry.validator().get());
}

inline bool has_field_validator(const ParameterEntry &entry)
{
  return dynamic_cast<const FieldValidator *>(entry.validator().get()) != nullptr;
}
inline bool is_fields(const ParameterEntry &entry)
{
  return has_field_validator(entry) && entry.isType<Array<std::string>>();
}
inline bool is_field(const ParameterEntry &entry)
{
  return has_field_validator(entry) && !is_fields(entry);
}

inline std::string type_name(const ParameterEntry &entry)
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

/// A default as a deck writes it.
inline std::string text_of(const ParameterEntry &entry)
{
  if (entry.isType<bool>()) return Teuchos::getValue<bool>(entry) ? "true" : "false";
  if (!entry.isType<Array<double>>()) return Teuchos::toString(entry.getAny(false));
  std::ostringstream text; // Teuchos writes all the digits
  text << "{";
  for (const double value : Teuchos::getValue<Array<double>>(entry)) text << (text.tellp() > 1 ? ", " : "") << value;
  return text.str() + "}";
}

} // namespace rpc
