// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/parameters.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <numeric>
#include <sstream>

namespace rpc
{
namespace
{

std::string small_letters(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](const unsigned char c) { return std::tolower(c); });
  return text;
}

std::vector<std::string> sorted_words(const std::string &text)
{
  std::istringstream in(small_letters(text));
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  std::sort(words.begin(), words.end());
  return words;
}

/// "Filename" for "File", "Output File" for "Output".
bool begins_with(const std::string &name, const std::string &candidate)
{
  constexpr std::size_t fewest_letters = 3;
  return candidate.size() >= fewest_letters && small_letters(name).rfind(small_letters(candidate), 0) == 0;
}

} // namespace

std::string nearest_name(const std::string &name, const std::vector<std::string> &candidates)
{
  // Levenshtein's, case ignored, where two letters that have changed places count as one slip.
  const auto distance = [](const std::string &a, const std::string &b) {
    const auto same = [&](const std::size_t i, const std::size_t j) {
      return std::tolower(static_cast<unsigned char>(a[i - 1])) == std::tolower(static_cast<unsigned char>(b[j - 1]));
    };
    std::vector<std::size_t> before, last, row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 1; i <= a.size(); ++i) {
      before = last;
      last = row;
      row[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j) {
        row[j] = std::min({last[j - 1] + (same(i, j) ? 0 : 1), last[j] + 1, row[j - 1] + 1});
        if (i > 1 && j > 1 && same(i, j - 1) && same(i - 1, j)) row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    return row.back();
  };
  std::string best;
  std::size_t best_distance = std::numeric_limits<std::size_t>::max();
  for (const auto &candidate : candidates) {
    const bool same_words = sorted_words(name) == sorted_words(candidate);
    const std::size_t d = same_words ? 0 : distance(name, candidate);
    const bool abbreviated = name.size() > 1 && d == candidate.size() - name.size() &&
                             distance(name.substr(0, 1), candidate.substr(0, 1)) == 0;
    const std::size_t longer = std::max(name.size(), candidate.size());
    const bool slipped = 3 * d <= longer || (d == 1 && longer > 1);
    if (!slipped && !abbreviated && !begins_with(name, candidate)) continue; // no likeness
    if (d < best_distance) {
      best = candidate;
      best_distance = d;
    }
  }
  return best;
}

} // namespace rpc
