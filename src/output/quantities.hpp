// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/quantity.hpp"

#include <nlohmann/json.hpp>
#include <ostream>

/// Tables of numbers as JSON and as columns.
namespace rpc
{

/// Adds the numbers of a record that the summary shows, under their names.
template <class Table, class Record>
void add_shown(nlohmann::ordered_json &json, const Table &table, const Record &record, const ResultScope &scope)
{
  for (const auto &q : defined_numbers(table, scope))
    if (q.shown.summary) json[q.name(scope)] = record.*q.value;
}

/// Names of numbers as headings of columns, each after a comma.
template <class Numbers>
void write_names(std::ostream &out, const Numbers &numbers, const ResultScope &scope)
{
  for (const auto &q : numbers) out << ',' << q.name(scope) << scope.units.heading(q.unit, scope.per_length);
}

/// Their values.
template <class Numbers, class Record>
void write_values(std::ostream &out, const Numbers &numbers, const Record &record)
{
  for (const auto &q : numbers) out << ',' << record.*q.value;
}

/// All numbers of a record, in the order of the table: what a checkpoint keeps of it.
template <class Table, class Record>
nlohmann::json kept_numbers(const Table &table, const Record &record, const ResultScope &scope)
{
  nlohmann::json numbers = nlohmann::json::array();
  for (const auto &q : defined_numbers(table, scope)) numbers.push_back(record.*q.value);
  return numbers;
}

/// @throws nlohmann::json::exception where they are not as many
template <class Table, class Record>
void take_numbers(const nlohmann::json &numbers, const Table &table, Record &record, const ResultScope &scope)
{
  std::size_t k = 0;
  for (const auto &q : defined_numbers(table, scope)) numbers.at(k++).get_to(record.*q.value);
}

} // namespace rpc
