// SPDX-License-Identifier: BSD-3-Clause
#include "pinched_nodes.hpp"

#include "rpc/core/fingerprint.hpp"

#include <cstdint>

namespace rpc::fem
{
namespace
{

/// Counts the owned nodes where the cells around are not all joined over facets that hold the node.
struct CountPinchedNodes {
  static constexpr int most_cells = 64;   // around a node; one with more counts
  static constexpr int most_vertices = 8; // of a cell, a hexahedron

  DeviceView<LO **> cells;   // (cells, nodes)            in
  NodeToCells node_to_cells; //                           in
  DeviceView<int **> facets; // (facets, their vertices)  in, nodes of a cell
  int num_vertices;          // of a cell                 in

  /// A number for the facet, 0 if the node is none of its vertices.
  KOKKOS_FUNCTION std::uint64_t facet_at(const LO cell, const int facet, const LO node) const
  {
    std::uint64_t sum = 0;
    bool holds = false;
    for (std::size_t a = 0; a < facets.extent(1); ++a) {
      const LO vertex = cells(cell, facets(facet, a));
      holds = holds || vertex == node;
      sum += splitmix64(static_cast<std::uint64_t>(vertex)); // the sum of several tells the numbers
    }
    return holds ? sum : 0;
  }
  KOKKOS_FUNCTION bool is_vertex(const LO cell, const LO node) const
  {
    for (int a = 0; a < num_vertices; ++a)
      if (cells(cell, a) == node) return true;
    return false;
  }
  KOKKOS_FUNCTION bool share_facet(const LO a, const LO b, const LO node) const
  {
    const int num_facets = static_cast<int>(facets.extent(0));
    for (int f = 0; f < num_facets; ++f) {
      const std::uint64_t of_a = facet_at(a, f, node);
      for (int g = 0; of_a != 0 && g < num_facets; ++g)
        if (facet_at(b, g, node) == of_a) return true;
    }
    return false;
  }
  /// Inside of the body each facet around the node belongs to two cells: these numbers cancel.
  KOKKOS_FUNCTION bool is_inside(const LO node) const
  {
    std::uint64_t bits = 0;
    for (std::size_t k = node_to_cells.row(node); k < node_to_cells.row(node + 1); ++k) {
      const LO cell = node_to_cells.cell(k);
      std::uint64_t number[most_vertices];
      int at = -1;
      for (int a = 0; a < num_vertices; ++a) {
        number[a] = splitmix64(static_cast<std::uint64_t>(cells(cell, a)));
        if (cells(cell, a) == node) at = a;
      }
      for (std::size_t f = 0; f < facets.extent(0); ++f) {
        std::uint64_t sum = 0;
        bool holds = false;
        for (std::size_t a = 0; a < facets.extent(1); ++a) {
          holds = holds || facets(f, a) == at;
          sum += number[facets(f, a)];
        }
        if (holds) bits ^= sum;
      }
    }
    return bits == 0;
  }
  KOKKOS_FUNCTION void operator()(const LO node, LO &count) const
  {
    const std::size_t first = node_to_cells.row(node);
    const int size = static_cast<int>(node_to_cells.row(node + 1) - first);
    if (size < 2 || !is_vertex(node_to_cells.cell(first), node) || is_inside(node)) return;
    if (size > most_cells) {
      ++count;
      return;
    }
    bool reached[most_cells] = {true}; // from the first cell
    int num_reached = 1;
    for (int before = 0; before < num_reached;) {
      before = num_reached;
      for (int a = 0; a < size; ++a)
        for (int b = 0; reached[a] && b < size; ++b)
          if (!reached[b] && share_facet(node_to_cells.cell(first + a), node_to_cells.cell(first + b), node)) {
            reached[b] = true;
            ++num_reached;
          }
    }
    if (num_reached < size) ++count;
  }
};

} // namespace

bool has_pinched_nodes(const Discretization &d)
{
  const mesh::Element &element = d.mesh->element;
  const auto &facets = element.facets();
  const int width = num_facet_vertices(element);
  const DeviceView<int **> facet_vertices("rpc::fem::facet_vertices", facets.size(), width);
  const auto mirror = Kokkos::create_mirror_view(facet_vertices);
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (int a = 0; a < width; ++a) mirror(f, a) = facets[f][a];
  Kokkos::deep_copy(facet_vertices, mirror);
  LO count = 0;
  Kokkos::parallel_reduce("rpc::fem::pinched_nodes", device_range(d.mesh->num_owned_nodes()),
                          CountPinchedNodes{d.mesh->cells, d.node_to_cells, facet_vertices, element.num_vertices()},
                          count);
  return max_all(d.mesh->comm(), count) > 0;
}

} // namespace rpc::fem
