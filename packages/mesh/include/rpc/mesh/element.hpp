// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace rpc::mesh
{

/// The reference cell: [-1, 1]^dim (interval, quadrilateral, hexahedron), or a simplex, the points of x_i >= 0 with
/// x_1 + ... + x_dim <= 1 (triangle, tetrahedron).
enum class Shape { tensor, simplex };

/// Lagrange element of order 1 or 2: P1 and P2 (simplices), Q1 and Q2 (tensor products) in 2D and 3D, and the tensor products
/// in 1D as edges. Cells are isoparametric: with order 2 their edges and faces are curved.
///
/// A mixed element is a tensor product of order 2 in some directions and of order 1 in others. Coarser meshes of boxes have such cells, for
/// multigrid; decks cannot ask for them, and kernels with a fixed number of nodes do not know them. Its nodes are those of Q2 without the
/// ones in the middle of a linear direction, in their order.
///
/// Dimension, order and shape tell an element, never its number of nodes: a face of a P1 tetrahedron has as many nodes as an
/// edge of a P2 triangle. What depends on the element is asked for here (src/element.cpp holds it as data), in
/// shape_functions.hpp and in quadrature.hpp.
///
/// Nodes, edges and facets are numbered as in Exodus, from 0.
struct Element {
  using Table = std::vector<std::vector<int>>;

  int dim = 2;
  int order = 1;
  Shape shape = Shape::tensor;
  std::array<bool, 3> linear{}; ///< directions of order 1 in a mixed element, whose order is 2

  bool mixed() const { return linear[0] || linear[1] || linear[2]; }
  int order_along(const int direction) const { return linear[direction] ? 1 : order; }
  /// The tensor product that is of order 1 in these directions too.
  Element with_order_one_along(const std::array<bool, 3> &directions) const;

  std::string name() const;        ///< "Q1", "P2"; of mixed ones the order in each direction: "Q212"
  std::string exodus_name() const; ///< "QUAD4", "HEX27", "TRI6", "TETRA10"; of mixed ones ""
  int gmsh_type() const;           ///< gmsh's number of the element type; of mixed ones 0
  int num_nodes() const;           ///< per cell
  int num_vertices() const;        ///< per cell; they are its first nodes
  int num_facets() const;          ///< per cell: edges in 2D, faces in 3D
  int num_facet_nodes() const;     ///< per facet; of no mixed one

  Element facet() const; ///< what its facets are; in 2D and 3D; of no mixed one, whose facets differ
  Element edge() const;  ///< what its edges are; of no mixed one

  /// Position of each node on the reference lattice {0..order}^dim, of mixed elements up to the order of each direction, for simplices
  /// the part of it where the coordinates' sum is <= order: (nodes, dim), vertices first.
  const Table &lattice() const;

  /// Local nodes of each facet, (facets, facet nodes), in the order of the facet's own element. The outward normal is the
  /// tangent turned clockwise (2D), or the cross product of the tangents by the facet's two reference coordinates (3D).
  const Table &facets() const;

  /// Local nodes of each edge, (edges, edge nodes): both ends, then with order 2 the middle. In 2D edges are the facets.
  const Table &edges() const;

  /// (nodes) Place of each node in gmsh's list of a cell's nodes.
  const std::vector<int> &gmsh_place() const;
};

inline bool operator==(const Element &a, const Element &b)
{
  return a.dim == b.dim && a.order == b.order && a.shape == b.shape && a.linear == b.linear;
}

/// Those that the cells of a body can be of: P1, P2, Q1, Q2 in 2D, then in 3D.
const std::vector<Element> &all_elements();

/// The mixed elements of a dimension, 2 or 3.
const std::vector<Element> &mixed_elements(int dim);

/// The element that a cell of gmsh's type is of, if there is one.
std::optional<Element> element_of_gmsh_type(int type);

/// @throws rpc::Error (bad_input) if a box can have no element of that name, listing those that it can have
Element parse_element(const std::string &name, int dim);

} // namespace rpc::mesh
