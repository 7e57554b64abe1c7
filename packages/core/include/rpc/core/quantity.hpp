// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/units.hpp"

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

namespace rpc
{

/// How the numbers of several sides, or of several ranks, come together.
enum class Combine { sum, maximum };

/// What a run must have for a number to be defined.
enum class Needs { nothing, friction };

/// Which numbers a run has, and in which units.
struct ResultScope {
  bool per_length = false; ///< the body is plane: forces and energies are per length of its depth
  bool friction = false;   ///< the law of a contact side has friction
  UnitNames units;
};

/// Where a number is shown.
struct Shown {
  bool summary = false;          ///< in the JSON file
  int column = 0;                ///< place among the numbers of its record in the history, from 1; 0: not there
  const char *heading = nullptr; ///< of its line on the console; numbers of one heading share a line. Null: no line
  const char *label = "";        ///< on that line, before the number
  bool only_positive = false;    ///< no line unless one of its numbers is > 0
  bool meshes = false;           ///< in the summary's list of the meshes of an adaptive run
};

/// A number of the results. Tables of these are all that summary, history, console, checkpoint, sums over sides and ranks and
/// the tests know of a record's numbers: one more number is a member and a line in the table.
template <class Record, class Value = double>
struct Quantity {
  Value Record::*value;
  const char *key; ///< in the files
  Unit unit;
  Combine combine = Combine::sum;
  Shown shown = {};
  const char *whole_key = nullptr; ///< key for a body that is not plane, where it differs
  Needs needs = Needs::nothing;

  std::string name(const ResultScope &scope) const { return scope.per_length || !whole_key ? key : whole_key; }
  std::string unit_name(const ResultScope &scope) const { return scope.units.of(unit, scope.per_length); }
  bool defined(const ResultScope &scope) const { return needs == Needs::nothing || scope.friction; }
  void add(Record &to, const Record &other) const
  {
    to.*value = combine == Combine::sum ? to.*value + other.*value : std::max(to.*value, other.*value);
  }
};

/// The numbers of a table that a run has.
template <class Table>
auto defined_numbers(const Table &table, const ResultScope &scope)
{
  std::vector<std::decay_t<decltype(*std::begin(table))>> numbers;
  for (const auto &q : table)
    if (q.defined(scope)) numbers.push_back(q);
  return numbers;
}

/// Those among them that are columns of the history, in their places.
template <class Table>
auto history_columns(const Table &table, const ResultScope &scope)
{
  auto numbers = defined_numbers(table, scope);
  numbers.erase(std::remove_if(numbers.begin(), numbers.end(), [](const auto &q) { return q.shown.column == 0; }),
                numbers.end());
  std::sort(numbers.begin(), numbers.end(),
            [](const auto &a, const auto &b) { return a.shown.column < b.shown.column; });
  return numbers;
}

/// Adds another record's numbers, each as it is combined.
template <class Table, class Record>
void add_numbers(const Table &table, Record &to, const Record &other)
{
  for (const auto &q : table) q.add(to, other);
}

} // namespace rpc
