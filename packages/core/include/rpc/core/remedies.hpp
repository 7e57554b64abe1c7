// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

/// What to write instead of a value that does not read: sentences that follow a refusal, each with a blank before it.
namespace rpc
{

/// A number as people and other programs write it: `0,3`, `210 000`, `2.1d5`, `2.1*10^5`, with a unit or without.
struct WrittenNumber {
  double value = 0;
  std::string unit; ///< what follows the number
};
std::optional<WrittenNumber> written_number(const std::string &text);

/// Digits as a deck takes them, as few as give the number.
std::string number_text(double value);

/// For a text that is to be one number: " Write 0.3.", or what 210 GPa is in the deck's units; empty if it is nothing like a number.
std::string number_remedy(const std::string &text);

/// For a text that is to be an array of numbers: " Write {160, 32} (in YAML [160, 32])."; empty if it is nothing like one.
/// @param whole  the numbers are to be whole ones
std::string array_remedy(const std::string &text, bool whole = false);

/// For a text that is to be a whole number.
std::string integer_remedy(const std::string &text);

/// For a text that is to be true or false; empty if it is nothing like it.
std::string bool_remedy(const std::string &text);

/// " Did you mean "foot"?"; empty if no candidate bears any likeness.
std::string did_you_mean(const std::string &name, const std::vector<std::string> &candidates);

} // namespace rpc
