// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/discretization.hpp"

namespace rpc::bound
{

/// The facets of a plane mesh and the stars of its vertices. A facet runs from its first vertex to its second one along the boundary of
/// its first cell, counterclockwise; its traction is that on the first cell, by unit of a parameter from 0 to 1 along it.
struct Facets {
  DeviceView<LO **> of_cell;       ///< (cells, sides) facet
  DeviceView<signed char **> sign; ///< (cells, sides) 1 in its first cell, -1 in the other
  DeviceView<LO *[2]> cell;        ///< (facets) both cells, -1: none
  DeviceView<int *[2]> ordinal;    ///< (facets) which side of these cells
  DeviceView<LO *[2]> node;        ///< (facets) vertices
  DeviceView<LO *> middle;         ///< (facets) middle node of order 2, else -1

  DeviceView<char *> counts; ///< (facets) 1 where this rank counts it in sums over all

  // Stars: cells and spokes around each vertex, counterclockwise. Interior vertices have as many spokes as cells, those of the boundary
  // one more, the first and the last on the boundary.
  DeviceView<std::size_t *>
      first;                     ///< (nodes + 1) where the cells of a node begin; its spokes begin `node` places later
  DeviceView<LO *> star_cell;    ///< (entries) cells of the stars
  DeviceView<int *> star_corner; ///< (entries) which vertex of the cell lies in the middle
  DeviceView<LO *> spoke;        ///< (entries) facet
  DeviceView<signed char *>
      toward; ///< (entries) factor of the facet's traction that makes it the one on the cell behind the spoke
  DeviceView<int *[2]> place;   ///< (facets) which spoke it is in the stars of its vertices
  DeviceView<int *> num_spokes; ///< (nodes) 0 of nodes that are no vertices

  LO size() const { return static_cast<LO>(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION std::size_t first_spoke(const LO node_lid) const { return first(node_lid) + node_lid; }
  KOKKOS_INLINE_FUNCTION int num_cells(const LO node_lid) const
  {
    return static_cast<int>(first(node_lid + 1) - first(node_lid));
  }
  KOKKOS_INLINE_FUNCTION bool on_boundary(const LO facet) const { return cell(facet, 1) < 0; }
};

/// Of a plane mesh. A rank has all facets of its local cells, but the stars of its own vertices alone; of facets that have none of these it may
/// lack a cell. Collective.
/// @throws rpc::Error (bad_mesh) where the cells at a vertex are no fan: parts of the body that meet in a point
Facets facets_of(const fem::Discretization &d);

} // namespace rpc::bound
