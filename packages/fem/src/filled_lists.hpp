// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "offsets.hpp"

/// Lists that threads fill: cells around nodes, cells in bins.
namespace rpc::fem
{

/// Whether one thread runs all kernels: then cells one after the other have an order, and no need of lists.
#ifdef KOKKOS_ENABLE_SERIAL
constexpr bool one_thread = std::is_same_v<ExecutionSpace, Kokkos::Serial>;
#else
constexpr bool one_thread = false;
#endif

struct FilledLists {
  DeviceView<std::size_t *> row; ///< (lists + 1) where each begins
  DeviceView<LO *> item;         ///< (entries) ascending in each list
};

/// Counts the items of each list.
template <class EachList>
struct CountItems {
  EachList each_list;    // in
  DeviceView<LO *> size; // (lists)  out

  KOKKOS_FUNCTION void operator()(const LO item) const
  {
    each_list(item, [&](const LO list) { Kokkos::atomic_add(&size(list), 1); });
  }
};

/// Puts the items into their lists, in no order.
template <class EachList>
struct FillLists {
  EachList each_list;            // in
  DeviceView<std::size_t *> row; // in
  DeviceView<LO *> filled;       // (lists)  inout, 0 at first
  DeviceView<LO *> item;         // out

  KOKKOS_FUNCTION void operator()(const LO i) const
  {
    each_list(i, [&](const LO list) { item(row(list) + Kokkos::atomic_fetch_add(&filled(list), 1)) = i; });
  }
};

/// Brings each list into ascending order; short lists.
struct SortList {
  DeviceView<std::size_t *> row; // in
  DeviceView<LO *> item;         // inout

  KOKKOS_FUNCTION void operator()(const LO list) const
  {
    for (std::size_t end = row(list) + 1; end < row(list + 1); ++end) {
      const LO moved = item(end);
      std::size_t at = end;
      for (; at > row(list) && item(at - 1) > moved; --at) item(at) = item(at - 1);
      item(at) = moved;
    }
  }
};

/// Lists of items, the same on any number of threads.
/// @param each_list  a functor: each_list(item, add) calls add(list) for each list that the item belongs to
template <class EachList>
FilledLists filled_lists(const LO num_lists, const LO num_items, const EachList &each_list)
{
  const DeviceView<LO *> size("rpc::fem::list_size", num_lists);
  Kokkos::parallel_for("rpc::fem::count_items", device_range(num_items), CountItems<EachList>{each_list, size});
  FilledLists lists;
  lists.row = offsets_of(size, "rpc::fem::list_row");
  lists.item = DeviceView<LO *>("rpc::fem::list_items", last_of(lists.row));
  Kokkos::deep_copy(size, 0);
  Kokkos::parallel_for("rpc::fem::fill_lists", device_range(num_items),
                       FillLists<EachList>{each_list, lists.row, size, lists.item});
  if (!one_thread) // one thread takes the items in order
    Kokkos::parallel_for("rpc::fem::sort_lists", device_range(num_lists), SortList{lists.row, lists.item});
  return lists;
}

} // namespace rpc::fem
