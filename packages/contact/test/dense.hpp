// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"

#include <Teuchos_LAPACK.hpp>
#include <gtest/gtest.h>
#include <vector>

/// Small systems of all ranks, solved on each.
namespace rpc::test
{

/// All entries of a vector on every rank, by global id.
inline std::vector<double> everywhere(const Vector &v)
{
  const auto &map = *v.getMap();
  std::vector<double> mine(map.getGlobalNumElements(), 0.), all(mine.size());
  const auto values = v.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LO i = 0; i < num_local(map); ++i) mine.at(map.getGlobalElement(i)) = values(i, 0);
  Teuchos::reduceAll(*map.getComm(), Teuchos::REDUCE_SUM, static_cast<int>(mine.size()), mine.data(), all.data());
  return all;
}

/// The Cholesky factor of a symmetric positive definite matrix, as it is now.
class DenseInverse
{
public:
  explicit DenseInverse(const CrsMatrix &A) : n_(static_cast<int>(A.getGlobalNumRows())), factor_(n_ * n_)
  {
    std::vector<double> mine(factor_.size(), 0.);
    const auto local = A.getLocalMatrixHost();
    for (LO row = 0; row < local.numRows(); ++row)
      for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
        mine.at(A.getRowMap()->getGlobalElement(row) + n_ * A.getColMap()->getGlobalElement(local.graph.entries(k))) =
            local.values(k);
    Teuchos::reduceAll(*A.getComm(), Teuchos::REDUCE_SUM, n_ * n_, mine.data(), factor_.data());
    int info = 0;
    Teuchos::LAPACK<int, double>().POTRF('L', n_, factor_.data(), n_, &info);
    EXPECT_EQ(info, 0) << "not positive definite";
  }
  Vector times(const Vector &b) const
  {
    std::vector<double> x = everywhere(b);
    int info = 0;
    Teuchos::LAPACK<int, double>().POTRS('L', n_, 1, factor_.data(), n_, x.data(), n_, &info);
    Vector result(b.getMap());
    const auto values = result.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (LO i = 0; i < num_local(*b.getMap()); ++i) values(i, 0) = x[b.getMap()->getGlobalElement(i)];
    return result;
  }

private:
  int n_;
  std::vector<double> factor_;
};

} // namespace rpc::test
