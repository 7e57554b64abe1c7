// SPDX-License-Identifier: BSD-3-Clause
#include "parameter_kinds.hpp"
#include "rpc/core/parameters.hpp"
#include "rpc/core/remedies.hpp"
#include "unknown_name.hpp"

namespace rpc
{
namespace
{

/// "Pa" of "Force per area in X [Pa], a number or an expression."; empty if there is none.
std::string unit_in(const std::string &doc)
{
  const std::size_t open = doc.find('['), close = doc.find(']', open == std::string::npos ? 0 : open);
  if (open == std::string::npos || close == std::string::npos) return "";
  return doc.substr(open + 1, close - open - 1);
}

} // namespace

Wanted wanted_of(const ParameterList &valid, const std::string &path)
{
  const ParameterList *list = &valid;
  std::string rest = path;
  for (auto arrow = rest.find("->"); arrow != std::string::npos; arrow = rest.find("->")) {
    const std::string name = list->isSublist(any_entry) ? any_entry : rest.substr(0, arrow);
    if (!list->isSublist(name)) return {};
    list = &list->sublist(name);
    rest = rest.substr(arrow + 2);
  }
  if (!list->isParameter(rest) || list->isSublist(rest) || rest == pass_through) return {};
  Wanted wanted;
  wanted.name = rest;
  wanted.unit = unit_in(list->getEntry(rest).docString());
  wanted.expression = has_field_validator(list->getEntry(rest));
  for (const std::string &name : names_of(*list))
    if (name != rest && !list->isSublist(name))
      wanted.siblings.emplace_back(name, unit_in(list->getEntry(name).docString()));
  return wanted;
}

} // namespace rpc
