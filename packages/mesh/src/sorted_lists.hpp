// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/graph.hpp"

#include <numeric>
#include <vector>

namespace rpc::mesh
{

/// Numbers 0, 1, ... in the lists that `list_of` names for them, ascending in each.
inline Lists sorted_into_lists(const std::vector<int> &list_of, const int num_lists)
{
  Lists lists;
  lists.begin.assign(num_lists + 1, 0);
  for (const int list : list_of) ++lists.begin[list + 1];
  std::partial_sum(lists.begin.begin(), lists.begin.end(), lists.begin.begin());
  lists.value.resize(list_of.size());
  std::vector<std::size_t> next(lists.begin.begin(), lists.begin.end() - 1);
  for (std::size_t n = 0; n < list_of.size(); ++n) lists.value[next[list_of[n]]++] = static_cast<int>(n);
  return lists;
}

} // namespace rpc::mesh
