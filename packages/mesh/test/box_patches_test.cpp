// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/box_patches.hpp"

#include "rpc/core/tpetra.hpp"
#include "rpc/mesh/box_grid.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <vector>

namespace box_patches_test
{
namespace
{

using namespace rpc;
using mesh::BoxOptions;
using mesh::Element;
using mesh::Index;

const std::vector<BoxOptions> boxes{{{0, 0}, {7, 4}, {7, 4}, Element{2, 2}},
                                    {{0, 0, 0}, {5, 6, 3}, {5, 6, 3}, Element{3, 2}},
                                    {{0, 0, 0}, {5, 6, 30}, {5, 6, 3}, Element{3, 2}}}; // halved in x and y alone

/// How often each node of the box is in the patches of all ranks.
std::vector<int> occurrences(const NodePatches &patches, const GO num_nodes)
{
  std::vector<int> mine(num_nodes), all(num_nodes);
  for (const GO gid : patches.node) ++mine[gid];
  Teuchos::reduceAll(*Tpetra::getDefaultComm(), Teuchos::REDUCE_SUM, static_cast<int>(num_nodes), mine.data(),
                     all.data());
  return all;
}

void for_each_node(const BoxOptions &box, const std::function<void(const Index &, GO)> &take)
{
  const mesh::Grid grid(box, Tpetra::getDefaultComm()->getSize());
  Index at{}, end{{1, 1, 1}};
  for (int d = 0; d < box.element.dim; ++d) end[d] = box.intervals(d) + 1;
  for (at[2] = 0; at[2] < end[2]; ++at[2])
    for (at[1] = 0; at[1] < end[1]; ++at[1])
      for (at[0] = 0; at[0] < end[0]; ++at[0]) take(at, grid.node_gid(at));
}

GO num_nodes(const BoxOptions &box)
{
  return mesh::Grid(box, Tpetra::getDefaultComm()->getSize()).num_nodes_total();
}

TEST(HalvedBox, KeepsTheElement)
{
  const auto coarse = mesh::halved({{0, 0, 0}, {7, 4, 30}, {7, 4, 3}, Element{3, 2}});
  ASSERT_TRUE(coarse);
  EXPECT_EQ(coarse->cells, (std::vector<int>{3, 2, 3}));
  EXPECT_EQ(coarse->last, (std::vector<double>{1.5, 1, 1}));
  EXPECT_TRUE(coarse->element == (Element{3, 2}));
  EXPECT_FALSE(mesh::halved({{0, 0}, {1, 2}, {1, 1}, Element{2, 2}}));
  EXPECT_EQ(mesh::halved({{0, 0}, {1, 8}, {1, 4}, Element{2, 2}})->cells, (std::vector<int>{1, 2}))
      << "a direction of one cell does not count";
}

/// A node that is no vertex in k directions is in the stars of the 2^k vertices beside it.
TEST(VertexStars, HoldTheNodesInsideTheCellsAroundAVertex)
{
  for (const BoxOptions &box : boxes) {
    const NodePatches stars = mesh::vertex_stars(box, *Tpetra::getDefaultComm());
    const auto found = occurrences(stars, num_nodes(box));
    std::map<GO, Index> place;
    for_each_node(box, [&](const Index &at, const GO gid) {
      int expected = 1;
      for (int d = 0; d < box.element.dim; ++d) expected *= at[d] % 2 == 1 ? 2 : 1;
      EXPECT_EQ(found[gid], expected);
      place[gid] = at;
    });
    for (int p = 0; p < stars.size(); ++p) { // all are within one node of the vertex
      for (int d = 0; d < box.element.dim; ++d) {
        std::set<GO> along;
        for (std::size_t e = stars.begin[p]; e < stars.begin[p + 1]; ++e) along.insert(place[stars.node[e]][d]);
        EXPECT_EQ(*along.rbegin() - *along.begin() + 1, static_cast<GO>(along.size()));
        EXPECT_EQ(std::count_if(along.begin(), along.end(), [](const GO at) { return at % 2 == 0; }), 1);
      }
    }
  }
}

/// Each node off the sides of coarse cells is in one patch, with the nodes of its cell alone.
TEST(InsideCells, HoldTheNodesInsideEachCoarseCell)
{
  for (const BoxOptions &box : boxes) {
    const auto halved = mesh::halved(box);
    ASSERT_TRUE(halved);
    const NodePatches inside = mesh::inside_cells_of(*halved, box, *Tpetra::getDefaultComm());
    const auto found = occurrences(inside, num_nodes(box));
    std::map<GO, GO> cell_of;
    for_each_node(box, [&](const Index &at, const GO gid) {
      bool is_inside = true;
      GO cell = 0;
      for (int d = 0; d < box.element.dim; ++d) {
        const int length = halved->cells[d] < box.cells[d] ? 4 : 2; // in nodes
        const GO last = halved->cells[d] - 1, along = std::min<GO>(at[d] / length, last);
        is_inside =
            is_inside && at[d] > length * along && at[d] < (along == last ? box.intervals(d) : length * (along + 1));
        cell = cell * halved->cells[d] + along;
      }
      EXPECT_EQ(found[gid], is_inside ? 1 : 0) << at[0] << " " << at[1] << " " << at[2];
      cell_of[gid] = cell;
    });
    std::set<GO> cells;
    for (int p = 0; p < inside.size(); ++p) {
      const GO cell = cell_of[inside.node[inside.begin[p]]];
      EXPECT_TRUE(cells.insert(cell).second);
      for (std::size_t e = inside.begin[p]; e < inside.begin[p + 1]; ++e) EXPECT_EQ(cell_of[inside.node[e]], cell);
    }
  }
}

} // namespace
} // namespace box_patches_test
