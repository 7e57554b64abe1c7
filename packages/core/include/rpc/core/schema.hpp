// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>

/// Schemas of decks for editors, made from the valid parameters: they complete names, tell what they mean, and underline what rpc would
/// refuse for its name or its type.
namespace rpc
{

/// JSON Schema, draft 2020-12, of decks in YAML. The root list may have a name or not.
std::string json_schema(const Teuchos::ParameterList &valid);

/// RELAX NG of decks in XML. Names of parameters are values of attributes there, on which contents depend: XML Schema cannot say
/// that. Names that are given twice pass, for contents in any order are a repeated choice.
std::string relax_ng_schema(const Teuchos::ParameterList &valid);

} // namespace rpc
