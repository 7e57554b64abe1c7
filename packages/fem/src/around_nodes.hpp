// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "filled_lists.hpp"
#include "rpc/fem/discretization.hpp"

/// Lists of cells or facets around nodes: a sum at a node runs over its list, in one order on any number of threads.
namespace rpc::fem
{

/// Place of a node in one of its cells or facets.
KOKKOS_INLINE_FUNCTION int place_in(const DeviceView<LO **> &cells, const LO cell, const LO node)
{
  int a = 0;
  while (cells(cell, a) != node) ++a;
  return a;
}

/// The owned nodes of each cell or facet.
struct NodesOfCells {
  DeviceView<LO **> cells; // (cells or facets, nodes) overlap lids  in
  LO num_owned;

  template <class Add>
  KOKKOS_INLINE_FUNCTION void operator()(const LO cell, const Add &add) const
  {
    for (std::size_t a = 0; a < cells.extent(1); ++a)
      if (cells(cell, a) < num_owned) add(cells(cell, a));
  }
};

/// @param cells  (cells or facets, nodes) overlap lids
inline NodeToCells around_nodes(const DeviceView<LO **> &cells, const LO num_owned)
{
  const FilledLists lists = filled_lists(num_owned, static_cast<LO>(cells.extent(0)), NodesOfCells{cells, num_owned});
  return {lists.row, lists.item};
}

} // namespace rpc::fem
