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

  /// Where a vertex of the reference hexahedron lies.
  static KOKKOS_INLINE_FUNCTION void place_of(const int vertex, double (&x)[3])
  {
    x[0] = vertex % 4 == 1 || vertex % 4 == 2 ? 1 : -1;
    x[1] = vertex % 4 >= 2 ? 1 : -1;
    x[2] = vertex >= 4 ? 1 : -1;
  }

  /// In one tetrahedron.
  struct Here {
    static constexpr bool is_linear = false;
    const HexahedraInput &in;
    double of_power
        [8]
        [3]; ///< coefficients of the powers x^a y^b z^c of the place in the hexahedron, a + 2 b + 4 c, with a, b, c = 0, 1
    double vertex[4][3]; ///< of the tetrahedron in the hexahedron
    double slope[4][3];  ///< derivatives of the barycentric coordinates
    double map[3][3];    ///< of the place in the hexahedron
    double bend[6][3];   ///< of edges 01 02 03 12 13 23
    bool bends[6];

    KOKKOS_FUNCTION Here(const FieldOfHexahedra &field, const AffineTetrahedron &cell, const LO c) : in(field.in)
    {
      constexpr int corner[8] = {0, 1, 3, 2, 4, 5, 7, 6}; // by the signs of its place
      for (int k = 0; k < 8; ++k)
        for (int i = 0; i < 3; ++i) of_power[k][i] = field.u(dof(3, in.hexahedra(c / 6, corner[k]), i));
      for (int bit = 1; bit < 8; bit *= 2)
        for (int k = 0; k < 8; ++k)
          for (int i = 0; i < 3 && !(k & bit); ++i) {
            const double low = of_power[k][i], high = of_power[k | bit][i];
            of_power[k][i] = (high + low) / 2;
            of_power[k | bit][i] = (high - low) / 2;
          }
      for (int v = 0; v < 4; ++v) place_of(in.corner(c, v), vertex[v]);
      for (int j = 0; j < 3; ++j) {
        slope[0][j] = -(cell.inverse[0][j] + cell.inverse[1][j] + cell.inverse[2][j]);
        for (int l = 0; l < 3; ++l) slope[l + 1][j] = cell.inverse[l][j];
        for (int m = 0; m < 3; ++m) {
          map[m][j] = 0;
          for (int v = 0; v < 4; ++v) map[m][j] += vertex[v][m] * slope[v][j];
        }
      }
      for (int e = 0; e < 6; ++e) {
        int a, b;
        ends_of(e, a, b);
        bends[e] = field.flattened && in.flat(c, e, 0) >= 0;
        for (int i = 0; i < 3 && bends[e]; ++i)
          bend[e][i] = field.flat(dof(3, in.cells(c, a), i)) + field.flat(dof(3, in.cells(c, b), i)) -
                       field.flat(dof(3, in.flat(c, e, 0), i)) - field.flat(dof(3, in.flat(c, e, 1), i));
      }
    }
    static KOKKOS_INLINE_FUNCTION void ends_of(const int e, int &a, int &b)
    {
      a = e < 3 ? 0 : (e < 5 ? 1 : 2);
      b = e < 3 ? e + 1 : (e < 5 ? e - 1 : 3);
    }
    KOKKOS_INLINE_FUNCTION void place(const double (&lambda)[4], double (&x)[3]) const
    {
      for (int m = 0; m < 3; ++m)
        x[m] =
            lambda[0] * vertex[0][m] + lambda[1] * vertex[1][m] + lambda[2] * vertex[2][m] + lambda[3] * vertex[3][m];
    }
    KOKKOS_INLINE_FUNCTION void value(const double (&lambda)[4], double (&u)[3]) const
    {
      double x[3];
      place(lambda, x);
      const auto &c = of_power;
      for (int i = 0; i < 3; ++i)
        u[i] = c[0][i] + x[0] * (c[1][i] + x[1] * (c[3][i] + x[2] * c[7][i]) + x[2] * c[5][i]) +
               x[1] * (c[2][i] + x[2] * c[6][i]) + x[2] * c[4][i];
      for (int e = 0; e < 6; ++e) {
        int a, b;
        ends_of(e, a, b);
        for (int i = 0; i < 3 && bends[e]; ++i) u[i] += bend[e][i] * lambda[a] * lambda[b];
      }
    }
    /// du_i / dx_j.
    KOKKOS_INLINE_FUNCTION void gradient(const double (&lambda)[4], double (&D)[3][3]) const
    {
      double x[3];
      place(lambda, x);
      const auto &c = of_power;
      for (int i = 0; i < 3; ++i) {
        const double by[3] = {c[1][i] + x[1] * c[3][i] + x[2] * (c[5][i] + x[1] * c[7][i]),
                              c[2][i] + x[0] * c[3][i] + x[2] * (c[6][i] + x[0] * c[7][i]),
                              c[4][i] + x[0] * c[5][i] + x[1] * (c[6][i] + x[0] * c[7][i])};
        for (int j = 0; j < 3; ++j) D[i][j] = by[0] * map[0][j] + by[1] * map[1][j] + by[2] * map[2][j];
      }
      for (int e = 0; e < 6; ++e) {
        if (!bends[e]) continue;
        int a, b;
        ends_of(e, a, b);
        for (int j = 0; j < 3; ++j) {
          const double product = slope[a][j] * lambda[b] + lambda[a] * slope[b][j];
          for (int i = 0; i < 3; ++i) D[i][j] += bend[e][i] * product;
        }
      }
    }
    /// At a point of a part.
    KOKKOS_INLINE_FUNCTION void gradient(const int s, const int q, double (&D)[3][3]) const
    {
      const double lambda[4] = {in.at(s, q, 0), in.at(s, q, 1), in.at(s, q, 2), in.at(s, q, 3)};
      gradient(lambda, D);
    }
  };
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
