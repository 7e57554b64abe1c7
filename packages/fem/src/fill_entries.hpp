// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/discretization.hpp"

#include <limits>
#include <string>

/// The rows of a matrix's nodes, filled entry by entry.
namespace rpc::fem
{

/// One entry in the rows of some nodes: neighbouring threads of a GPU write neighbouring entries. With a thread for each row they
/// would write to as many cache lines at once.
/// @tparam Source  has(node), whether the node's rows are to be filled, and value(node, entry), what their entry is
/// @tparam Index  holds all items; the divisions of 32 bits take less time than the memory
/// @tparam batch  nodes of an item: as many loads are under way at once
template <int Dim, int batch, class Source, class Values, class Index>
struct FillEntries {
  NodeGraph nodes; // in
  LO num_nodes;    // owned
  Index most;      // entries in the rows of any node
  Source source;   // in
  Values values;   // (matrix entries)  out

  /// @param item  node / batch * most + entry in the node's rows
  KOKKOS_FUNCTION void operator()(const Index item) const
  {
    const Index group = item / most;
    const std::size_t entry = item - group * most;
    const LO first = static_cast<LO>(group) * batch;
    typename Values::non_const_value_type value[batch] = {};
    std::size_t at[batch];
    bool has[batch];
    for (int n = 0; n < batch; ++n) {
      const LO node = first + n;
      has[n] = node < num_nodes && source.has(node);
      const std::size_t begin = has[n] ? nodes.row(node) : 0;
      has[n] = has[n] && entry < Dim * Dim * (nodes.row(node + 1) - begin);
      at[n] = Dim * Dim * begin + entry;
      if (has[n]) value[n] = source.value(node, entry);
    }
    for (int n = 0; n < batch; ++n)
      if (has[n]) values(at[n]) = value[n];
  }
};

/// Nodes that share a cell with a node, at most on this rank.
inline std::size_t longest_row(const NodeGraph &nodes)
{
  std::size_t longest = 0;
  Kokkos::parallel_reduce(
      "rpc::fem::longest_row", device_range(static_cast<LO>(nodes.row.extent(0)) - 1),
      KOKKOS_LAMBDA(const LO node, std::size_t &most) {
        const std::size_t length = nodes.row(node + 1) - nodes.row(node);
        if (length > most) most = length;
      },
      Kokkos::Max<std::size_t>(longest));
  return longest;
}

/// values(entry of the matrix) = source's, for the rows of all nodes that it has. Does not fence.
template <int Dim, class Source, class Values>
void fill_entries(const std::string &label, const NodeGraph &nodes, const Source &source, const Values &values)
{
  const LO num_nodes = static_cast<LO>(nodes.row.extent(0)) - 1;
  constexpr int batch = 4;
  const std::size_t most = Dim * Dim * longest_row(nodes), batches = (std::size_t(num_nodes) + batch - 1) / batch,
                    items = batches * most;
  const auto run = [&](auto index) {
    using Index = decltype(index);
    const FillEntries<Dim, batch, Source, Values, Index> fill{nodes, num_nodes, static_cast<Index>(most), source,
                                                              values};
    const Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<Index>> range(0, static_cast<Index>(items));
    Kokkos::parallel_for(label, range, fill);
  };
  if (items <= std::numeric_limits<unsigned>::max() / 2) // Kokkos adds a block of threads
    run(0U);
  else
    run(std::size_t{0});
}

} // namespace rpc::fem
