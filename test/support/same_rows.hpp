// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/algebra/repeated_rows.hpp"

#include <gtest/gtest.h>

namespace rpc::test
{

/// (nodes; blocks of a row; column's node and entries), as kernels see them.
inline DeviceView<double ***> listed(const RepeatedRows &rows)
{
  const RepeatedRows::Blocks blocks = rows.blocks();
  const int dim = blocks.dim;
  constexpr int most = 125; // Q2 in space
  const DeviceView<double ***> list("rpc::test::listed", rows.num_nodes(), most, 1 + dim * dim);
  Kokkos::parallel_for(
      "rpc::test::list", device_range(rows.num_nodes()), KOKKOS_LAMBDA(const LO node) {
        for (LO n = 0; n < blocks.size(node); ++n) {
          list(node, n, 0) = blocks.column(node, n);
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j) list(node, n, 1 + dim * i + j) = blocks.entry(node, n, i, j);
        }
      });
  Kokkos::fence();
  return list;
}

/// Bit for bit those of a matrix, on this rank.
inline void expect_same_rows(const RepeatedRows &rows, const CrsMatrix &A)
{
  const int dim = rows.dim();
  const auto matrix = A.getLocalMatrixHost();
  const auto list = to_host(listed(rows));
  const NodeBlocks blocks = diagonal_blocks(rows);
  const auto diagonal = to_host(blocks.block);
  const auto place = to_host(blocks.place);
  ASSERT_EQ(rows.num_nodes(), matrix.numRows() / dim);
  int wrong = 0;
  for (LO row = 0; row < matrix.numRows(); ++row)
    for (auto e = matrix.graph.row_map(row); e < matrix.graph.row_map(row + 1); ++e) {
      const LO node = row / dim, column = matrix.graph.entries(e);
      const int at = static_cast<int>(e - matrix.graph.row_map(row)), i = row % dim, j = at % dim;
      wrong += dim * list(node, at / dim, 0) + j != column;
      wrong += list(node, at / dim, 1 + dim * i + j) != matrix.values(e);
      if (column / dim == node) wrong += diagonal(place.extent(0) == 0 ? node : place(node), i, j) != matrix.values(e);
    }
  EXPECT_EQ(wrong, 0);
}

} // namespace rpc::test
