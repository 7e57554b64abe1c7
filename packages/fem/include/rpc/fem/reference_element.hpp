#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/mesh/element.hpp"

namespace rpc::fem
{

/// Shape functions at the points of a quadrature rule on a reference cell or facet: [-1, 1]^d, or for simplices the
/// triangle of 0 <= X, 0 <= Y, X + Y <= 1.
struct BasisTable {
  DeviceView<double **> value;     ///< (points, nodes)
  DeviceView<double ***> gradient; ///< (points, nodes, d) by reference coordinates
  DeviceView<double *> weight;     ///< (points)

  int num_points() const { return static_cast<int>(weight.extent(0)); }
};

/// All that kernels know of an element; tabulated once per run. Kernels are written against these tables, not against
/// elements.
struct ReferenceElement {
  mesh::Element element;
  BasisTable
      cell; ///< exact for the stiffness of affine cells: Gauss, order + 1 points a direction, in triangles 1 or 3
  BasisTable cell_load;   ///< body forces given by expressions: the same, in triangles 3 or 6 points
  BasisTable recovery;    ///< Gauss, order points a direction (1 or 3 in triangles): where stresses are most accurate
  BasisTable facet;       ///< Gauss on a facet, order + 2 points a direction: loads given by expressions
  BasisTable facet_nodal; ///< Gauss-Lobatto, points at the facet's nodes: trapezoid (order 1), Simpson (order 2)
};

ReferenceElement tabulate(const mesh::Element &element);

} // namespace rpc::fem
