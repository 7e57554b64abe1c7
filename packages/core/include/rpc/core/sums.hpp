// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

#include <string>
#include <vector>

/// Sums of several numbers over items. The number of threads alone decides their order, so that a run gives the same bits again; atomic
/// additions do not.
namespace rpc
{

/// Base of functors for Kokkos::parallel_reduce: operator()(item, sum) adds to sum[0] to sum[value_count - 1].
struct NumberSums {
  using value_type = double[];
  using size_type = LO;
  const size_type value_count;

  explicit NumberSums(const size_type count) : value_count(count) {}
  KOKKOS_INLINE_FUNCTION void init(double sum[]) const
  {
    for (size_type k = 0; k < value_count; ++k) sum[k] = 0;
  }
  KOKKOS_INLINE_FUNCTION void join(double sum[], const double part[]) const
  {
    for (size_type k = 0; k < value_count; ++k) sum[k] += part[k];
  }
};

/// The functor of a kernel each(item, sum).
template <class Each>
struct SumsOfEach : NumberSums {
  Each each;

  SumsOfEach(const size_type count, const Each &kernel) : NumberSums(count), each(kernel) {}
  KOKKOS_INLINE_FUNCTION void operator()(const LO item, double sum[]) const { each(item, sum); }
};

/// This rank's sums over a range of items.
/// @param count  of the sums; some dozens at most: the threads of a GPU keep theirs in shared memory
/// @param each   kernel: each(item, sum) adds to sum[0] to sum[count - 1]
template <class Range, class Each>
std::vector<double> sums_over(const std::string &name, const Range &items, const int count, const Each &each)
{
  const DeviceView<double *> sums(name, count);
  Kokkos::parallel_reduce(name, items, SumsOfEach<Each>(count, each), sums);
  const auto host = to_host(sums);
  return {host.data(), host.data() + count};
}

} // namespace rpc
