// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

#include <cstddef>
#include <string>

namespace rpc
{

/// The rows that have entries, and where these begin in a list, row after row.
struct SparseRows {
  DeviceView<LO *> row;            ///< (rows) ascending
  DeviceView<std::size_t *> begin; ///< (rows + 1)
  std::size_t num_entries = 0;
};

/// @param count  (all rows) entries of each row, >= 0
/// @param label  of the views
inline SparseRows sparse_rows(const DeviceView<LO *> &count, const std::string &label)
{
  const LO n = static_cast<LO>(count.extent(0));
  LO num_rows = 0;
  Kokkos::parallel_reduce(
      label + "_count", device_range(n), KOKKOS_LAMBDA(const LO i, LO &rows) { rows += count(i) > 0; }, num_rows);
  const DeviceView<LO *> row(label + "_row", num_rows);
  Kokkos::parallel_scan(
      label + "_rows", device_range(n), KOKKOS_LAMBDA(const LO i, LO &next, const bool last) {
        if (count(i) == 0) return;
        if (last) row(next) = i;
        ++next;
      });
  const DeviceView<std::size_t *> begin(label + "_begin", num_rows + 1);
  std::size_t num_entries = 0;
  Kokkos::parallel_scan(
      label + "_begins", device_range(num_rows),
      KOKKOS_LAMBDA(const LO i, std::size_t &sum, const bool last) {
        sum += count(row(i));
        if (last) begin(i + 1) = sum;
      },
      num_entries);
  return {row, begin, num_entries};
}

} // namespace rpc
