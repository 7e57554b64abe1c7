// SPDX-License-Identifier: BSD-3-Clause
#include "space_facets.hpp"

#include "rpc/core/error.hpp"
#include "rpc/mesh/topology.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace rpc::bound
{
namespace
{

template <class View>
auto mirror(const View &view)
{
  return Kokkos::create_mirror_view(view);
}

/// Which node of a tetrahedron of order 2 is the middle of two of its vertices.
int middle_of(const mesh::Element &element, const int a, const int b)
{
  for (const auto &edge : element.edges())
    if ((edge[0] == a && edge[1] == b) || (edge[0] == b && edge[1] == a)) return edge[2];
  return -1;
}

/// The rings on the host.
struct Rings {
  std::vector<std::size_t> first{0};
  std::vector<LO> cells, facets;
  std::vector<signed char> toward;
  std::vector<int> count;
};

/// Cells and facets around edges, each from a facet on the boundary if there is one, else from the cell with the lowest number.
template <class OfCell, class Cell, class Nodes>
Rings rings_of(const mesh::Entities &edges, const OfCell &of_cell, const Cell &cell, const Nodes &nodes)
{
  Rings rings;
  int wrong = 0;
  for (int e = 0; e < edges.size(); ++e) {
    const int n = edges.num_cells_at(e), a = edges.vertices[2 * e], b = edges.vertices[2 * e + 1];
    const auto facets_at = [&](const LO c) { // both facets of a cell at the edge
      std::array<LO, 2> at{-1, -1};
      int k = 0;
      for (int s = 0; s < 4 && k < 2; ++s)
        if (nodes(c, s) != a && nodes(c, s) != b) at[k++] = of_cell(c, s);
      return at;
    };
    LO c = edges.cell(e, 0), f = facets_at(c)[0];
    for (int k = 0; k < n; ++k)
      for (const LO at : facets_at(edges.cell(e, k)))
        if (cell(at, 1) < 0) {
          c = edges.cell(e, k);
          f = at;
        }
    const LO start = f;
    int k = 0;
    bool closed = false;
    for (; k < n && !closed; ++k) {
      rings.cells.push_back(c);
      rings.facets.push_back(f);
      rings.toward.push_back(cell(f, 0) == c ? 1 : -1);
      const auto both = facets_at(c);
      f = both[0] == f ? both[1] : both[0];
      closed = f == start;
      if (cell(f, 1) < 0) { // the other end
        ++k;
        rings.facets.push_back(f);
        rings.toward.push_back(cell(f, 0) == c ? -1 : 1);
        break;
      }
      c = cell(f, 0) == c ? cell(f, 1) : cell(f, 0);
    }
    if (k < n) ++wrong;
    rings.count.push_back(closed ? n : n + 1);
    if (closed) { // its place stays free
      rings.facets.push_back(-1);
      rings.toward.push_back(0);
    }
    rings.first.push_back(rings.cells.size());
    if (wrong) break;
  }
  RPC_REQUIRE_CODE(
      wrong == 0, ExitCode::bad_mesh,
      "deck: \"Adapt->Error Bound\" = guaranteed does not cover bodies whose parts meet in an edge, and the "
      "mesh has such edges. Write \"estimated\"");
  return rings;
}

template <class View, class Values>
View view_of(const Values &values, const std::string &label)
{
  View view(label, values.size());
  const auto host = mirror(view);
  for (std::size_t i = 0; i < values.size(); ++i) host(i) = values[i];
  Kokkos::deep_copy(view, host);
  return view;
}

} // namespace

SpaceFacets space_facets_of(const fem::Discretization &d)
{
  const mesh::Mesh &mesh = *d.mesh;
  const mesh::Topology t = mesh::topology(mesh);
  const mesh::Element &element = mesh.element;
  const int count = t.facets.size(), per_cell = element.num_nodes();
  const bool quadratic = element.order == 2;
  const LO num_cells = mesh.num_cells();
  const auto given = to_host(mesh.cells);
  SpaceFacets f;
  f.nodes_of_cell = DeviceView<LO **>("rpc::bound::nodes_of_cell", num_cells, per_cell);
  f.of_cell = DeviceView<LO *[4]>("rpc::bound::of_cell", num_cells);
  f.cell = DeviceView<LO *[2]>("rpc::bound::cell", count);
  f.ordinal = DeviceView<signed char *[2]>("rpc::bound::ordinal", count);
  f.node = DeviceView<LO **>("rpc::bound::node", count, quadratic ? 6 : 3);
  const auto nodes = mirror(f.nodes_of_cell);
  const auto of_cell = mirror(f.of_cell);
  const auto cell = mirror(f.cell);
  const auto node = mirror(f.node);
  const auto ordinal = mirror(f.ordinal);
  for (int e = 0; e < count; ++e)
    for (int k = 0; k < 2; ++k) cell(e, k) = k < t.facets.num_cells_at(e) ? t.facets.cell(e, k) : -1;
  for (LO c = 0; c < num_cells; ++c) {
    std::array<int, 4> order{0, 1, 2, 3};
    std::sort(order.begin(), order.end(), [&](const int x, const int y) { return given(c, x) < given(c, y); });
    for (int v = 0; v < 4; ++v) nodes(c, v) = given(c, order[v]);
    if (quadratic)
      for (const auto &edge : element.edges())
        nodes(c, edge[2]) = given(c, middle_of(element, order[edge[0]], order[edge[1]]));
    for (int s = 0; s < 4; ++s) {
      const LO facet = t.facets.of_cell[4 * static_cast<std::size_t>(c) + s];
      int opposite = 0;
      while (std::find(&t.facets.vertices[3 * static_cast<std::size_t>(facet)],
                       &t.facets.vertices[3 * static_cast<std::size_t>(facet)] + 3,
                       nodes(c, opposite)) != &t.facets.vertices[3 * static_cast<std::size_t>(facet)] + 3)
        ++opposite;
      of_cell(c, opposite) = facet;
      const int side = cell(facet, 0) == c ? 0 : 1;
      ordinal(facet, side) = static_cast<signed char>(opposite);
      if (side == 1) continue;
      int own[3], k = 0;
      for (int v = 0; v < 4; ++v)
        if (v != opposite) own[k++] = v;
      for (int v = 0; v < 3; ++v) node(facet, v) = nodes(c, own[v]);
      for (int m = 0; quadratic && m < 3; ++m)
        node(facet, 3 + m) = nodes(c, middle_of(element, own[m == 1 ? 1 : 0], own[m == 0 ? 1 : 2]));
    }
  }
  const Rings rings = rings_of(t.edges, of_cell, cell, nodes);
  const int num_rings = t.edges.size();
  f.edge = DeviceView<LO *[2]>("rpc::bound::edge", num_rings);
  f.ring = DeviceView<LO *[3]>("rpc::bound::ring", count);
  f.place = DeviceView<int *[3]>("rpc::bound::place", count);
  const auto edge = mirror(f.edge);
  const auto ring = mirror(f.ring);
  const auto place = mirror(f.place);
  std::vector<signed char> found(count, 0);
  for (int e = 0; e < num_rings; ++e) {
    for (int v = 0; v < 2; ++v) edge(e, v) = t.edges.vertices[2 * static_cast<std::size_t>(e) + v];
    for (int k = 0; k < rings.count[e]; ++k) {
      const LO at = rings.facets[rings.first[e] + e + k];
      ring(at, found[at]) = e;
      place(at, found[at]++) = k;
    }
  }
  Kokkos::deep_copy(f.nodes_of_cell, nodes);
  Kokkos::deep_copy(f.of_cell, of_cell);
  Kokkos::deep_copy(f.cell, cell);
  Kokkos::deep_copy(f.ordinal, ordinal);
  Kokkos::deep_copy(f.node, node);
  Kokkos::deep_copy(f.edge, edge);
  Kokkos::deep_copy(f.ring, ring);
  Kokkos::deep_copy(f.place, place);
  f.first = view_of<DeviceView<std::size_t *>>(rings.first, "rpc::bound::first");
  f.ring_cell = view_of<DeviceView<LO *>>(rings.cells, "rpc::bound::ring_cell");
  f.ring_facet = view_of<DeviceView<LO *>>(rings.facets, "rpc::bound::ring_facet");
  f.toward = view_of<DeviceView<signed char *>>(rings.toward, "rpc::bound::toward");
  f.num_ring_facets = view_of<DeviceView<int *>>(rings.count, "rpc::bound::num_ring_facets");
  return f;
}

} // namespace rpc::bound
