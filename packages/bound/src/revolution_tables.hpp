// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/mesh/element.hpp"

namespace rpc::bound
{

/// Symmetric stresses on a reference cell, split as ReferenceStress has it, with tractions that agree where parts meet and any divergence.
/// Of a body of revolution they are S = 2 pi r s in the section.                                        doc/bounds.md (13.10a)
///
/// Points of integration are those of three arrangements: they close up toward the centre, the first or the second vertex of the part.
struct RevolutionTables {
  int columns = 0, inner = 0;        ///< all, and those without tractions, which come last
  int divergences = 0;               ///< coefficients of a component of the divergence in a part
  int points = 0;                    ///< in a part
  DeviceView<double **> stress;      ///< (coefficients, columns)
  DeviceView<double ***> divergence; ///< (parts * divergences, 2, columns)
  DeviceView<double ***> at_middle;  ///< (sides, components, columns) in the middle of each side
  DeviceView<double ****> place;     ///< (arrangements, parts, points, 2) X relative to the centre
  DeviceView<double ***> weight;     ///< (arrangements, parts, points)
  DeviceView<double *> from_end;     ///< (points) by how much of the way a point is away from where they close up
  DeviceView<double ****> value;     ///< (arrangements, parts, points, monomials)
  DeviceView<double *****> slope;    ///< (arrangements, parts, points, monomials, 2) by X
  DeviceView<double ****> shape;     ///< (arrangements, parts, points, nodes) of the element
  DeviceView<double *****> gradient; ///< (arrangements, parts, points, nodes, 2) by X

  static constexpr int arrangements = 3, most_columns = 49, most_inner = 25, most_conditions = 13, most_of_part = 18;
};

RevolutionTables revolution_tables(const mesh::Element &element);

} // namespace rpc::bound
