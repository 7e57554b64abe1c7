// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/dofs.hpp"
#include "rpc/core/tpetra.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <vector>

namespace rpc::test
{

/// A matrix that every rank has, row after row.
struct Dense {
  int rows = 0, columns = 0;
  std::vector<double> value;

  Dense(const int m, const int n) : rows(m), columns(n), value(static_cast<std::size_t>(m) * n) {}
  double &operator()(const GO i, const GO j) { return value[i * columns + j]; }
  double operator()(const GO i, const GO j) const { return value[i * columns + j]; }
};

inline Dense product(const Dense &a, const Dense &b)
{
  Dense c(a.rows, b.columns);
  for (int i = 0; i < a.rows; ++i)
    for (int k = 0; k < a.columns; ++k)
      for (int j = 0; j < b.columns; ++j) c(i, j) += a(i, k) * b(k, j);
  return c;
}

/// Nodes 0 to n - 1 on a line; ranks share them in order.
inline RCP<const Map> line_of(const int n)
{
  return rcp(new Map(n, 0, Tpetra::getDefaultComm()));
}
inline RCP<const Map> unknowns_of(const Map &nodes, const int dim = 2)
{
  return rcp(new Map(dim * nodes.getGlobalNumElements(), dim * static_cast<std::size_t>(num_local(nodes)), 0,
                     nodes.getComm()));
}

/// Linear interpolation between nodes that divide the same line into equal parts.
inline Dense dense_interpolation(const int fine, const int coarse)
{
  Dense P(fine, coarse);
  for (int i = 0; i < fine; ++i) {
    const double at = static_cast<double>(i) * (coarse - 1) / (fine - 1);
    const int left = std::min(static_cast<int>(at), coarse - 2);
    const double weight = at - left;
    if (weight < 1) P(i, left) = 1 - weight;
    if (weight > 0) P(i, left + 1) = weight;
  }
  return P;
}
inline RCP<CrsMatrix> distributed(const Dense &a, const RCP<const Map> &rows, const RCP<const Map> &columns)
{
  const auto A = rcp(new CrsMatrix(rows, a.columns));
  for (LO i = 0; i < num_local(*rows); ++i) {
    const GO row = rows->getGlobalElement(i);
    for (int j = 0; j < a.columns; ++j)
      if (a(row, j) != 0) A->insertGlobalValues(row, Teuchos::tuple<GO>(j), Teuchos::tuple(a(row, j)));
  }
  A->fillComplete(columns, rows);
  return A;
}

/// Different at each unknown.
inline double wave(const GO unknown, const double phase)
{
  return std::sin(phase + 1.7 * static_cast<double>(unknown));
}
inline Vector wave_on(const RCP<const Map> &map, const double phase)
{
  Vector x(map);
  for (LO i = 0; i < num_local(*map); ++i) x.replaceLocalValue(i, wave(map->getGlobalElement(i), phase));
  return x;
}

} // namespace rpc::test
