// SPDX-License-Identifier: BSD-3-Clause
#include "space_facets.hpp"

#include "galerkin.hpp"
#include "rpc/core/error.hpp"
#include "rpc/mesh/topology.hpp"

#include <algorithm>
#include <array>
#include <utility>
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

/// The rings of this rank on the host.
struct Rings {
  std::vector<std::size_t> first{0};
  std::vector<LO> cells, facets;
  std::vector<signed char> toward;
  std::vector<int> count;
  std::vector<std::array<LO, 2>> edge;
};

/// A facet and the number of its vertex off an edge: what rings begin with does not depend on how ranks number cells.
struct RingStart {
  LO facet = -1;
  GO beyond = 0;
  bool before(const RingStart &other) const { return other.facet < 0 || beyond < other.beyond; }
};

/// Cells and facets around edges, each from the facet with the lowest number, on the boundary if the ring has an end there.
/// @param id  (local nodes) their numbers
/// @return also whether the cells at some edge are no fan
template <class OfCell, class Cell, class Nodes>
std::pair<Rings, bool> rings_of(const mesh::Topology &t, const LO owned_nodes, const std::vector<GO> &id,
                                const OfCell &of_cell, const Cell &cell, const Nodes &nodes)
{
  const mesh::Entities &edges = t.edges;
  Rings rings;
  const std::size_t entries = edges.of_cell.size() + edges.size();
  rings.first.reserve(edges.size() + 1);
  rings.cells.reserve(edges.of_cell.size());
  rings.facets.reserve(entries);
  rings.toward.reserve(entries);
  rings.count.reserve(edges.size());
  rings.edge.reserve(edges.size());
  for (int e = 0; e < edges.size(); ++e) {
    const int n = edges.num_cells_at(e);
    LO a = edges.vertices[2 * static_cast<std::size_t>(e)], b = edges.vertices[2 * static_cast<std::size_t>(e) + 1];
    if (id[b] < id[a]) std::swap(a, b);
    if (a >= owned_nodes) continue;
    // Both facets of a cell at the edge, each with the number of its vertex off the edge: facet s lies opposite vertex s.
    const auto facets_at = [&](const LO c) {
      std::array<RingStart, 2> at;
      int k = 0;
      for (int s = 0; s < 4 && k < 2; ++s)
        if (nodes(c, s) != a && nodes(c, s) != b) at[k++] = {of_cell(c, s), id[nodes(c, s)]};
      std::swap(at[0].beyond, at[1].beyond);
      return at;
    };
    RingStart start, at_end;
    for (int k = 0; k < n; ++k)
      for (const RingStart &at : facets_at(edges.cell(e, k))) {
        if (at.before(start)) start = at;
        if (cell(at.facet, 1) == SpaceFacets::none && at.before(at_end)) at_end = at;
      }
    LO f = at_end.facet >= 0 ? at_end.facet : start.facet;
    LO c = cell(f, 0);
    const LO begin = f;
    int k = 0;
    bool closed = false;
    for (; k < n && !closed; ++k) {
      rings.cells.push_back(c);
      rings.facets.push_back(f);
      rings.toward.push_back(cell(f, 0) == c ? 1 : -1);
      const auto both = facets_at(c);
      f = both[0].facet == f ? both[1].facet : both[0].facet;
      closed = f == begin;
      if (cell(f, 1) < 0) { // the other end
        ++k;
        rings.facets.push_back(f);
        rings.toward.push_back(cell(f, 0) == c ? -1 : 1);
        break;
      }
      c = cell(f, 0) == c ? cell(f, 1) : cell(f, 0);
    }
    if (k < n) return {rings, true};
    rings.count.push_back(closed ? n : n + 1);
    rings.edge.push_back({a, b});
    if (closed) { // its place stays free
      rings.facets.push_back(-1);
      rings.toward.push_back(0);
    }
    rings.first.push_back(rings.cells.size());
  }
  return {rings, false};
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

/// The cells at facets in their order, and which facet of these it is; collective.
/// @param entity  (facets) number in the topology
/// @param id  (local nodes)   @param nodes  (cells, nodes)   @param facet  (cells, 4)
template <class Nodes, class OfCell>
void order_cells(const mesh::Topology &t, const std::vector<int> &entity, const std::vector<GO> &id, const Nodes &nodes,
                 const OfCell &facet, const SlotExchange &of_facets, SpaceFacets &f)
{
  const LO count = t.facets.size();
  const auto opposite = [&](const LO e, const int k) { // which vertex of its k-th cell lies opposite
    const LO c = t.facets.cell(entity[e], k);
    int s = 0;
    while (facet(c, s) != e) ++s;
    return s;
  };
  // What the rank of the facet sees opposite of it on both sides; -1: nothing.
  const auto rows = of_facets.rows().of;
  const auto served = to_host(of_facets.served());
  const DeviceView<double **> seen("rpc::bound::opposite", served.extent(0), 2);
  const auto there = Kokkos::create_mirror_view(seen);
  const auto ids_at = [&](const LO e) {
    std::array<GO, 2> both{-1, -1};
    for (int k = 0; k < t.facets.num_cells_at(entity[e]); ++k)
      both[k] = id[nodes(t.facets.cell(entity[e], k), opposite(e, k))];
    return both;
  };
  for (std::size_t k = 0; k < served.extent(0); ++k)
    for (int side = 0; side < 2; ++side) there(k, side) = static_cast<double>(ids_at(served(k, 0))[side]);
  Kokkos::deep_copy(seen, there);
  const auto fetched = to_host(of_facets.fetched(seen));
  const auto row = to_host(rows);
  const auto cell = mirror(f.cell);
  const auto ordinal = mirror(f.ordinal);
  const auto counts = mirror(f.counts);
  for (LO e = 0; e < count; ++e) {
    const LO from = row.extent(0) > 0 ? row(e, 0) : -1;
    std::array<GO, 2> both = ids_at(e);
    if (from >= 0) both = {static_cast<GO>(fetched(from, 0)), static_cast<GO>(fetched(from, 1))};
    counts(e) = from < 0;
    if (both[1] >= 0 && both[1] < both[0]) std::swap(both[0], both[1]);
    cell(e, 0) = SpaceFacets::elsewhere;
    cell(e, 1) = both[1] < 0 ? SpaceFacets::none : SpaceFacets::elsewhere;
    ordinal(e, 0) = ordinal(e, 1) = -1;
    for (int k = 0; k < t.facets.num_cells_at(entity[e]); ++k) {
      const int s = opposite(e, k), side = id[nodes(t.facets.cell(entity[e], k), s)] == both[0] ? 0 : 1;
      cell(e, side) = t.facets.cell(entity[e], k);
      ordinal(e, side) = static_cast<signed char>(s);
    }
  }
  Kokkos::deep_copy(f.cell, cell);
  Kokkos::deep_copy(f.ordinal, ordinal);
  Kokkos::deep_copy(f.counts, counts);
}

} // namespace

std::vector<GO> ids_of_nodes(const fem::Discretization &d)
{
  const mesh::Mesh &mesh = *d.mesh;
  const LO owned = mesh.num_owned_nodes();
  HostView<double *> numbers("rpc::bound::numbers", owned); // whole ones below 2^53
  for (LO n = 0; n < owned; ++n) numbers(n) = static_cast<double>(mesh.node_id(n));
  std::vector<GO> id(mesh.num_local_nodes());
  for (LO n = 0; n < owned; ++n) id[n] = mesh.node_id(n);
  if (d.node_halo->is_empty()) return id;
  const RCP<Vector> table = vector_of(numbers, mesh.owned_nodes);
  const HostView<double *> all = host_copy(d.node_halo->at_columns(*table));
  for (std::size_t n = owned; n < id.size(); ++n) id[n] = static_cast<GO>(all(n));
  return id;
}

SpaceFacets space_facets_of(const fem::Discretization &d)
{
  const mesh::Mesh &mesh = *d.mesh;
  const mesh::Topology t = mesh::topology(mesh);
  const std::vector<GO> id = ids_of_nodes(d);
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
  f.counts = DeviceView<char *>("rpc::bound::counts", count);
  const auto nodes = mirror(f.nodes_of_cell);
  const auto of_cell = mirror(f.of_cell);
  const auto node = mirror(f.node);
  std::vector<int> entity; // in the topology
  std::vector<LO> number(count);
  for (const bool outer : {true, false}) {
    for (int e = 0; e < count; ++e)
      if ((t.facets.num_cells_at(e) == 1) == outer) {
        number[e] = static_cast<LO>(entity.size());
        entity.push_back(e);
      }
    if (outer) f.num_outer = static_cast<LO>(entity.size());
  }
  for (LO c = 0; c < num_cells; ++c) {
    std::array<int, 4> order{0, 1, 2, 3};
    std::sort(order.begin(), order.end(), [&](const int x, const int y) { return id[given(c, x)] < id[given(c, y)]; });
    for (int v = 0; v < 4; ++v) nodes(c, v) = given(c, order[v]);
    if (quadratic)
      for (const auto &edge : element.edges())
        nodes(c, edge[2]) = given(c, middle_of(element, order[edge[0]], order[edge[1]]));
    for (int s = 0; s < 4; ++s) {
      const int at = t.facets.of_cell[4 * static_cast<std::size_t>(c) + s];
      const LO facet = number[at];
      const int *const of_facet = &t.facets.vertices[3 * static_cast<std::size_t>(at)];
      int opposite = 0;
      while (std::find(of_facet, of_facet + 3, nodes(c, opposite)) != of_facet + 3) ++opposite;
      of_cell(c, opposite) = facet;
      int own[3], k = 0;
      for (int v = 0; v < 4; ++v)
        if (v != opposite) own[k++] = v;
      for (int v = 0; v < 3; ++v) node(facet, v) = nodes(c, own[v]);
      for (int m = 0; quadratic && m < 3; ++m)
        node(facet, 3 + m) = nodes(c, middle_of(element, own[m == 1 ? 1 : 0], own[m == 0 ? 1 : 2]));
    }
  }
  Kokkos::deep_copy(f.nodes_of_cell, nodes);
  Kokkos::deep_copy(f.of_cell, of_cell);
  Kokkos::deep_copy(f.node, node);
  order_cells(t, entity, id, nodes, of_cell, SlotExchange(mesh, f.node, {0}), f);
  const auto [rings, wrong] = rings_of(t, mesh.num_owned_nodes(), id, of_cell, to_host(f.cell), nodes);
  RPC_REQUIRE_CODE(
      max_all(mesh.comm(), wrong ? 1 : 0) == 0, ExitCode::bad_mesh,
      "deck: \"Adapt->Error Bound\" = guaranteed does not cover bodies whose parts meet in an edge, and the "
      "mesh has such edges. Write \"estimated\"");
  const std::size_t num_rings = rings.edge.size();
  f.edge = DeviceView<LO *[2]>("rpc::bound::edge", num_rings);
  f.ring = DeviceView<LO *[3]>("rpc::bound::ring", count);
  f.place = DeviceView<int *[3]>("rpc::bound::place", count);
  const auto edge = mirror(f.edge);
  const auto ring = mirror(f.ring);
  const auto place = mirror(f.place);
  Kokkos::deep_copy(ring, -1);
  for (std::size_t e = 0; e < num_rings; ++e) {
    for (int v = 0; v < 2; ++v) edge(e, v) = rings.edge[e][v];
    for (int k = 0; k < rings.count[e]; ++k) {
      const LO at = rings.facets[rings.first[e] + e + k];
      const int own = edge(e, 0) == node(at, 1) ? 1 : (edge(e, 1) == node(at, 1) ? 0 : 2);
      ring(at, own) = static_cast<LO>(e);
      place(at, own) = k;
    }
  }
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
