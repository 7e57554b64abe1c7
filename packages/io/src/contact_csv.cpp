// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/io/contact_csv.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/on_root.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/io/atomic_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace rpc::io
{
namespace
{

/// One contact node.
struct Row {
  GO id;
  std::array<double, 3> x;
  double u_nu, gap, pressure, dent;
  int state;
  double area;  ///< weight in 3D [m^2]
  double s = 0; ///< arc length [m]
  std::array<double, 3> traction{}, slip{}, along{}, force{};
  double used = 0;
  int slip_state = 0;
};

using Edge = std::array<int, 2>; // rows at its ends
using Chain = std::vector<int>;  // rows in the order of the walk

/// This rank's rows.
std::vector<Row> rows_of(const ContactTable &table, const int dim)
{
  std::vector<Row> rows;
  rows.reserve(table.id.extent(0));
  for (std::size_t k = 0; k < table.id.extent(0); ++k) {
    Row row{table.id(k),    {}, table.u_nu(k), table.gap(k), table.pressure(k), table.dent(k), table.state(k),
            table.weight(k)};
    for (int c = 0; c < dim; ++c) {
      row.x[c] = table.position(k, c);
      row.along[c] = table.along(k, c);
      row.force[c] = table.force(k, c);
    }
    if (table.friction) {
      for (int c = 0; c < dim; ++c) {
        row.traction[c] = table.traction(k, c);
        row.slip[c] = table.slip(k, c);
      }
      row.used = table.used(k);
      row.slip_state = table.slip_state(k);
    }
    rows.push_back(row);
  }
  return rows;
}

/// All ranks' rows ordered by id; rank 0 only.
std::vector<Row> gather_rows(const Comm &comm, const std::vector<Row> &mine)
{
  static_assert(std::is_trivially_copyable<Row>::value, "rows travel as bytes");
  const auto *const bytes = reinterpret_cast<const char *>(mine.data());
  const std::vector<char> all = gathered_by_root(comm, bytes, mine.size() * sizeof(Row));
  std::vector<Row> rows(all.size() / sizeof(Row));
  if (!rows.empty()) std::memcpy(rows.data(), all.data(), all.size());
  std::sort(rows.begin(), rows.end(), [](const Row &a, const Row &b) { return a.id < b.id; });
  return rows;
}

/// Facets as edges between neighbouring rows, in an order that does not depend on the ranks. A node without a row is
/// passed over.
std::vector<Edge> edges_of(const std::vector<Row> &rows, const std::vector<GO> &facets, const int width)
{
  std::map<GO, int> row_of;
  for (std::size_t r = 0; r < rows.size(); ++r) row_of[rows[r].id] = static_cast<int>(r);
  std::vector<Edge> edges;
  for (std::size_t f = 0; f < facets.size(); f += width) {
    std::vector<GO> walk = {facets[f]}; // end, middle ones, end
    for (int a = 2; a < width; ++a) walk.push_back(facets[f + a]);
    walk.push_back(facets[f + 1]);
    std::vector<int> present;
    for (const GO id : walk)
      if (const auto row = row_of.find(id); row != row_of.end()) present.push_back(row->second);
    for (std::size_t k = 1; k < present.size(); ++k) edges.push_back({present[k - 1], present[k]});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Cuts the surface into chains, each of which starts at its lowest end, or point if it is closed; sorted by their
/// starts.
std::vector<Chain> chains_of(const std::vector<Row> &rows, const std::vector<Edge> &edges)
{
  std::vector<std::vector<int>> neighbours(rows.size()); // along the facets' direction first
  for (const Edge &edge : edges) neighbours[edge[0]].push_back(edge[1]);
  for (const Edge &edge : edges) neighbours[edge[1]].push_back(edge[0]);

  const auto lower = [&](const int a, const int b) { return rows[a].x < rows[b].x; };
  std::vector<int> starts(rows.size());
  std::iota(starts.begin(), starts.end(), 0);
  std::stable_sort(starts.begin(), starts.end(), lower);
  std::stable_partition(starts.begin(), starts.end(),
                        [&](const int row) { return neighbours[row].size() < 2; }); // ends first

  std::vector<Chain> chains;
  std::vector<bool> visited(rows.size(), false);
  for (const int start : starts) {
    if (visited[start]) continue;
    Chain chain;
    for (std::optional<int> at = start; at;) {
      chain.push_back(*at);
      visited[*at] = true;
      const auto &around = neighbours[*at];
      const auto next = std::find_if(around.begin(), around.end(), [&](const int row) { return !visited[row]; });
      at = next == around.end() ? std::nullopt : std::optional<int>(*next);
    }
    chains.push_back(chain);
  }
  std::stable_sort(chains.begin(), chains.end(),
                   [&](const Chain &a, const Chain &b) { return lower(a.front(), b.front()); });
  return chains;
}

std::vector<Row> along_the_surface(std::vector<Row> rows, const std::vector<Edge> &edges)
{
  std::vector<Row> sorted;
  for (const Chain &chain : chains_of(rows, edges)) {
    for (std::size_t k = 0; k < chain.size(); ++k) {
      Row &row = rows[chain[k]];
      if (k > 0) row.s = sorted.back().s + std::hypot(row.x[0] - sorted.back().x[0], row.x[1] - sorted.back().x[1]);
      sorted.push_back(row);
    }
  }
  return sorted;
}

void append(std::string &text, const double value)
{
  char buffer[32];
  text.append(buffer,
              std::to_chars(buffer, buffer + sizeof buffer, value).ptr); // the shortest that reads back the same
  text += ',';
}

void append(std::string &text, const Row &row, const int dim, const std::string &side, const bool friction)
{
  static const std::array<const char *, 3> slip_states = {"none", "sticks", "slips"};
  static const std::array<const char *, 4> states = {"open", "closed", "yielding", "unseen"};
  RPC_REQUIRE_CODE(row.state >= 0 && row.state < static_cast<int>(states.size()), ExitCode::internal_error,
                   "output: the contact state of node " << row.id << " must be 0 to 3, got " << row.state);
  for (const double value : {row.x[0], row.x[1], dim == 2 ? row.s : row.x[2]}) append(text, value);
  if (dim == 3) append(text, row.area);
  for (const double value : {row.u_nu, row.gap, row.pressure}) append(text, value);
  text += states[row.state];
  text += ',' + side + ',';
  append(text, row.dent);
  if (friction) {
    for (const auto &vector : {row.traction, row.slip})
      for (int k = 0; k < dim; ++k) append(text, vector[k]);
    append(text, row.used);
    text += std::string(slip_states.at(row.slip_state)) + ',';
  }
  for (const auto &vector : {row.along, row.force})
    for (int k = 0; k < dim; ++k) append(text, vector[k]);
  text.back() = '\n';
}

std::string csv(const std::vector<Row> &rows, const int dim, const std::string &side, const bool friction)
{
  std::string text;
  for (const Row &row : rows) append(text, row, dim, side, friction);
  return text;
}

std::string heading(const int dim, const UnitNames &units, const bool per_length, const bool friction)
{
  const std::string length = units.heading(unit::length, false);
  std::string text;
  for (const char *const name : {"x", "y", dim == 2 ? "s" : "z"}) text += name + length + ',';
  if (dim == 3) text += "area" + units.heading(unit::extent, false) + ',';
  text += "u_nu" + length + ",gap" + length + ",pressure" + units.heading(unit::pressure, false) + ",state,side,dent" +
          length;
  const auto add_vector = [&](const std::string &name, const std::string &in) {
    for (int k = 0; k < dim; ++k) text += ',' + name + std::string("xyz")[k] + in;
  };
  if (friction) {
    add_vector("q_", units.heading(unit::pressure, false));
    add_vector("slip_", length);
    text += ",friction_used,friction_state";
  }
  add_vector("u_t_", length);
  add_vector("force_", units.heading(unit::force, per_length));
  return text + '\n';
}

void require_equal_lengths(const Comm &comm, const ContactTable &table)
{
  const std::size_t n = table.id.extent(0);
  std::optional<std::string> message;
  for (const std::size_t length : {table.position.extent(0), table.u_nu.extent(0), table.gap.extent(0),
                                   table.weight.extent(0), table.pressure.extent(0), table.dent.extent(0),
                                   table.state.extent(0), table.along.extent(0), table.force.extent(0)})
    if (length != n)
      message = "output: the contact table's columns must have a value for each of " + std::to_string(n) +
                " nodes, got " + std::to_string(length);
  if (table.friction)
    for (const std::size_t length :
         {table.traction.extent(0), table.slip.extent(0), table.used.extent(0), table.slip_state.extent(0)})
      if (length != n)
        message = "output: the contact table's columns of friction must have a value for each of " + std::to_string(n) +
                  " nodes, got " + std::to_string(length);
  throw_if_any(comm, ExitCode::internal_error, message);
}

/// @param id_of  that of the k-th row, in their order
template <class IdOf>
void require_unique(const std::size_t num_rows, const IdOf &id_of)
{
  for (std::size_t k = 1; k < num_rows; ++k)
    RPC_REQUIRE_CODE(id_of(k) != id_of(k - 1), ExitCode::internal_error,
                     "output: the contact node " << id_of(k) << " is on several ranks or comes twice on one");
}

/// The lines of a side in space by the rows' ids, on rank 0: each rank writes those of its own rows. Collective.
std::string lines_by_id(const Comm &comm, const ContactTable &table, const int dim, const bool friction)
{
  std::vector<GO> id;
  std::vector<int> length;
  std::string text;
  const std::string side = csv_quoted(table.side);
  on_each(comm, ExitCode::internal_error, [&] {
    for (const Row &row : rows_of(table, dim)) {
      const std::size_t before = text.size();
      append(text, row, dim, side, friction);
      id.push_back(row.id);
      length.push_back(static_cast<int>(text.size() - before));
    }
  });
  const auto ids = gathered_by_root(comm, id);
  const auto lengths = gathered_by_root(comm, length);
  const auto texts = gathered_by_root(comm, text.data(), text.size());
  std::string sorted;
  on_root(comm, ExitCode::internal_error, [&] {
    struct Line {
      GO id;
      std::size_t begin;
      int length;
    };
    std::vector<Line> lines;
    std::size_t begin = 0;
    for (std::size_t k = 0; k < ids.size(); ++k) {
      lines.push_back({ids[k], begin, lengths[k]});
      begin += lengths[k];
    }
    std::sort(lines.begin(), lines.end(), [](const Line &a, const Line &b) { return a.id < b.id; });
    require_unique(lines.size(), [&](const std::size_t k) { return lines[k].id; });
    sorted.reserve(texts.size());
    for (const Line &line : lines) sorted.append(texts.data() + line.begin, line.length);
  });
  return sorted;
}

} // namespace

std::string csv_quoted(const std::string &text)
{
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

void write_contact_csv(const std::string &path, const RCP<const Comm> &comm, const std::vector<ContactTable> &tables,
                       const UnitNames &units, const bool per_length)
{
  std::string text;
  const bool friction =
      std::any_of(tables.begin(), tables.end(), [](const ContactTable &table) { return table.friction; });
  for (const ContactTable &table : tables) {
    require_equal_lengths(*comm, table);
    const int dim = max_all(*comm, static_cast<int>(table.position.extent(1)));
    const int width = max_all(*comm, static_cast<int>(table.facets.extent(1)));
    if (dim == 3) {
      if (text.empty()) text = heading(dim, units, per_length, friction);
      text += lines_by_id(*comm, table, dim, friction);
      continue;
    }
    std::vector<Row> rows = gather_rows(*comm, rows_of(table, dim));
    const std::vector<GO> facets = gathered_by_root(*comm, table.facets.data(), table.facets.size());
    on_root(*comm, ExitCode::internal_error, [&] {
      require_unique(rows.size(), [&](const std::size_t k) { return rows[k].id; });
      rows = along_the_surface(rows, edges_of(rows, facets, width));
      if (text.empty()) text = heading(dim, units, per_length, friction);
      text += csv(rows, dim, csv_quoted(table.side), friction);
    });
  }
  on_root(*comm, ExitCode::internal_error, [&] { write_text(path, text); });
}

} // namespace rpc::io
