// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid/host_rows.hpp"

#include "rpc/core/device_values.hpp"

namespace rpc::solver
{
namespace
{

/// Rows of a matrix, a value for each column.
struct EntriesOfRows {
  CrsMatrix::local_matrix_device_type A;
  DeviceView<LO *> row;

  KOKKOS_FUNCTION LO size(const LO i) const
  {
    return static_cast<LO>(A.graph.row_map(row(i) + 1) - A.graph.row_map(row(i)));
  }
  KOKKOS_FUNCTION LO column(const LO i, const LO e) const { return A.graph.entries(A.graph.row_map(row(i)) + e); }
  KOKKOS_FUNCTION double value(const LO i, const LO e, int) const { return A.values(A.graph.row_map(row(i)) + e); }
};

/// Rows of nodes, a block for each column.
struct BlocksOfNodes {
  RepeatedRows::Blocks blocks;
  DeviceView<LO *> node;

  KOKKOS_FUNCTION LO size(const LO i) const { return blocks.size(node(i)); }
  KOKKOS_FUNCTION LO column(const LO i, const LO b) const { return blocks.column(node(i), b); }
  KOKKOS_FUNCTION double value(const LO i, const LO b, const int k) const
  {
    return blocks.entry(node(i), b, k / blocks.dim, k % blocks.dim);
  }
};

/// @param n  rows   @param width  values of a column
template <class Rows>
HostRows picked(const Rows &rows, const LO n, const int width)
{
  const DeviceView<LO *> size("rpc::solver::picked_size", n);
  Kokkos::parallel_for(
      "rpc::solver::picked_sizes", device_range(n), KOKKOS_LAMBDA(const LO i) { size(i) = rows.size(i); });
  Kokkos::fence();
  HostRows result;
  const auto sizes = to_host(size);
  for (LO i = 0; i < n; ++i) result.begin.push_back(result.begin.back() + sizes(i));
  const auto begin = device_values(result.begin, "rpc::solver::picked_begin");
  const DeviceView<LO *> column("rpc::solver::picked_column", result.begin.back());
  const DeviceView<double *> value("rpc::solver::picked_value", width * result.begin.back());
  Kokkos::parallel_for(
      "rpc::solver::pick_rows", device_range(n), KOKKOS_LAMBDA(const LO i) {
        for (LO e = 0; e < size(i); ++e) {
          const std::size_t to = begin(i) + e;
          column(to) = rows.column(i, e);
          for (int k = 0; k < width; ++k) value(width * to + k) = rows.value(i, e, k);
        }
      });
  Kokkos::fence();
  result.column = to_host(column);
  result.value = to_host(value);
  return result;
}

} // namespace

HostRows host_rows(const CrsMatrix &A, const std::vector<LO> &rows)
{
  return picked(EntriesOfRows{A.getLocalMatrixDevice(), device_values(rows, "rpc::solver::picked_rows")},
                static_cast<LO>(rows.size()), 1);
}

HostRows host_blocks(const RepeatedRows &rows, const std::vector<LO> &nodes)
{
  return picked(BlocksOfNodes{rows.blocks(), device_values(nodes, "rpc::solver::picked_nodes")},
                static_cast<LO>(nodes.size()), rows.dim() * rows.dim());
}

} // namespace rpc::solver
