// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/core/graph.hpp"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>

namespace graph_test
{
namespace
{

using rpc::Lists;

/// A path through `length` nodes, numbered by a step that scatters neighbours, and as many nodes by themselves.
Lists path(const int length, const int alone)
{
  std::vector<std::vector<int>> neighbours(length + alone);
  const auto number = [&](const int k) { return (3 * k) % length; };
  for (int k = 0; k + 1 < length; ++k) {
    neighbours[number(k)].push_back(number(k + 1));
    neighbours[number(k + 1)].push_back(number(k));
  }
  Lists graph;
  for (const auto &list : neighbours) {
    graph.value.insert(graph.value.end(), list.begin(), list.end());
    graph.begin.push_back(graph.value.size());
  }
  return graph;
}

TEST(ReverseCuthillMckee, PutsNeighboursSideBySide)
{
  const Lists graph = path(10, 3);
  const auto order = rpc::reverse_cuthill_mckee(graph);
  ASSERT_EQ(order.size(), 13U);
  std::vector<int> place(13, -1);
  for (int at = 0; at < 13; ++at) place[order[at]] = at;
  EXPECT_EQ(std::count(place.begin(), place.end(), -1), 0) << "each node once";
  for (int node = 0; node < graph.size(); ++node)
    for (const int *other = graph.first(node); other != graph.last(node); ++other)
      EXPECT_EQ(std::abs(place[node] - place[*other]), 1) << node;
}

} // namespace
} // namespace graph_test
