// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/graph.hpp"

#include <algorithm>
#include <utility>

namespace rpc
{
namespace
{

/// A connected part of a graph, breadth first.
struct Sweep {
  std::vector<int> nodes;
  int depth = 0;              // number of levels
  std::size_t last_level = 0; // where it begins in `nodes`
};

Sweep breadth_first(const Lists &graph, const int start, std::vector<char> &seen)
{
  Sweep sweep{{start}};
  seen[start] = 1;
  for (std::size_t level = 0, end = 1; level < end; level = end, end = sweep.nodes.size()) {
    ++sweep.depth;
    sweep.last_level = level;
    for (std::size_t n = level; n < end; ++n)
      for (const int *other = graph.first(sweep.nodes[n]); other != graph.last(sweep.nodes[n]); ++other)
        if (!seen[*other]) {
          seen[*other] = 1;
          sweep.nodes.push_back(*other);
        }
  }
  return sweep;
}

} // namespace

std::vector<int> reverse_cuthill_mckee(Lists graph)
{
  const auto lower_degree = [&](const int a, const int b) {
    return std::pair(graph.size_of(a), a) < std::pair(graph.size_of(b), b);
  };
  for (int n = 0; n < graph.size(); ++n) std::sort(graph.first(n), graph.last(n), lower_degree);

  std::vector<int> order;
  std::vector<char> seen(graph.size(), 0);
  for (int n = 0; n < graph.size(); ++n) {
    if (seen[n]) continue;
    Sweep sweep = breadth_first(graph, n, seen);
    for (int depth = 0; sweep.depth > depth;) { // from end to end, until they move apart no more
      depth = sweep.depth;
      const int end = *std::min_element(sweep.nodes.begin() + sweep.last_level, sweep.nodes.end(), lower_degree);
      for (const int node : sweep.nodes) seen[node] = 0;
      sweep = breadth_first(graph, end, seen);
    }
    order.insert(order.end(), sweep.nodes.begin(), sweep.nodes.end());
  }
  std::reverse(order.begin(), order.end());
  return order;
}

} // namespace rpc
