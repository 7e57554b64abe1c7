// SPDX-License-Identifier: BSD-3-Clause
#include "hexahedra.hpp"
#include "rpc/core/point.hpp"
#include "space_facets.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace rpc::bound
{
namespace
{

/// Both halves of a face, from its vertex with the lowest number.
std::array<std::array<int, 3>, 2> halves(const std::vector<int> &face, const std::array<GO, 8> &id)
{
  int k = 0;
  for (int a = 1; a < 4; ++a)
    if (id[face[a]] < id[face[k]]) k = a;
  return {{{face[k], face[(k + 1) % 4], face[(k + 2) % 4]}, {face[k], face[(k + 2) % 4], face[(k + 3) % 4]}}};
}

/// Six times the volume.
double volume_of(const std::array<Point, 4> &x)
{
  return inner(difference(x[1], x[0]), cross(difference(x[2], x[0]), difference(x[3], x[0])));
}

/// Which of the edges 01 02 03 12 13 23 of a tetrahedron lies between two nodes; -1: none.
template <class Cells>
int edge_between(const Cells &cells, const LO c, const LO a, const LO b)
{
  int edge = 0;
  for (int v = 0; v < 4; ++v)
    for (int w = v + 1; w < 4; ++w, ++edge)
      if ((cells(c, v) == a && cells(c, w) == b) || (cells(c, v) == b && cells(c, w) == a)) return edge;
  return -1;
}

} // namespace

SplitHexahedra split_hexahedra(const fem::Discretization &d)
{
  constexpr int parts_of_cell = SplitHexahedra::parts_of_cell;
  const mesh::Mesh &from = *d.mesh;
  const std::vector<GO> id = ids_of_nodes(d);
  const auto given = to_host(from.cells);
  const auto block = to_host(from.block);
  const auto coords = to_host(from.coords);
  const LO count = from.num_cells();
  const auto &faces = from.element.facets();
  const auto m = std::make_shared<mesh::Mesh>();
  m->element = mesh::Element{3, 1, mesh::Shape::simplex};
  m->owned_nodes = from.owned_nodes;
  m->ghosts = from.ghosts;
  m->coords = from.coords;
  m->node_id = from.node_id;
  m->num_owned_cells = parts_of_cell * from.num_owned_cells;
  m->blocks = from.blocks;
  m->points = from.points;
  SplitHexahedra split;
  split.corner = HostView<signed char *[4]>("rpc::bound::corner", parts_of_cell * count);
  split.smallest = std::numeric_limits<double>::infinity();
  m->cells = DeviceView<LO **>("rpc::bound::split", parts_of_cell * count, 4);
  const auto cells = Kokkos::create_mirror_view(m->cells);
  const HostView<int *> blocks("rpc::bound::block", parts_of_cell * count);
  const HostView<GO *> ids("rpc::bound::cell_id", parts_of_cell * from.num_owned_cells);
  std::vector<std::array<GO, 8>> ids_of(count);
  for (LO h = 0; h < count; ++h) {
    for (int a = 0; a < 8; ++a) ids_of[h][a] = id[given(h, a)];
    const int lowest = static_cast<int>(std::min_element(ids_of[h].begin(), ids_of[h].end()) - ids_of[h].begin());
    LO at = parts_of_cell * h;
    double sum = 0, least = std::numeric_limits<double>::infinity();
    for (const auto &face : faces) {
      if (std::find(face.begin(), face.end(), lowest) != face.end()) continue;
      for (const auto &half : halves(face, ids_of[h])) {
        const std::array<int, 4> corner{lowest, half[0], half[1], half[2]};
        std::array<Point, 4> x{};
        for (int v = 0; v < 4; ++v) {
          split.corner(at, v) = static_cast<signed char>(corner[v]);
          cells(at, v) = given(h, corner[v]);
          for (int i = 0; i < 3; ++i) x[v][i] = coords(cells(at, v), i);
        }
        blocks(at) = block(h);
        if (h < from.num_owned_cells) ids(at) = parts_of_cell * from.cell_id(h) + at % parts_of_cell;
        const double volume = volume_of(x);
        sum += volume;
        least = std::min(least, volume);
        ++at;
      }
    }
    split.smallest = std::min(split.smallest, sum > 0 ? parts_of_cell * least / sum : -1);
  }
  split.smallest = min_all(from.comm(), split.smallest);
  Kokkos::deep_copy(m->cells, cells);
  m->block = to_device(blocks);
  m->cell_id = mesh::Ids(ids);
  const auto &facets = m->element.facets();
  for (const mesh::Side &side : from.sides) {
    const auto cell = to_host(side.cell);
    const auto ordinal = to_host(side.ordinal);
    const HostView<LO *> part("rpc::bound::part", 2 * cell.extent(0));
    const HostView<int *> facet("rpc::bound::facet", 2 * cell.extent(0));
    for (std::size_t f = 0; f < cell.extent(0); ++f) {
      const auto both = halves(faces[ordinal(f)], ids_of[cell(f)]);
      for (int k = 0; k < 2; ++k)
        for (LO c = parts_of_cell * cell(f); c < parts_of_cell * (cell(f) + 1); ++c)
          for (std::size_t o = 0; o < facets.size(); ++o) {
            const auto is_of_half = [&](const int v) {
              return std::find(both[k].begin(), both[k].end(), split.corner(c, v)) != both[k].end();
            };
            if (!std::all_of(facets[o].begin(), facets[o].end(), is_of_half)) continue;
            part(2 * f + k) = c;
            facet(2 * f + k) = static_cast<int>(o);
          }
    }
    m->sides.push_back(mesh::make_side(side.name, *m, part, facet));
  }
  split.mesh = m;
  return split;
}

HexahedraInput hexahedra_input(const fem::Discretization &d, const fem::Discretization &of_split,
                               const SplitHexahedra &split, const SpaceInput &in, const std::vector<std::string> &flat)
{
  constexpr int parts_of_cell = SplitHexahedra::parts_of_cell;
  HexahedraInput h;
  static_cast<SpaceInput &>(h) = in;
  h.hexahedra = d.mesh->cells;
  h.stiffness = d.reference.cell;
  h.of_hexahedra = true;
  h.around = of_split.node_to_cells;
  const LO count = in.num_cells();
  const auto cells = to_host(in.cells), given = to_host(split.mesh->cells);
  const auto of_facet = to_host(in.facets.node);
  const auto facet_of = to_host(in.facets.of_cell);
  h.corner = DeviceView<signed char *[4]>("rpc::bound::corner", count);
  h.flat = DeviceView<LO *[6][2]>("rpc::bound::flat", count);
  h.half = DeviceView<LO *[3]>("rpc::bound::half", in.facets.num_outer);
  const auto corner = Kokkos::create_mirror_view(h.corner);
  const auto bends = Kokkos::create_mirror_view(h.flat);
  h.is_flat = DeviceView<char *>("rpc::bound::is_flat", in.facets.num_outer);
  const auto half = Kokkos::create_mirror_view(h.half);
  const auto is_flat = Kokkos::create_mirror_view(h.is_flat);
  Kokkos::deep_copy(bends, -1);
  Kokkos::deep_copy(half, -1);
  for (LO c = 0; c < count; ++c)
    for (int v = 0; v < 4; ++v)
      for (int w = 0; w < 4; ++w)
        if (given(c, w) == cells(c, v)) corner(c, v) = split.corner(c, w);
  const auto hexahedra = to_host(d.mesh->cells);
  const auto &faces = d.mesh->element.facets();
  for (LO c = 0; c < count; ++c)
    for (int s = 0; s < 4; ++s) { // halves of faces: their three vertices are those of one
      const LO f = facet_of(c, s);
      if (f >= in.facets.num_outer) continue;
      for (const auto &face : faces) {
        const auto has = [&](const int local) { return std::find(face.begin(), face.end(), local) != face.end(); };
        bool within = true;
        for (int v = 0; v < 4; ++v) within = within && (v == s || has(corner(c, v)));
        if (!within) continue;
        // The vertex that is left out lies opposite the one between the ends of the diagonal.
        int left_out = 0;
        for (int a = 0; a < 4; ++a) {
          bool is_there = false;
          for (int v = 0; v < 4; ++v) is_there = is_there || (v != s && corner(c, v) == face[a]);
          if (!is_there) left_out = a;
        }
        const LO between = hexahedra(c / parts_of_cell, face[(left_out + 2) % 4]),
                 beyond = hexahedra(c / parts_of_cell, face[left_out]);
        int at = 0;
        while (of_facet(f, at) != between) ++at;
        half(f, 0) = at == 0 ? 1 : (at == 1 ? 2 : 0); // the edge opposite it
        half(f, 1) = between;
        half(f, 2) = beyond;
      }
    }
  for (const std::string &name : flat) {
    const mesh::Side &side = split.mesh->side(name, "Contact");
    const auto cell = to_host(side.cell);
    const auto nodes = to_host(side.facets);
    for (std::size_t k = 0; k < cell.extent(0); ++k) {
      const LO c = cell(k);
      for (int s = 0; s < 4; ++s) {
        const LO f = facet_of(c, s);
        int shared = 0;
        for (int v = 0; v < 3; ++v)
          for (int w = 0; w < 3; ++w) shared += of_facet(f, v) == nodes(k, w);
        if (shared < 3 || f >= in.facets.num_outer || half(f, 0) < 0) continue;
        const LO a = of_facet(f, half(f, 0) == 1 ? 1 : 0), b = of_facet(f, half(f, 0) == 0 ? 1 : 2);
        const LO first = c - c % parts_of_cell;
        for (LO part = first; part < first + parts_of_cell; ++part) {
          const int edge = edge_between(cells, part, a, b);
          for (int other = 0; other < 2 && edge >= 0; ++other) bends(part, edge, other) = half(f, 1 + other);
        }
        is_flat(f) = 1;
      }
    }
  }
  Kokkos::deep_copy(h.corner, corner);
  Kokkos::deep_copy(h.flat, bends);
  Kokkos::deep_copy(h.half, half);
  Kokkos::deep_copy(h.is_flat, is_flat);
  h.shift = DeviceView<double **>("rpc::bound::shift", h.num_hexahedra(), 24);
  tabulate_points(h);
  return h;
}

} // namespace rpc::bound
