// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/mesh/element.hpp"
#include "rpc/mesh/quadrature.hpp"

namespace rpc::fem
{

/// Shape functions of an element at the points of a quadrature rule on its reference cell, as tables for kernels.
struct BasisTable {
  DeviceView<double **> value;     ///< (points, nodes)
  DeviceView<double ***> gradient; ///< (points, nodes, dim of the element) by reference coordinates
  DeviceView<double *> weight;     ///< (points)

  KOKKOS_INLINE_FUNCTION int num_points() const { return static_cast<int>(weight.extent(0)); }
};

/// @param element  of cells, facets or edges
BasisTable tabulate(const mesh::Element &element, const mesh::QuadratureRule &rule);

} // namespace rpc::fem
