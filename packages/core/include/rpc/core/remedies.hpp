// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <optional>
#include <string>
#include <utility>
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

/// The value of numbers with + - * / ^ and parentheses: -4.1666 of "-500/120"; none of a single number and of anything else.
std::optional<double> arithmetic(const std::string &text);

/// What a parameter is to hold, as far as remedies depend on it.
struct Wanted {
  std::string name;                                          ///< "Y"
  std::string unit;                                          ///< in its doc's brackets, "Pa"; empty: it has none
  std::optional<bool> expression;                            ///< whether it takes expressions; none: not known
  std::vector<std::pair<std::string, std::string>> siblings; ///< other parameters of its list, with their units
};
/// @param path  "Traction->top->Y"; of a path that `valid` does not have nothing is known
Wanted wanted_of(const Teuchos::ParameterList &valid, const std::string &path);

/// For a text that is to be one number: " Write 0.3.", or what 210 GPa is in the deck's units, or that another quantity is wanted;
/// empty if it is nothing like a number.
std::string number_remedy(const std::string &text, const Wanted &wanted = {});

/// For a text that is to be an array of numbers: " Write {160, 32} (in YAML [160, 32])."; empty if it is nothing like one.
/// @param whole  the numbers are to be whole ones
std::string array_remedy(const std::string &text, bool whole = false);

/// For a single number where an array is wanted: " Write one for each direction: {20, 20} ...".
/// @param length  of the array's default
std::string one_for_each_remedy(const std::string &text, std::size_t length);

/// For "z" where a direction is wanted: " Write {0, 0, 1} ..."; empty if it is no axis.
std::string axis_remedy(const std::string &text);

/// For a text that is to be a whole number.
std::string integer_remedy(const std::string &text);

/// For a text that is to be true or false; empty if it is nothing like it.
std::string bool_remedy(const std::string &text);

/// For a word that is to be one of some: " For "step" write gmsh.", or did_you_mean(); empty if it is like none of them.
std::string word_remedy(const std::string &text, const std::vector<std::string> &words);

/// For a file that is not there: the nearest among some, by name or by its stem alone.
std::string file_remedy(const std::string &name, const std::vector<std::string> &files);

/// " Did you mean "foot"?"; empty if no candidate bears any likeness.
std::string did_you_mean(const std::string &name, const std::vector<std::string> &candidates);

} // namespace rpc
