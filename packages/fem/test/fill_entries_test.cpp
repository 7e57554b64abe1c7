// SPDX-License-Identifier: BSD-3-Clause
#include "fill_entries.hpp"

#include "rpc/core/device_values.hpp"

#include <gtest/gtest.h>

namespace fill_entries_test
{
namespace
{

using namespace rpc;

/// entry + 1000 node, for nodes that are no multiple of 3.
struct Numbers {
  KOKKOS_FUNCTION bool has(const LO node) const { return node % 3 != 0; }
  KOKKOS_FUNCTION double value(const LO node, const std::size_t entry) const { return 1000. * node + entry; }
};

using Values = DeviceView<double *>;

/// Rows of 2 and 3 nodes by turns, of 0 for node 4; as many nodes as asked for.
fem::NodeGraph graph(const LO num_nodes)
{
  std::vector<std::size_t> row{0};
  for (LO n = 0; n < num_nodes; ++n) row.push_back(row.back() + (n == 4 ? 0 : 2 + n % 2));
  return {device_values(row, "row"), {}};
}

template <int Dim>
void expect_numbers(const fem::NodeGraph &nodes, const Values &values)
{
  const auto row = to_host(nodes.row);
  const auto found = to_host(values);
  for (LO n = 0; n + 1 < static_cast<LO>(row.extent(0)); ++n)
    for (std::size_t k = Dim * Dim * row(n); k < Dim * Dim * row(n + 1); ++k)
      EXPECT_EQ(found(k), n % 3 == 0 ? -1 : 1000. * n + (k - Dim * Dim * row(n))) << n << " " << k;
}

Values untouched(const fem::NodeGraph &nodes, const int dim)
{
  const Values values("values", dim * dim * to_host(nodes.row)(nodes.row.extent(0) - 1));
  Kokkos::deep_copy(values, -1.);
  return values;
}

TEST(FillEntries, WritesTheRowsOfTheSourcesNodesAndNoOthers)
{
  for (const LO num_nodes : {0, 1, 3, 4, 5, 9}) {
    const auto nodes = graph(num_nodes);
    const auto plane = untouched(nodes, 2), space = untouched(nodes, 3);
    fem::fill_entries<2>("plane", nodes, Numbers(), plane);
    fem::fill_entries<3>("space", nodes, Numbers(), space);
    Kokkos::fence();
    expect_numbers<2>(nodes, plane);
    expect_numbers<3>(nodes, space);
  }
}

TEST(FillEntries, IsTheSameWithIndicesOf64Bits)
{
  const auto nodes = graph(9);
  const auto values = untouched(nodes, 2);
  const std::size_t most = 4 * 3;
  const fem::FillEntries<2, 4, Numbers, Values, std::size_t> fill{nodes, 9, most, Numbers(), values};
  Kokkos::parallel_for(Kokkos::RangePolicy<ExecutionSpace, Kokkos::IndexType<std::size_t>>(0, 3 * most), fill);
  Kokkos::fence();
  expect_numbers<2>(nodes, values);
}

} // namespace
} // namespace fill_entries_test
