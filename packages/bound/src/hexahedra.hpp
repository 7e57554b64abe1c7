// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/fem/discretization.hpp"
#include "space_cells.hpp"

#include <memory>

/// Hexahedra of order 1 for the bound in space: its stresses live on tetrahedra that these are split into.                doc/bounds.md (13.9c)
namespace rpc::bound
{

/// Tetrahedra of a mesh of hexahedra, six of each cell, with the same nodes: cell 6 h + k is part of cell h. Faces are cut from their vertex with
/// the lowest Mesh::node_id, so that neighbours agree, and the parts of a cell have its vertex with the lowest one in common.
struct SplitHexahedra {
  std::shared_ptr<const mesh::Mesh> mesh;
  HostView<signed char *[4]> corner; ///< (tetrahedra) vertices of the hexahedron
  static constexpr int parts_of_cell = 6;
  double smallest = 0; ///< least volume of a part, over the mean of its cell's
};
/// Collective.
SplitHexahedra split_hexahedra(const fem::Discretization &d);

/// What kernels over the tetrahedra of hexahedra read. The tables of integrals are exact for degree 4.
struct HexahedraInput : SpaceInput {
  DeviceView<LO **> hexahedra;         ///< (cells of the run, 8)
  DeviceView<signed char *[4]> corner; ///< (tetrahedra) vertices of the hexahedron, in the order of SpaceFacets
  DeviceView<double **> in_whole; ///< (points, 4) barycentric coordinates of the points of integrals over a tetrahedron
  DeviceView<double *> whole_weight; ///< (points) they sum to 1/6
  DeviceView<double ***> at;         ///< (parts, points, 4) barycentric coordinates of the points of integrals
  DeviceView<double **> on_facet;    ///< (points, 3) the same of integrals over facets
  DeviceView<double *> facet_weight; ///< (points) they sum to 1
  fem::BasisTable stiffness;         ///< of the run's stiffness
  fem::NodeToCells around;           ///< tetrahedra around the nodes
  /// (tetrahedra, edges 01 02 03 12 13 23, 2) Where the edge is the diagonal of a face that lies on a contact side, the face's other nodes; else -1.
  DeviceView<LO *[6][2]> flat;
  /// (outer facets, 3) Where the facet is half of a face: which edge of 01, 12, 02 is the diagonal, and the face's other nodes, that of this half
  /// first; else -1.
  DeviceView<LO *[3]> half;
  DeviceView<char *> is_flat;    ///< (outer facets) whether the facet lies on a contact side
  DeviceView<double **> of_edge; ///< (polynomials, edges 01 12 02) means of their products with lambda_a lambda_b

  /// (cells of the run, 24) What loads do at the vertices by the functions of tetrahedra, less what they do by those of hexahedra [N].
  DeviceView<double **> shift;

  LO num_hexahedra() const { return static_cast<LO>(hexahedra.extent(0)); }
};
/// Points of integrals for the input, and the tables of stresses at them.
void tabulate_points(HexahedraInput &in);
/// @param d      of the hexahedra   @param split  of the tetrahedra
/// @param flat   names of the contact sides
HexahedraInput hexahedra_input(const fem::Discretization &d, const fem::Discretization &of_split,
                               const SplitHexahedra &split, const SpaceInput &in, const std::vector<std::string> &flat);

/// The trilinear displacement of hexahedra on their tetrahedra: polynomials of degree 3, which on flat sides are those of `flat`, of degree 1 on
/// each half of a face.                                                                                    doc/bounds.md (13.9d)
struct FieldOfHexahedra {
  HexahedraInput in;
  ReadDisplacement u;    ///< (overlap dofs) at the vertices
  ReadDisplacement flat; ///< (overlap dofs) what is flattened on flat sides; of u itself, or of a part of it
  bool flattened = true;
  static constexpr bool is_linear = false;

  /// Values and derivatives by the coordinates of the tetrahedron at a place of it.
  KOKKOS_FUNCTION void at(const LO c, const double (&lambda)[4], double (&value)[3], double (&H)[3][3]) const
  {
    double vertex[4][3], x[3] = {};
    for (int v = 0; v < 4; ++v) {
      place_of(in.corner(c, v), vertex[v]);
      for (int m = 0; m < 3; ++m) x[m] += lambda[v] * vertex[v][m];
    }
    for (int i = 0; i < 3; ++i) {
      value[i] = 0;
      for (int l = 0; l < 3; ++l) H[i][l] = 0;
    }
    const LO h = c / 6;
    for (int a = 0; a < 8; ++a) {
      double p[3], N[3], dN[3];
      place_of(a, p);
      for (int m = 0; m < 3; ++m) N[m] = (1 + p[m] * x[m]) / 2;
      for (int m = 0; m < 3; ++m) dN[m] = p[m] / 2 * N[(m + 1) % 3] * N[(m + 2) % 3];
      for (int i = 0; i < 3; ++i) {
        const double ui = u(dof(3, in.hexahedra(h, a), i));
        value[i] += N[0] * N[1] * N[2] * ui;
        for (int l = 0; l < 3; ++l)
          for (int m = 0; m < 3; ++m) H[i][l] += ui * dN[m] * (vertex[l + 1][m] - vertex[0][m]);
      }
    }
    for (int e = 0; flattened && e < 6; ++e) {
      if (in.flat(c, e, 0) < 0) continue;
      const int a = e < 3 ? 0 : (e < 5 ? 1 : 2), b = e < 3 ? e + 1 : (e < 5 ? e - 1 : 3);
      for (int i = 0; i < 3; ++i) {
        const double bend = flat(dof(3, in.cells(c, a), i)) + flat(dof(3, in.cells(c, b), i)) -
                            flat(dof(3, in.flat(c, e, 0), i)) - flat(dof(3, in.flat(c, e, 1), i));
        value[i] += bend * lambda[a] * lambda[b];
        for (int l = 0; l < 3; ++l) {
          const double da = a == 0 ? -1 : (a == l + 1 ? 1 : 0), db = b == l + 1 ? 1 : 0;
          H[i][l] += bend * (da * lambda[b] + lambda[a] * db);
        }
      }
    }
  }
  /// Where a vertex of the reference hexahedron lies.
  static KOKKOS_INLINE_FUNCTION void place_of(const int vertex, double (&x)[3])
  {
    x[0] = vertex % 4 == 1 || vertex % 4 == 2 ? 1 : -1;
    x[1] = vertex % 4 >= 2 ? 1 : -1;
    x[2] = vertex >= 4 ? 1 : -1;
  }
  /// du_i / dx_j there.
  KOKKOS_FUNCTION void gradient_there(const AffineTetrahedron &cell, const LO c, const double (&lambda)[4],
                                      double (&D)[3][3]) const
  {
    double value[3], H[3][3];
    at(c, lambda, value, H);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        D[i][j] = H[i][0] * cell.inverse[0][j] + H[i][1] * cell.inverse[1][j] + H[i][2] * cell.inverse[2][j];
  }
  KOKKOS_FUNCTION void gradient_at(const AffineTetrahedron &cell, const LO c, const int s, const int q,
                                   double (&D)[3][3]) const
  {
    const double lambda[4] = {in.at(s, q, 0), in.at(s, q, 1), in.at(s, q, 2), in.at(s, q, 3)};
    gradient_there(cell, c, lambda, D);
  }
};
/// The displacement of the vertices. @param u  (overlap dofs)
FieldOfHexahedra field_of_hexahedra(const HexahedraInput &in, const Vector &u);

/// Energy of a displacement [J] and work of the body force with it. Collective.
struct WorkOfHexahedra {
  double energy = 0, of_body_force = 0;
};
WorkOfHexahedra work_of_hexahedra(const HexahedraInput &in, const Comm &comm, const FieldOfHexahedra &u);
/// Work of the loads on the boundary with a displacement, which is flat on flat sides. Collective.
/// @param u  (overlap dofs)
double work_of_loads(const HexahedraInput &in, const Comm &comm, const BoundaryTractions &boundary, const Vector &u);
/// For HexahedraInput::shift. @param boundary  all loads, those of contact among them
DeviceView<double **> shift_of_loads(const HexahedraInput &in, const BoundaryTractions &boundary);
/// What halves of faces add to SpaceForms::boundary beside the displacement of their vertices.
void add_bends_of_faces(const HexahedraInput &in, const Vector &u, const SpaceForms &forms);

/// Forces of the vertices on the tetrahedra, by which these are in balance, and which come to those of the hexahedra.   doc/bounds.md (13.9e)
/// @param u  (overlap dofs)
DeviceView<double ***> nodal_forces(const HexahedraInput &in, const fem::Discretization &d, const Vector &u);
Tractions mean_moments(const HexahedraInput &in, const Vector &u);
StressDifference stress_difference(const HexahedraInput &in, const Comm &comm, const SpaceForms &forms,
                                   const Tractions &t, const FieldOfHexahedra &u, const DeviceView<double *> &of_cell);

} // namespace rpc::bound
