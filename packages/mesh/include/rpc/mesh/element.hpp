#pragma once

#include <string>
#include <vector>

namespace rpc::mesh
{

/// Lagrange element of the tensor-product family: Q1 or Q2 in 2D (quadrilateral) or 3D (hexahedron).
///
/// The kind of element is data. Whoever needs its nodes asks here, whoever needs its shape functions asks
/// fem::tabulate(); a further family (P1, P2) is a further case in those two places.
struct Element {
  int dim = 2;
  int order = 1;

  std::string name() const;        ///< "Q1"
  std::string exodus_name() const; ///< "QUAD4", "QUAD9", "HEX8", "HEX27"
  int num_nodes() const;           ///< per cell
  int num_facet_nodes() const;     ///< per facet
  int num_facets() const;          ///< per cell

  /// Position of each node on the reference lattice {0..order}^dim: (nodes, dim), vertices first, as Exodus numbers
  /// them.
  const std::vector<std::vector<int>> &lattice() const;

  /// Local nodes of each facet, (facets, facet nodes), vertices first, ordered so that the outward normal is the
  /// tangent turned clockwise (2D) or the cross product of the two tangents (3D).
  const std::vector<std::vector<int>> &facets() const;
};

/// @throws rpc::Error (bad_input) if there is no element of that name, listing those that exist
Element parse_element(const std::string &name, int dim);

} // namespace rpc::mesh
