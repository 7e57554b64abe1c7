#pragma once

#include "rpc/mesh/element.hpp"

#include <array>
#include <vector>

namespace rpc::mesh
{

/// How the cells of a shape are divided, by the nodes of the element of order 2.
///
/// A tetrahedron leaves an octahedron in the middle, which one of its three diagonals cuts into four: kind 4 + 4 d + i is part i with
/// diagonal d. Other cells have one way, in which the kind is the child's number.
struct Children {
  Element whole;           ///< of order 2
  int per_cell = 0;        ///< children of a cell
  Element::Table vertices; ///< (kinds, vertices) nodes of the whole, oriented as the element wants it
  Element::Table facets;   ///< (kinds, facets) the whole's facet of which it is a part; -1: it lies inside
  Element::Table diagonal; ///< (3, 2) nodes of the whole; empty unless that is a tetrahedron

  /// Which kind the k-th child is, where the cell has that diagonal.
  int kind(const int k, const int d) const { return k < 4 ? k : k + 4 * d; }
};

/// @param element  of either order
const Children &children_of(const Element &element);

/// Where the nodes of a child lie in its parent: (kinds, nodes) reference coordinates of the parent; those beyond the dimension are 0.
std::vector<std::vector<std::array<double, 3>>> child_points(const Element &element);

} // namespace rpc::mesh
