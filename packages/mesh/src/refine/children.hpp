// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh.hpp"

#include <map>
#include <vector>

namespace rpc::mesh
{

/// Kinds of children of a cell, by the nodes of the element of order 2.
struct ChildKinds {
  Element whole;           ///< of order 2
  Element::Table vertices; ///< (kinds, vertices) nodes of the whole, oriented as the element wants it
  Element::Table facets;   ///< (kinds, facets) the whole's facet of which it is a part; -1: it lies inside

  int size() const { return static_cast<int>(vertices.size()); }
  void add(const std::vector<int> &nodes);
  /// Where they lie in the parent's reference cell.
  ChildVertices places() const;
};

/// How the cells of a shape are halved in all directions.
///
/// A tetrahedron leaves an octahedron in the middle, which one of its three diagonals cuts into four: kind 4 + 4 d + i is part i with
/// diagonal d. Other cells have one way, in which the kind is the child's number.
struct Children {
  ChildKinds kinds;
  int per_cell = 0;        ///< children of a cell
  Element::Table diagonal; ///< (3, 2) nodes of the whole; empty unless that is a tetrahedron

  /// Which kind the k-th child is, where the cell has that diagonal.
  int kind(const int k, const int d) const { return k < 4 ? k : k + 4 * d; }
};

/// @param element  of either order
const Children &children_of(const Element &element);

/// The parts of a triangle or tetrahedron some edges of which are halved: it is cut at the first of these edges, from the middle to the
/// vertices that are not on it; then each part at the first edge that is left whole in it. Two cells with a common face divide it alike, for
/// that depends on the order of its own edges only.
class Bisection
{
public:
  /// @param element  a simplex of either order
  explicit Bisection(const Element &element);

  const ChildKinds &kinds() const { return kinds_; } ///< those that were met so far
  /// @param order  (edges) the lowest is halved first; -1: that edge stays
  /// @return kinds of the children, valid until the next call
  const std::vector<int> &children(const std::vector<int> &order);

private:
  void divide(const std::vector<int> &nodes, const std::vector<int> &order);

  ChildKinds kinds_;
  std::map<std::vector<int>, int> kind_of_; // by their vertices
  std::vector<int> found_;
};

/// Where the nodes of children lie in their parent: (kinds, nodes) reference coordinates of the parent; those beyond the dimension are 0.
/// @param element  of the children
ChildVertices child_points(const Element &element, const ChildVertices &vertices);

} // namespace rpc::mesh
