// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/repeated_rows.hpp"
#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc::solver
{

/// Rows of a matrix on the host: for each column a value, or a block of values.
struct HostRows {
  std::vector<std::size_t> begin{0}; // (rows + 1) where a row's columns begin
  HostView<LO *> column;             // (columns)  local
  HostView<double *> value;          // (columns, values of a column)
};

/// Some of a matrix's own rows. Only these leave the device. @param rows  local
HostRows host_rows(const CrsMatrix &A, const std::vector<LO> &rows);

/// The blocks in the rows of some owned nodes: columns are nodes (overlap lids), each with dim x dim values, row after row. Only these leave
/// the device. @param nodes  lids
HostRows host_blocks(const RepeatedRows &rows, const std::vector<LO> &nodes);

} // namespace rpc::solver
