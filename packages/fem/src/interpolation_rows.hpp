// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kernels.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <vector>

/// Rows of an interpolation's matrix; private to interpolation().
namespace rpc::fem
{

/// One row before it is stored: the nodes of the cell in which a point lies.
template <int Nodes>
struct InterpolationRow {
  LO column[Nodes];
  double weight[Nodes]; ///< 0: no entry
};

/// Whether a weight is no rounding.
KOKKOS_INLINE_FUNCTION bool counts(const double N)
{
  return N > 1e-12 || N < -1e-12;
}

/// (nodes) The shape functions at a point of the reference cell, 0 where they are rounding.
template <int Dim, int Nodes>
KOKKOS_INLINE_FUNCTION void weights_at(const ShapeFunctions<Dim, Nodes> &shape, const double (&X)[Dim],
                                       double (&weight)[Nodes])
{
  double dN[Nodes][Dim];
  shape.evaluate(X, weight, dN);
  for (int a = 0; a < Nodes; ++a)
    if (!counts(weight[a])) weight[a] = 0;
}

/// The columns of a matrix on the nodes of a mesh: those that the rank owns, then `others`, ascending gids; collective.
inline RCP<const Map> columns_of(const mesh::Mesh &mesh, const std::vector<GO> &others)
{
  const LO num_owned = mesh.num_owned_nodes();
  std::vector<GO> gids(num_owned);
  std::iota(gids.begin(), gids.end(),
            num_owned > 0 ? mesh.owned_nodes->getMinGlobalIndex() : 0); // the map is contiguous
  gids.insert(gids.end(), others.begin(), others.end());
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), Teuchos::ArrayView<const GO>(gids), 0,
                     mesh.owned_nodes->getComm()));
}

} // namespace rpc::fem
