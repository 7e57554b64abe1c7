// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

namespace rpc::mesh
{

/// A shape of cells of a body in files, of order 1 and 2. Nodes are numbered as by gmsh, from 0: vertices, then with order 2 the middles of
/// edges, of quadrilateral faces, and of a hexahedron or quadrilateral itself. Serendipity cells lack those of faces and cells.
struct CellKind {
  int dim = 3;
  int linear = 0, serendipity = 0,
      quadratic = 0; ///< gmsh's types; serendipity is 0 for simplices, which have no such nodes
  std::string noun, plural;
  int num_vertices = 0;
  std::vector<std::vector<int>> faces;   ///< vertices of each face around it, seen from outside; of a plane cell none
  std::vector<std::array<int, 2>> edges; ///< ends, in the order of their middle nodes

  int num_quadrilaterals() const; ///< faces of four vertices
  int num_nodes(int type) const;  ///< of a cell of one of the three types
  bool simplex() const { return serendipity == 0; }
  /// The node of order 2 between two vertices: of an edge, of a face whose diagonal they are, or else of the cell.
  int middle(int a, int b) const;
  /// Nodes of a face: vertices, middles of edges, and the middle of a quadrilateral.
  std::vector<int> nodes_of_face(int face) const;
};

/// The kind of cells of gmsh's type; nullptr where no body can be of such cells.
const CellKind *cell_kind(int gmsh_type);

} // namespace rpc::mesh
