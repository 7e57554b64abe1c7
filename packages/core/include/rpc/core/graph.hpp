// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace rpc
{

/// Lists of numbers one behind the other: list i is value[begin[i]] .. value[begin[i + 1] - 1].
struct Lists {
  std::vector<std::size_t> begin{0};
  std::vector<int> value;

  int size() const { return static_cast<int>(begin.size()) - 1; }
  int size_of(const int list) const { return static_cast<int>(begin[list + 1] - begin[list]); }
  int *first(const int list) { return value.data() + begin[list]; }
  int *last(const int list) { return value.data() + begin[list + 1]; }
  const int *first(const int list) const { return value.data() + begin[list]; }
  const int *last(const int list) const { return value.data() + begin[list + 1]; }
};

/// The nodes of a graph in the reverse Cuthill-McKee order, which puts neighbours close to each other: breadth first
/// from one end of each connected part, backwards. (E. Cuthill, J. McKee, 1969; the ends: A. George, J. Liu, 1979.)
/// @param graph  of each node its neighbours, without itself; symmetric
/// @return (nodes) node at each place
std::vector<int> reverse_cuthill_mckee(Lists graph);

} // namespace rpc
