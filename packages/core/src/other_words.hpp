// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

/// Words of books and of other programs, as letters() has them.
namespace rpc
{

/// Where a deck has what they mean.
extern const std::vector<std::pair<std::string, std::string>> words_of_others;
/// What to say of them, where no parameter means the same.
extern const std::vector<std::pair<std::string, std::string>> sentences_for_words;
/// Words among which a parameter chooses.
extern const std::vector<std::pair<std::string, std::string>> words_for_words;

/// Letters and digits alone, small.
std::string letters(const std::string &name);

/// What a table has of a word; empty if it does not have it.
std::string found_word(const std::vector<std::pair<std::string, std::string>> &table, const std::string &word);

} // namespace rpc
