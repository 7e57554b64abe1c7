// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace rpc::io
{

/// A text as YAML takes it whatever it holds; empty where no quotes do.
std::string in_quotes(const std::string &text);

/// The last name of a path, "Side" of "Contact->Side".
std::string last_name(const std::string &path);

/// What is wrong with a value of a YAML deck, with the remedy: signs that YAML reads as its own outside of quotes, and a \ within double ones.
/// Empty where nothing is.
/// @param path   of the value
/// @param value  with its quotes, if it has any, and without a comment
std::string wrong_signs(const std::string &path, const std::string &value);

} // namespace rpc::io
