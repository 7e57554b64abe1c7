// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/solver/body.hpp"

#include <Teuchos_Array.hpp>
#include <Tpetra_Core.hpp>
#include <cmath>
#include <functional>

namespace rpc::test
{

/// Five-point differences on n x n nodes that are prescribed to be 0 all around, for two unknowns a node that a small spring at
/// each node couples; symmetric, positive definite. Ranks share the nodes in order; the last one has few.
struct Grid {
  /// @param whole_blocks  with entries of 0, for who asks that the rows of a node have equal columns
  explicit Grid(
      const int n, const std::function<GO(GO)> &gid = [](const GO unknown) { return unknown; },
      const bool whole_blocks = false)
  {
    const auto comm = Tpetra::getDefaultComm();
    const GO nodes = GO(n) * n, share = nodes / comm->getSize() + comm->getSize();
    const GO first = std::min(nodes, share * comm->getRank()), last = std::min(nodes, first + share);
    Teuchos::Array<GO> own;
    for (GO node = first; node < last; ++node)
      for (int k = 0; k < 2; ++k) own.push_back(gid(2 * node + k));
    map = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), own(), 0, comm));
    A = rcp(new CrsMatrix(map, 10));
    coordinates = rcp(new MultiVector(
        rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), last - first, 0, comm)), 2));
    null_space = rcp(new MultiVector(map, 2));
    const auto x = coordinates->getLocalViewHost(Tpetra::Access::OverwriteAll);
    const auto modes = null_space->getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (GO node = first; node < last; ++node) {
      const int i = static_cast<int>(node % n), j = static_cast<int>(node / n);
      const LO here = static_cast<LO>(node - first);
      x(here, 0) = i;
      x(here, 1) = j;
      for (int k = 0; k < 2; ++k) {
        modes(2 * here + k, k) = 1;
        modes(2 * here + k, 1 - k) = 0;
        Teuchos::Array<GO> column;
        Teuchos::Array<double> value;
        const auto add = [&](const bool exists, const GO unknown, const double entry) {
          if (!exists) return;
          column.push_back(gid(unknown));
          value.push_back(entry);
          if (!whole_blocks || unknown / 2 == node) return;
          column.push_back(gid(unknown % 2 == 0 ? unknown + 1 : unknown - 1));
          value.push_back(0);
        };
        add(true, 2 * node + k, 4.1);
        add(true, 2 * node + 1 - k, -0.1);
        add(i > 0, 2 * (node - 1) + k, -1);
        add(i + 1 < n, 2 * (node + 1) + k, -1);
        add(j > 0, 2 * (node - n) + k, -1);
        add(j + 1 < n, 2 * (node + n) + k, -1);
        A->insertGlobalValues(gid(2 * node + k), column(), value());
      }
    }
    A->fillComplete();
  }

  /// Of smooth and rough parts.
  Vector right_side() const
  {
    Vector b(map);
    const auto values = b.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (LO row = 0; row < num_local(*map); ++row) {
      const double place = static_cast<double>(map->getGlobalElement(row));
      values(row, 0) = std::sin(0.01 * place) + 0.3 * std::cos(2.7 * place);
    }
    return b;
  }
  /// |A x - b| / |b|
  double relative_residual(const Vector &x, const Vector &b) const
  {
    Vector r(b, Teuchos::Copy);
    A->apply(x, r, Teuchos::NO_TRANS, 1., -1.);
    return r.norm2() / b.norm2();
  }

  solver::Body body() const
  {
    return {2, [at = coordinates] { return at; }, [modes = null_space] { return modes; }};
  }

  RCP<const Map> map; ///< two unknowns a node
  RCP<CrsMatrix> A;
  RCP<MultiVector> coordinates; ///< (nodes, 2)
  RCP<MultiVector> null_space;  ///< (unknowns, 2): each unknown constant
};

} // namespace rpc::test
