// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

#include <array>
#include <exodusII.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rpc::io
{

/// An Exodus file that is read; one rank only. What cannot be read is empty. Private to io.
class ExodusReader
{
public:
  /// None if there is no such file, or it is no Exodus file.
  static std::optional<ExodusReader> open(const std::string &path)
  {
    ex_opts(EX_DEFAULT); // errors come as return codes, not on the console
    int word_size = sizeof(double), file_word_size = 0;
    float version = 0;
    const int id = ex_open(path.c_str(), EX_READ, &word_size, &file_word_size, &version);
    if (id < 0) return std::nullopt;
    return ExodusReader(id);
  }
  ~ExodusReader()
  {
    if (id_ >= 0) ex_close(id_);
  }
  ExodusReader(ExodusReader &&other) noexcept : id_(std::exchange(other.id_, -1)) {}
  ExodusReader(const ExodusReader &) = delete;
  ExodusReader &operator=(const ExodusReader &) = delete;
  ExodusReader &operator=(ExodusReader &&) = delete;

  GO num_nodes() const { return ex_inquire_int(id_, EX_INQ_NODES); }
  std::vector<double> times() const
  {
    const auto count = ex_inquire_int(id_, EX_INQ_TIME);
    std::vector<double> times(count > 0 ? count : 0);
    if (!times.empty() && ex_get_all_times(id_, times.data()) < 0) times.clear();
    return times;
  }
  /// Of some nodes. @param first  from 0
  std::vector<double> coordinate(const int direction, const GO first, const GO count) const
  {
    std::vector<double> values(count);
    std::array<double *, 3> by_direction{};
    by_direction[direction] = values.data();
    if (count > 0 && ex_get_partial_coord(id_, first + 1, count, by_direction[0], by_direction[1], by_direction[2]) < 0)
      values.clear();
    return values;
  }
  /// @param kind  EX_NODAL, or EX_ELEM_BLOCK for those that cells have
  std::vector<std::string> field_names(const ex_entity_type kind) const
  {
    int count = 0;
    if (ex_get_variable_param(id_, kind, &count) < 0) return {};
    std::vector<std::vector<char>> buffers(count, std::vector<char>(MAX_STR_LENGTH + 1, '\0'));
    std::vector<char *> pointers;
    for (auto &buffer : buffers) pointers.push_back(buffer.data());
    if (count > 0 && ex_get_variable_names(id_, kind, count, pointers.data()) < 0) return {};
    return {pointers.begin(), pointers.end()};
  }
  /// At some nodes. @param step  from 1   @param index  of the field   @param first  node, from 0
  std::vector<double> field(const int step, const int index, const GO first, const GO count) const
  {
    std::vector<double> values(count);
    if (count > 0 && ex_get_partial_var(id_, step, EX_NODAL, index + 1, 1, first + 1, count, values.data()) < 0)
      values.clear();
    return values;
  }
  /// At all cells, block by block. @param step  from 1   @param index  of the field
  std::vector<double> cell_field(const int step, const int index) const
  {
    std::vector<double> all;
    for (int block = 1; block <= ex_inquire_int(id_, EX_INQ_ELEM_BLK); ++block) {
      ex_block of{};
      of.id = block;
      of.type = EX_ELEM_BLOCK;
      if (ex_get_block_param(id_, &of) < 0) return {};
      if (of.num_entry == 0) continue;
      std::vector<double> values(of.num_entry);
      if (ex_get_var(id_, step, EX_ELEM_BLOCK, index + 1, block, of.num_entry, values.data()) < 0) return {};
      all.insert(all.end(), values.begin(), values.end());
    }
    return all;
  }
  /// @param index  of the array among those that ExodusFile was given
  std::optional<std::vector<double>> array(const int index) const
  {
    int entries = 0, factors = 0;
    if (ex_get_set_param(id_, EX_NODE_SET, index + 1, &entries, &factors) != 0 || factors < 0) return std::nullopt;
    std::vector<double> values(factors);
    if (factors > 0 && ex_get_set_dist_fact(id_, EX_NODE_SET, index + 1, values.data()) < 0) return std::nullopt;
    return values;
  }
  /// The information records; none if one cannot be read.
  std::vector<std::string> info() const
  {
    const auto count = ex_inquire_int(id_, EX_INQ_INFO);
    std::vector<std::vector<char>> buffers(count > 0 ? count : 0, std::vector<char>(MAX_LINE_LENGTH + 1, '\0'));
    std::vector<char *> pointers;
    for (auto &buffer : buffers) pointers.push_back(buffer.data());
    if (buffers.empty() || ex_get_info(id_, pointers.data()) < 0) return {};
    return {pointers.begin(), pointers.end()};
  }

private:
  explicit ExodusReader(const int id) : id_(id) {}

  int id_;
};

} // namespace rpc::io
