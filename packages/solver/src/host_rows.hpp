#pragma once

#include "rpc/algebra/repeated_rows.hpp"
#include "rpc/core/tpetra.hpp"

#include <vector>

namespace rpc::solver
{

/// Some of a matrix's own rows, on the host.
struct HostRows {
  std::vector<std::size_t> begin{0}; // (rows + 1) where a row's entries begin here
  HostView<LO *> column;             // (entries)  local
  HostView<double *> value;          // (entries)
};

/// Only these rows leave the device. @param rows  local
HostRows host_rows(const CrsMatrix &A, const std::vector<LO> &rows);

/// The blocks in the rows of some owned nodes, on the host.
struct HostBlocks {
  std::vector<std::size_t> begin{0}; // (nodes + 1) where a node's blocks begin
  HostView<LO *> column;             // (blocks)           node, overlap lid
  HostView<double *> value;          // (blocks, dim, dim)
};

/// Only these leave the device. @param nodes  lids
HostBlocks host_blocks(const RepeatedRows &rows, const std::vector<LO> &nodes);

} // namespace rpc::solver
