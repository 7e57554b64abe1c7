// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/node_columns.hpp"

#include "foundation_scene.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace node_columns_test
{
namespace
{

using namespace rpc;
using namespace rpc::test;

/// A value for each point, by its place and its side.
double value_at(const double x, const double y, const int side)
{
  return 1 + x + 10 * y + 100 * side;
}

TEST(NodeColumns, HoldTheValuesOfEachSideAndZeroElsewhere)
{
  const Scene scene(std::vector{below(40), beside(25)});
  const auto &c = scene.iterate->points();
  const auto coords = to_host(scene.d.mesh->coords);
  const auto node = to_host(c.node);
  const DeviceView<double *> values("values", c.size());
  const auto host = Kokkos::create_mirror_view(values);
  for (int side = 0; side < 2; ++side)
    for (LO i = c.first(side); i < c.first(side + 1); ++i)
      host(i) = value_at(coords(node(i), 0), coords(node(i), 1), side);
  Kokkos::deep_copy(values, host);
  const auto columns = contact::node_columns(c, values, scene.d.mesh->owned_nodes);
  ASSERT_EQ(columns->getNumVectors(), 2u);
  const auto found = columns->getLocalViewHost(Tpetra::Access::ReadOnly);
  GO there = 0;
  for (LO n = 0; n < scene.d.mesh->num_owned_nodes(); ++n) {
    const double x = coords(n, 0), y = coords(n, 1);
    EXPECT_EQ(found(n, 0), y == 0 ? value_at(x, y, 0) : 0);
    EXPECT_EQ(found(n, 1), x == 2 ? value_at(x, y, 1) : 0);
    there += (y == 0) + (x == 2);
  }
  EXPECT_EQ(sum_all(scene.d.mesh->comm(), there), 7 + 4); // the corner (2, 0) in both
  const auto back = to_host(contact::at_points(c, *columns));
  for (LO i = 0; i < c.size(); ++i) EXPECT_EQ(back(i), host(i));
}

TEST(NodeColumns, OfVectorsHoldTheirComponentsSideAfterSide)
{
  const Scene scene(std::vector{below(40), beside(25)});
  const auto &c = scene.iterate->points();
  const auto coords = to_host(scene.d.mesh->coords);
  const auto node = to_host(c.node);
  const DeviceView<double **> vectors("vectors", c.size(), 2);
  const auto host = Kokkos::create_mirror_view(vectors);
  for (int side = 0; side < 2; ++side)
    for (LO i = c.first(side); i < c.first(side + 1); ++i)
      for (int k = 0; k < 2; ++k) host(i, k) = value_at(coords(node(i), 0), coords(node(i), 1), side) + 1000 * k;
  Kokkos::deep_copy(vectors, host);
  const auto columns = contact::node_columns(c, vectors, scene.d.mesh->owned_nodes);
  ASSERT_EQ(columns->getNumVectors(), 4u);
  const auto found = columns->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO n = 0; n < scene.d.mesh->num_owned_nodes(); ++n) {
    const double x = coords(n, 0), y = coords(n, 1);
    for (int k = 0; k < 2; ++k) {
      EXPECT_EQ(found(n, k), y == 0 ? value_at(x, y, 0) + 1000 * k : 0);
      EXPECT_EQ(found(n, 2 + k), x == 2 ? value_at(x, y, 1) + 1000 * k : 0);
    }
  }
  const DeviceView<double **> at = contact::vectors_at_points(c, *columns);
  const auto back = Kokkos::create_mirror_view(at);
  Kokkos::deep_copy(back, at);
  for (LO i = 0; i < c.size(); ++i)
    for (int k = 0; k < 2; ++k) EXPECT_EQ(back(i, k), host(i, k));
}

TEST(NodeColumns, AreNoneWithoutSides)
{
  const Scene scene(std::vector<contact::ContactOptions>{});
  const auto &c = scene.iterate->points();
  const auto columns = contact::node_columns(c, DeviceView<double *>("none", 0), scene.d.mesh->owned_nodes);
  EXPECT_EQ(columns->getNumVectors(), 0u);
  EXPECT_EQ(contact::at_points(c, *columns).extent(0), 0u);
}

} // namespace
} // namespace node_columns_test
