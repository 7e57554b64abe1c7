#pragma once

#include "offsets.hpp"
#include "rpc/fem/discretization.hpp"

/// Lists of cells or facets around nodes: a sum at a node runs over its list, in one order on any number of threads.
namespace rpc::fem
{

/// Whether one thread runs all kernels: then cells one after the other have an order, and no need of lists.
#ifdef KOKKOS_ENABLE_SERIAL
constexpr bool one_thread = std::is_same_v<ExecutionSpace, Kokkos::Serial>;
#else
constexpr bool one_thread = false;
#endif

/// Whether kernels run beside the host, with memory of their own.
constexpr bool on_gpu = !std::is_same_v<MemorySpace, Kokkos::HostSpace>;

/// Lists that threads have filled, each ascending.
inline void sort_lists(const DeviceView<std::size_t *> &row, const DeviceView<LO *> &list)
{
  if (one_thread) return; // they are
  Kokkos::parallel_for(
      "rpc::fem::sort_lists", device_range(static_cast<LO>(row.extent(0)) - 1), KOKKOS_LAMBDA(const LO n) {
        for (std::size_t end = row(n) + 1; end < row(n + 1); ++end) {
          const LO moved = list(end);
          std::size_t at = end;
          for (; at > row(n) && list(at - 1) > moved; --at) list(at) = list(at - 1);
          list(at) = moved;
        }
      });
}

/// Place of a node in one of its cells or facets.
KOKKOS_INLINE_FUNCTION int place_in(const DeviceView<LO **> &cells, const LO cell, const LO node)
{
  int a = 0;
  while (cells(cell, a) != node) ++a;
  return a;
}

/// @param cells  (cells or facets, nodes) overlap lids
inline NodeToCells around_nodes(const DeviceView<LO **> &cells, const LO num_owned)
{
  const LO num_cells = static_cast<LO>(cells.extent(0));
  const int nodes = static_cast<int>(cells.extent(1));
  const DeviceView<LO *> count("rpc::fem::cells_per_node", num_owned);
  Kokkos::parallel_for(
      "rpc::fem::count_cells", device_range(num_cells), KOKKOS_LAMBDA(const LO cell) {
        for (int a = 0; a < nodes; ++a)
          if (cells(cell, a) < num_owned) Kokkos::atomic_increment(&count(cells(cell, a)));
      });
  NodeToCells node_to_cells;
  node_to_cells.row = offsets_of(count, "rpc::fem::node_cells_row");
  node_to_cells.cell = DeviceView<LO *>("rpc::fem::node_cells", last_of(node_to_cells.row));
  Kokkos::deep_copy(count, 0);
  const auto row = node_to_cells.row;
  const auto list = node_to_cells.cell;
  Kokkos::parallel_for(
      "rpc::fem::list_cells", device_range(num_cells), KOKKOS_LAMBDA(const LO cell) {
        for (int a = 0; a < nodes; ++a) {
          const LO node = cells(cell, a);
          if (node < num_owned) list(row(node) + Kokkos::atomic_fetch_add(&count(node), 1)) = cell;
        }
      });
  sort_lists(row, list);
  return node_to_cells;
}

} // namespace rpc::fem
