#pragma once

#include <string>
#include <vector>

namespace rpc::mesh
{

/// What the reference cell is: a product of intervals (quadrilateral, hexahedron) or a simplex (triangle).
enum class Shape { tensor, simplex };

/// Lagrange element: Q1 or Q2 in 2D, Q1 in 3D (Q2's tables are there), P1 or P2 in 2D. Cells are isoparametric: with
/// order 2 their edges follow curved boundaries.
///
/// The kind of element is data. Whoever needs its nodes asks here, whoever needs its shape functions asks
/// fem::tabulate(); a further one is a further case in those two places.
struct Element {
  int dim = 2;
  int order = 1;
  Shape shape = Shape::tensor;

  std::string name() const;        ///< "Q1", "P2"
  std::string exodus_name() const; ///< "QUAD4", "QUAD9", "HEX8", "HEX27", "TRI3", "TRI6"
  int num_nodes() const;           ///< per cell
  int num_vertices() const;        ///< per cell; they are its first nodes
  int num_facet_nodes() const;     ///< per facet
  int num_facets() const;          ///< per cell

  /// Position of each node on the reference lattice {0..order}^dim, for simplices the part of it where the coordinates'
  /// sum is <= order: (nodes, dim), vertices first, as Exodus numbers them.
  const std::vector<std::vector<int>> &lattice() const;

  /// Local nodes of each facet, (facets, facet nodes), vertices first, ordered so that the outward normal is the
  /// tangent turned clockwise (2D) or the cross product of the two tangents (3D).
  const std::vector<std::vector<int>> &facets() const;
};

inline bool operator==(const Element &a, const Element &b)
{
  return a.dim == b.dim && a.order == b.order && a.shape == b.shape;
}

/// @throws rpc::Error (bad_input) if there is no element of that name, listing those that exist
Element parse_element(const std::string &name, int dim);

} // namespace rpc::mesh
