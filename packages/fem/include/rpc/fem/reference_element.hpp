// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/basis.hpp"
#include "rpc/fem/kinematics.hpp"

namespace rpc::fem
{

/// All that kernels know of an element; tabulated once per run. Kernels are written against these tables, not against
/// elements.
struct ReferenceElement {
  mesh::Element element;
  BasisTable cell;      ///< exact for the stiffness of affine cells, axisymmetric ones up to terms of 1/r
  BasisTable cell_load; ///< body forces given by expressions: exact for products of two shape functions in affine cells
  BasisTable recovery;  ///< where stresses are most accurate: Gauss, order points a direction; in simplices as `cell`
  BasisTable facet; ///< loads on a facet given by expressions: two degrees more than products of two shape functions
  BasisTable facet_nodal; ///< points at the facet's nodes, see mesh::nodal_rule()
};

ReferenceElement tabulate(const mesh::Element &element, Kinematics kinematics = Kinematics::plane_strain);

} // namespace rpc::fem
