// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slot_exchange.hpp"

#include <numeric>
#include <vector>

namespace rpc::bound
{

/// The cells of a mesh of tetrahedra with their nodes in an order that neighbours agree on, other ranks' too: vertices ascend with Mesh::node_id,
/// then come the middles of edges as the element has them. A cell may be a mirror image in that order. Facet s lies opposite vertex s.
///
/// A facet begins at its vertex with the lowest number; its traction is that on its first cell, the one whose opposite vertex has the lower
/// number. The ring of an edge is what lies around it: its cells and the facets that these hand tractions on by.
///
/// A facet and an edge belong to the rank of their vertex with the lowest number, which has all cells around them. A rank has all facets of its
/// local cells, but its own rings alone; of facets without a vertex of this rank it may lack a cell.
struct SpaceFacets {
  static constexpr LO none = -1, elsewhere = -2; ///< in place of a cell: the body ends there; another rank has it
  DeviceView<LO **> nodes_of_cell;               ///< (cells, nodes) in that order
  DeviceView<LO *[4]> of_cell;                   ///< (cells) facets
  DeviceView<LO *[2]> cell; ///< (facets) both cells; the second one may be `none`, either may be `elsewhere`
  DeviceView<signed char *[2]> ordinal; ///< (facets) which facet of these cells
  DeviceView<LO **> node;    ///< (facets, nodes of one) vertices ascending, then the middles of their pairs 01, 12, 02
  DeviceView<char *> counts; ///< (facets) 1 where this rank counts it in sums over all

  DeviceView<std::size_t *>
      first; ///< (rings + 1) where the cells of a ring begin; its facets begin `ring` places later
  DeviceView<LO *>
      ring_cell; ///< (entries) cell k lies between facets k and k + 1 of the ring, or the last and the first one
  DeviceView<LO *> ring_facet; ///< (entries) facets; rings at the boundary have one more than cells
  DeviceView<signed char *>
      toward; ///< (entries) factor of the facet's traction that makes it the one on the cell behind the facet
  DeviceView<int *> num_ring_facets; ///< (rings)
  DeviceView<LO *[2]> edge;          ///< (rings) both ends of the edge
  DeviceView<LO *[3]> ring;          ///< (facets) rings of its edges 01, 12, 02; -1: another rank's
  DeviceView<int *[3]> place;        ///< (facets) which facet of these rings it is

  LO num_outer = 0; ///< facets of one cell of this rank, among them all on the boundary: the first ones

  KOKKOS_INLINE_FUNCTION LO size() const { return static_cast<LO>(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION LO num_rings() const { return static_cast<LO>(num_ring_facets.extent(0)); }
  KOKKOS_INLINE_FUNCTION std::size_t first_facet(const LO r) const { return first(r) + r; }
  KOKKOS_INLINE_FUNCTION int num_ring_cells(const LO r) const { return static_cast<int>(first(r + 1) - first(r)); }
  KOKKOS_INLINE_FUNCTION bool on_boundary(const LO facet) const { return cell(facet, 1) == none; }
  KOKKOS_INLINE_FUNCTION bool is_whole(const LO facet) const
  {
    return cell(facet, 0) >= 0 && cell(facet, 1) != elsewhere;
  }
  /// Factor of a facet's traction that makes it the one on a cell.
  KOKKOS_INLINE_FUNCTION double sign(const LO c, const int s) const { return cell(of_cell(c, s), 0) == c ? 1 : -1; }
};

/// Of a mesh of tetrahedra. Collective.
/// @throws rpc::Error (bad_mesh) where the cells at an edge are no fan: parts of the body that meet in an edge
SpaceFacets space_facets_of(const fem::Discretization &d);

/// (local nodes) Numbers that do not depend on the ranks, Mesh::node_id. Collective.
std::vector<GO> ids_of_nodes(const fem::Discretization &d);

/// Numbers of facets, of their nodes and of their edges 01, 12, 02, between ranks.
struct SpaceExchanges {
  SlotExchange of_facets, of_nodes, of_edges;

  /// Collective. @param node  (facets, nodes of one) SpaceFacets::node
  SpaceExchanges(const mesh::Mesh &mesh, const DeviceView<LO **> &node)
      : of_facets(mesh, node, {0}), of_nodes(mesh, node, all_of(node.extent(1))), of_edges(mesh, node, {0, 1, 0})
  {
  }
  static std::vector<int> all_of(const std::size_t n)
  {
    std::vector<int> all(n);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
};

} // namespace rpc::bound
