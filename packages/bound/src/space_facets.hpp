// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/discretization.hpp"

namespace rpc::bound
{

/// The cells of a mesh of tetrahedra with their nodes in an order that neighbours agree on: vertices ascend with their numbers, then come the
/// middles of edges as the element has them. A cell may be a mirror image in that order. Facet s lies opposite vertex s.
///
/// A facet begins at its vertex with the lowest number; its traction is that on its first cell. The ring of an edge is what lies around it: its
/// cells and the facets that these hand tractions on by.
struct SpaceFacets {
  DeviceView<LO **> nodes_of_cell;      ///< (cells, nodes) in that order
  DeviceView<LO *[4]> of_cell;          ///< (cells) facets
  DeviceView<LO *[2]> cell;             ///< (facets) both cells, -1: none
  DeviceView<signed char *[2]> ordinal; ///< (facets) which facet of these cells
  DeviceView<LO **> node; ///< (facets, nodes of one) vertices ascending, then the middles of their pairs 01, 12, 02

  DeviceView<std::size_t *>
      first; ///< (rings + 1) where the cells of a ring begin; its facets begin `ring` places later
  DeviceView<LO *>
      ring_cell; ///< (entries) cell k lies between facets k and k + 1 of the ring, or the last and the first one
  DeviceView<LO *> ring_facet; ///< (entries) facets; rings at the boundary have one more than cells
  DeviceView<signed char *>
      toward; ///< (entries) factor of the facet's traction that makes it the one on the cell behind the facet
  DeviceView<int *> num_ring_facets; ///< (rings)
  DeviceView<LO *[2]> edge;          ///< (rings) both ends of the edge
  DeviceView<LO *[3]> ring;          ///< (facets) rings of its edges
  DeviceView<int *[3]> place;        ///< (facets) which facet of these rings it is

  LO size() const { return static_cast<LO>(node.extent(0)); }
  LO num_rings() const { return static_cast<LO>(num_ring_facets.extent(0)); }
  KOKKOS_INLINE_FUNCTION std::size_t first_facet(const LO r) const { return first(r) + r; }
  KOKKOS_INLINE_FUNCTION int num_ring_cells(const LO r) const { return static_cast<int>(first(r + 1) - first(r)); }
  KOKKOS_INLINE_FUNCTION bool on_boundary(const LO facet) const { return cell(facet, 1) < 0; }
  /// Factor of a facet's traction that makes it the one on a cell.
  KOKKOS_INLINE_FUNCTION double sign(const LO c, const int s) const { return cell(of_cell(c, s), 0) == c ? 1 : -1; }
};

/// Of a mesh of tetrahedra on one rank.
/// @throws rpc::Error (bad_mesh) where the cells at an edge are no fan: parts of the body that meet in an edge
SpaceFacets space_facets_of(const fem::Discretization &d);

} // namespace rpc::bound
