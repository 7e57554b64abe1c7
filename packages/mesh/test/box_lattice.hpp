// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/box.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <string>
#include <vector>

/// Boxes, and the lattices on which their nodes and cells must lie.
namespace rpc::test
{

using Position = std::array<GO, 3>;

/// A cell of the lattice, or of a mesh of simplices one of those that it is divided into.
struct Cell {
  Position corner{};
  int part = 0;
};

/// Boxes of different shapes, flat and thin ones too, all divisible among up to 4 ranks.
inline std::vector<mesh::BoxOptions> boxes()
{
  return {{{-1, 2}, {1.5, 3}, {5, 3}, mesh::Element{2, 1}},
          {{-1, 2}, {1.5, 3}, {3, 4}, mesh::Element{2, 2}},
          {{0, 0}, {7, 1}, {7, 1}, mesh::Element{2, 1}},
          {{0, 0}, {1, 7}, {1, 7}, mesh::Element{2, 2}},
          {{-1, 2, 0.5}, {0, 3, 4}, {3, 2, 4}, mesh::Element{3, 1}},
          {{-1, 2, 0.5}, {0, 3, 4}, {2, 2, 3}, mesh::Element{3, 2}},
          {{-1, 2}, {1.5, 3}, {5, 3}, mesh::Element{2, 1, mesh::Shape::simplex}},
          {{-1, 2}, {1.5, 3}, {3, 4}, mesh::Element{2, 2, mesh::Shape::simplex}},
          {{0, 0}, {1, 7}, {1, 7}, mesh::Element{2, 1, mesh::Shape::simplex}},
          {{0, 0}, {7, 1}, {7, 1}, mesh::Element{2, 2, mesh::Shape::simplex}},
          {{-1, 2, 0.5}, {0, 3, 4}, {3, 2, 4}, mesh::Element{3, 1, mesh::Shape::simplex}},
          {{-1, 2, 0.5}, {0, 3, 4}, {2, 2, 3}, mesh::Element{3, 2, mesh::Shape::simplex}},
          {{0, 0, 0}, {1, 1, 5}, {1, 1, 5}, mesh::Element{3, 1, mesh::Shape::simplex}}};
}

inline std::string text_of(const mesh::BoxOptions &box)
{
  std::ostringstream text;
  text << box.element.name() << ", cells";
  for (const int n : box.cells) text << ' ' << n;
  return text.str();
}

/// The lattices of a whole box, and where a rank's nodes and cells lie on them by their coordinates.
struct Lattice {
  const mesh::BoxOptions &box;
  int dim = box.element.dim, order = box.element.order;
  bool simplex = box.element.shape == mesh::Shape::simplex;
  int parts = !simplex ? 1 : (dim == 2 ? 2 : 6); // cells of the mesh in one of the lattice

  GO extent(const int d, const int per_cell) const { return GO(per_cell) * box.cells[d]; }
  GO num_nodes() const { return count(order, 1); }
  GO num_cells() const { return parts * count(1, 0); } // of the mesh
  GO count(const int per_cell, const int more) const
  {
    GO n = 1;
    for (int d = 0; d < dim; ++d) n *= extent(d, per_cell) + more;
    return n;
  }
  GO id(const Position &at, const int per_cell, const int more) const // x fastest
  {
    GO result = 0;
    for (int d = dim - 1; d >= 0; --d) result = result * (extent(d, per_cell) + more) + at[d];
    return result;
  }
  Position position(GO index, const int per_cell, const int more) const
  {
    Position at{};
    for (int d = 0; d < dim; ++d) {
      at[d] = index % (extent(d, per_cell) + more);
      index /= extent(d, per_cell) + more;
    }
    return at;
  }
  double coordinate(const GO at, const int d) const
  {
    return box.lower[d] + (box.upper[d] - box.lower[d]) * at / extent(d, order);
  }
  /// From a node's coordinates, which must lie on the lattice.
  template <class Coords>
  Position node_position(const Coords &coords, const LO lid) const
  {
    Position at{};
    for (int d = 0; d < dim; ++d) {
      const double t = (coords(lid, d) - box.lower[d]) / (box.upper[d] - box.lower[d]) * extent(d, order);
      at[d] = std::llround(t);
      EXPECT_NEAR(t, at[d], 1e-12 * extent(d, order));
    }
    return at;
  }
  GO node_id(const Position &at) const { return id(at, order, 1); }
  GO cell_id(const Cell &cell) const { return parts * id(cell.corner, 1, 0) + cell.part; }
  Cell cell(const GO cell_id) const { return {position(cell_id / parts, 1, 0), static_cast<int>(cell_id % parts)}; }
  /// Vertices of a tetrahedron in the unit cell: from (0, 0, 0) along its edges to (1, 1, 1), directions in the part's order;
  /// two of them are swapped where the volume would be negative.
  static std::vector<Position> tetrahedron(const int part)
  {
    static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    std::vector<Position> vertex(4);
    for (int v = 1; v < 4; ++v) {
      vertex[v] = vertex[v - 1];
      vertex[v][order[part][v - 1]] = 1;
    }
    const bool mirrored = part == 1 || part == 2 || part == 5;
    if (mirrored) std::swap(vertex[1], vertex[2]);
    return vertex;
  }
  Position node_of(const Cell &cell, const int a) const
  {
    Position at{};
    const auto &step = box.element.lattice()[a];
    for (int d = 0; d < dim; ++d) {
      at[d] = order * cell.corner[d];
      if (simplex && dim == 3) // vertex 0 is at the corner
        for (int k = 0; k < dim; ++k) at[d] += step[k] * tetrahedron(cell.part)[k + 1][d];
      else // the second triangle is the first turned by 180 degrees
        at[d] += cell.part == 0 ? step[d] : order - step[d];
    }
    return at;
  }
  std::set<GO> nodes_of(const Cell &cell) const
  {
    std::set<GO> nodes;
    for (int a = 0; a < box.element.num_nodes(); ++a) nodes.insert(node_id(node_of(cell, a)));
    return nodes;
  }
};

/// A box's mesh with the lattice position of each local node and cell.
struct Made {
  mesh::BoxOptions box;
  Lattice lattice{box};
  mesh::Mesh mesh = mesh::make_box(box, Tpetra::getDefaultComm());
  HostView<double **> coords{"coords", mesh.coords.extent(0), mesh.coords.extent(1)};
  HostView<LO **> cells{"cells", mesh.cells.extent(0), mesh.cells.extent(1)};
  std::vector<Position> node;
  std::vector<Cell> cell;

  explicit Made(const mesh::BoxOptions &options) : box(options)
  {
    Kokkos::deep_copy(coords, to_host(mesh.coords));
    Kokkos::deep_copy(cells, to_host(mesh.cells));
    for (LO n = 0; n < mesh.num_local_nodes(); ++n) node.push_back(lattice.node_position(coords, n));
    for (LO c = 0; c < mesh.num_cells(); ++c) cell.push_back(place_of(c));
  }
  Cell place_of(const LO c) const
  {
    Cell place{node[cells(c, 0)], 0};
    for (std::size_t a = 1; a < cells.extent(1); ++a)
      for (int d = 0; d < 3; ++d) place.corner[d] = std::min(place.corner[d], node[cells(c, a)][d]);
    for (GO &corner : place.corner) corner /= mesh.element.order;
    const auto fits = [&](const int part) {
      for (int a = 0; a < mesh.element.num_vertices(); ++a)
        if (lattice.node_of({place.corner, part}, a) != node[cells(c, a)]) return false;
      return true;
    };
    while (place.part < lattice.parts && !fits(place.part)) ++place.part;
    EXPECT_LT(place.part, lattice.parts) << "cell " << c << " is none of the parts of a cell of the lattice";
    return place;
  }
  GO node_id(const LO lid) const { return lattice.node_id(node[lid]); }
};

/// check(Made) for each of the boxes: divided among all ranks, and on one or two of them.
template <class Check>
void for_each_box(const Check &check)
{
  const int ranks = Tpetra::getDefaultComm()->getSize();
  for (mesh::BoxOptions &box : boxes())
    for (int blocks = 0; blocks < std::min(ranks, 3); ++blocks) {
      box.blocks = blocks;
      SCOPED_TRACE(text_of(box) + ", blocks: " + std::to_string(blocks));
      check(Made(box));
    }
}

} // namespace rpc::test
