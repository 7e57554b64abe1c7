// SPDX-License-Identifier: BSD-3-Clause
#include "entry_remedies.hpp"

#include "parameter_kinds.hpp"
#include "rpc/core/parameters.hpp"
#include "unknown_name.hpp"

#include <algorithm>
#include <vector>

namespace rpc
{
namespace
{

/// Parameters of a list that are no lists, but for "Side".
std::vector<std::string> values_of(const ParameterList &list)
{
  std::vector<std::string> names;
  for (const std::string &name : names_of(list))
    if (name != "Side" && !list.isSublist(name)) names.push_back(name);
  return names;
}

/// "top: {X: ..., Y: ...}"
std::string example(const std::string &name, const ParameterList &list)
{
  std::string inside;
  const std::vector<std::string> values = values_of(list);
  for (std::size_t k = 0; k < std::min<std::size_t>(2, values.size()); ++k)
    inside += (k > 0 ? ", " : "") + values[k] + ": ...";
  return name + ": {" + inside + "}";
}

} // namespace

std::string entry_remedy(const std::string &path, const std::string &name, const ParameterList &valid)
{
  const ParameterList &model = valid.sublist(any_entry);
  if (!model.isParameter(name))
    return " The entries of \"" + path + "\" are lists with parameters in them: in YAML " + example(name, model) +
           ", in XML <ParameterList name=\"" + name + "\">.";
  const bool of_sides = model.isParameter("Side");
  const std::string around = of_sides ? "top" : "body";
  return " The entries of \"" + path + "\" are lists, each named after a " + (of_sides ? "side" : "block") +
         ", with parameters in them: write <ParameterList name=\"" + around + "\"> around it, in YAML " + around +
         ": {" + name + ": ...}.";
}

std::string list_remedy(const std::string &name, const std::string &value, const ParameterList &valid)
{
  const ParameterList &model = valid.sublist(name);
  const bool one_word = !value.empty() && value.find_first_of("{}[]:,\" ") == std::string::npos;
  const bool is_name = one_word && value.find_first_not_of("0123456789.+-") != std::string::npos;
  if (model.isSublist(any_entry) && is_name) {
    std::vector<std::string> texts;
    for (const std::string &other : names_of(valid))
      if (valid.getEntry(other).isType<std::string>()) texts.push_back(other);
    if (const std::string meant = nearest_name(name, texts); !meant.empty())
      return " A single one is \"" + meant + "\" = " + value + ".";
    return " Its entries are lists: in YAML " + name + ": {" + example(value, model.sublist(any_entry)) +
           "}, in XML <ParameterList name=\"" + value + "\"> within <ParameterList name=\"" + name + "\">.";
  }
  std::string shown =
      model.isSublist(any_entry) || values_of(model).empty() ? name + ": {parameter: value}" : example(name, model);
  if (is_name && model.isParameter("Side")) shown = name + ": {Side: " + value + "}";
  return " In XML write <ParameterList name=\"" + name + "\"> with <Parameter .../> in it, in YAML " + shown + ".";
}

} // namespace rpc
