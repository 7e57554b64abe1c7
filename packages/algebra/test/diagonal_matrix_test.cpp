// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/diagonal_matrix.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

namespace diagonal_matrix_test
{
namespace
{

using namespace rpc;

TEST(DiagonalMatrix, MultipliesEachEntryByItsOwn)
{
  const auto comm = Tpetra::getDefaultComm();
  const auto map = rcp(new Map(5 * comm->getSize(), 5, 0, comm));
  Vector diagonal(map), x(map), y(map);
  for (LO i = 0; i < 5; ++i) {
    diagonal.replaceLocalValue(i, i == 3 ? 0. : static_cast<double>(map->getGlobalElement(i)) - 2);
    x.replaceLocalValue(i, 10. + i);
  }
  const auto A = diagonal_matrix(diagonal);
  A->apply(x, y);
  for (LO i = 0; i < 5; ++i) EXPECT_EQ(y.getData()[i], diagonal.getData()[i] * x.getData()[i]);
  EXPECT_EQ(A->getGlobalNumEntries(), 5u * comm->getSize());
}

} // namespace
} // namespace diagonal_matrix_test
