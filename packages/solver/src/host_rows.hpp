#pragma once

#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc::solver
{

/// Some of a matrix's own rows, on the host.
struct HostRows {
  std::vector<std::size_t> begin{0}; // (rows + 1) where a row's entries begin here
  HostView<std::size_t *> first;     // (rows)     and among all of the matrix
  HostView<LO *> column;             // (entries)  local
  HostView<double *> value;          // (entries)
};

/// Only these rows leave the device. @param rows  local
HostRows host_rows(const CrsMatrix &A, const std::vector<LO> &rows);

} // namespace rpc::solver
