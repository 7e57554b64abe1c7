// SPDX-License-Identifier: BSD-3-Clause
#include "facets.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/parallel.hpp"
#include "rpc/mesh/topology.hpp"

namespace rpc::bound
{
namespace
{

/// Walks around each vertex, counterclockwise.
struct WalkAroundVertices {
  Facets f;                // inout
  fem::NodeToCells around; // in
  DeviceView<LO **> cells; // in
  int sides;

  /// The vertex of a cell that a node is; -1: none.
  KOKKOS_FUNCTION int corner(const LO cell, const LO node) const
  {
    for (int v = 0; v < sides; ++v)
      if (cells(cell, v) == node) return v;
    return -1;
  }

  KOKKOS_FUNCTION void add_spoke(const LO node, const int k, const LO facet, const int toward) const
  {
    f.spoke(f.first_spoke(node) + k) = facet;
    f.toward(f.first_spoke(node) + k) = static_cast<signed char>(toward);
    f.place(facet, f.node(facet, 0) == node ? 0 : 1) = k;
  }

  /// @param wrong  += 1 where the cells are no fan
  KOKKOS_FUNCTION void operator()(const LO node, int &wrong) const
  {
    const std::size_t begin = around.row(node), end = around.row(node + 1);
    f.num_spokes(node) = 0;
    if (begin == end || corner(around.cell(begin), node) < 0) return; // in the middle of a side or a cell
    LO cell = around.cell(begin);
    for (std::size_t k = begin; k < end; ++k) // the first one of a fan has nothing before it
      if (f.on_boundary(f.of_cell(around.cell(k), corner(around.cell(k), node)))) cell = around.cell(k);
    const int n = static_cast<int>(end - begin);
    int k = 0;
    const LO start = f.of_cell(cell, corner(cell, node));
    for (bool closed = false; k < n && !closed;) {
      const int v = corner(cell, node), before = (v + sides - 1) % sides;
      f.star_cell(begin + k) = cell;
      f.star_corner(begin + k) = v;
      add_spoke(node, k, f.of_cell(cell, v), f.sign(cell, v));
      ++k;
      const LO next = f.of_cell(cell, before);
      if (f.on_boundary(next)) {
        add_spoke(node, k, next, -f.sign(cell, before));
        f.num_spokes(node) = k + 1;
        break;
      }
      f.num_spokes(node) = k;
      closed = next == start;
      cell = f.cell(next, 0) == cell ? f.cell(next, 1) : f.cell(next, 0);
    }
    if (k < n) ++wrong;
  }
};

} // namespace

Facets facets_of(const fem::Discretization &d)
{
  const mesh::Mesh &mesh = *d.mesh;
  const mesh::Topology t = mesh::topology(mesh);
  const int sides = mesh.element.num_facets(), count = t.facets.size();
  const LO num_cells = mesh.num_cells();
  Facets f;
  f.of_cell = DeviceView<LO **>("rpc::bound::of_cell", num_cells, sides);
  f.sign = DeviceView<signed char **>("rpc::bound::sign", num_cells, sides);
  f.cell = DeviceView<LO *[2]>("rpc::bound::cell", count);
  f.ordinal = DeviceView<int *[2]>("rpc::bound::ordinal", count);
  const auto of_cell = Kokkos::create_mirror_view(f.of_cell);
  const auto sign = Kokkos::create_mirror_view(f.sign);
  const auto cell = Kokkos::create_mirror_view(f.cell);
  const auto ordinal = Kokkos::create_mirror_view(f.ordinal);
  for (int e = 0; e < count; ++e)
    for (int k = 0; k < 2; ++k) {
      cell(e, k) = k < t.facets.num_cells_at(e) ? t.facets.cell(e, k) : -1;
      ordinal(e, k) = k < t.facets.num_cells_at(e) ? t.facets.ordinal(e, k) : -1;
      if (cell(e, k) < 0) continue;
      of_cell(cell(e, k), ordinal(e, k)) = e;
      sign(cell(e, k), ordinal(e, k)) = k == 0 ? 1 : -1;
    }
  Kokkos::deep_copy(f.of_cell, of_cell);
  Kokkos::deep_copy(f.sign, sign);
  Kokkos::deep_copy(f.cell, cell);
  Kokkos::deep_copy(f.ordinal, ordinal);
  f.node = DeviceView<LO *[2]>("rpc::bound::node", count);
  f.middle = DeviceView<LO *>("rpc::bound::middle", count);
  {
    const auto cells = mesh.cells;
    const Facets to = f;
    const bool quadratic = mesh.element.order == 2;
    Kokkos::parallel_for(
        "rpc::bound::facet_nodes", device_range(count), KOKKOS_LAMBDA(const LO e) {
          const int s = to.ordinal(e, 0);
          to.node(e, 0) = cells(to.cell(e, 0), s);
          to.node(e, 1) = cells(to.cell(e, 0), (s + 1) % sides);
          to.middle(e) = quadratic ? cells(to.cell(e, 0), sides + s) : -1;
        });
    Kokkos::fence();
  }
  f.first = d.node_to_cells.row;
  const std::size_t entries = d.node_to_cells.cell.extent(0), nodes = mesh.num_owned_nodes();
  f.star_cell = DeviceView<LO *>("rpc::bound::star_cell", entries);
  f.star_corner = DeviceView<int *>("rpc::bound::star_corner", entries);
  f.spoke = DeviceView<LO *>("rpc::bound::spoke", entries + nodes);
  f.toward = DeviceView<signed char *>("rpc::bound::toward", entries + nodes);
  f.place = DeviceView<int *[2]>("rpc::bound::place", count);
  f.counts = DeviceView<char *>("rpc::bound::counts", count);
  const auto counts = Kokkos::create_mirror_view(f.counts);
  {
    const auto node = to_host(f.node);
    for (int e = 0; e < count; ++e) { // the vertex with the lower gid decides
      const int end = mesh.node_gid(node(e, 0)) < mesh.node_gid(node(e, 1)) ? 0 : 1;
      counts(e) = node(e, end) < mesh.num_owned_nodes();
    }
  }
  Kokkos::deep_copy(f.counts, counts);
  f.num_spokes = DeviceView<int *>("rpc::bound::num_spokes", nodes);
  int wrong = 0;
  Kokkos::parallel_reduce("rpc::bound::walk", device_range(static_cast<LO>(nodes)),
                          WalkAroundVertices{f, d.node_to_cells, mesh.cells, sides}, wrong);
  wrong = sum_all(mesh.comm(), wrong);
  RPC_REQUIRE_CODE(
      wrong == 0, ExitCode::bad_mesh,
      "deck: \"Adapt->Error Bound\" = guaranteed does not cover bodies whose parts meet in a point, and the mesh "
      "has "
          << wrong << " such vertices. Write \"estimated\"");
  return f;
}

} // namespace rpc::bound
