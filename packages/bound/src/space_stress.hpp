// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reference_stress.hpp"
#include "rpc/core/math.hpp"
#include "rpc/core/tpetra.hpp"
#include "space_facets.hpp"

#include <utility>

namespace rpc::bound
{

/// Numbers of a tetrahedron of the order K.
template <int K>
struct SpaceSizes {
  static constexpr int functions = (K + 1) * (K + 2) / 2; ///< polynomials on a facet, and its nodes
  static constexpr int per_facet = 3 * functions, tractions = 4 * per_facet, inner = K == 1 ? 0 : 18;
  static constexpr int columns = tractions + inner, monomials = (K + 1) * (K + 2) * (K + 3) / 6;
  static constexpr int components = 6, coefficients = 4 * components * monomials, nodes = K == 1 ? 4 : 10;
};

/// What polynomials and functions of a triangle have to do with each other; of the order of the element.
struct FacetTables {
  DeviceView<double **> moment; ///< (polynomials, nodes) means of the products
  DeviceView<double **>
      from_moments; ///< (polynomials, nodes) the coefficients that moments with the nodes' functions belong to
  DeviceView<double **> linear;    ///< (3 polynomials, vertices) coefficients of the barycentric coordinates
  DeviceView<double **> bernstein; ///< (polynomials, nodes) coefficients of Bernstein polynomials of the order
  DeviceView<double **> shape;     ///< (points of facet_rule(3, 3), nodes)
};
FacetTables facet_tables(int order);

/// What kernels over tetrahedra read.
struct SpaceInput {
  static constexpr int dim = 3;
  DeviceView<double **> coords; ///< (nodes, 3) [m]
  DeviceView<LO **> cells;      ///< (cells, nodes), in the order of SpaceFacets
  DeviceView<int *> block;      ///< (cells)
  DeviceView<double **> lame;   ///< (blocks; lambda, mu) [Pa]
  double force[3] = {0, 0, 0};  ///< body force [N/m^3]
  SpaceFacets facets;
  ReferenceStress reference;
  FacetTables tables;
  fem::BasisTable stress, load; ///< of the element, exact for the stiffness and for body forces
  DeviceView<int *> kind;       ///< (cells) kinds of congruent cells of one material
  DeviceView<LO *> example;     ///< (kinds) a cell of each
  LO num_owned_cells = 0;       ///< the first ones
  bool of_hexahedra = false;    ///< whether the tetrahedra are parts of hexahedra

  KOKKOS_INLINE_FUNCTION LO num_cells() const { return static_cast<LO>(cells.extent(0)); }
  KOKKOS_INLINE_FUNCTION bool loaded() const { return force[0] != 0 || force[1] != 0 || force[2] != 0; }
};

/// The affine map of a tetrahedron, x = F X + centre.
struct AffineTetrahedron {
  double F[3][3], inverse[3][3], determinant, centre[3]; ///< the determinant without its sign

  KOKKOS_INLINE_FUNCTION AffineTetrahedron(const SpaceInput &in, const LO cell)
  {
    for (int i = 0; i < 3; ++i) {
      const double x0 = in.coords(in.cells(cell, 0), i);
      centre[i] = x0;
      for (int l = 0; l < 3; ++l) {
        F[i][l] = in.coords(in.cells(cell, l + 1), i) - x0;
        centre[i] += F[i][l] / 4;
      }
    }
    double cofactor[3][3];
    for (int i = 0; i < 3; ++i)
      for (int l = 0; l < 3; ++l) {
        const int a = (i + 1) % 3, b = (i + 2) % 3, c = (l + 1) % 3, d = (l + 2) % 3;
        cofactor[i][l] = F[a][c] * F[b][d] - F[a][d] * F[b][c];
      }
    const double oriented = F[0][0] * cofactor[0][0] + F[0][1] * cofactor[0][1] + F[0][2] * cofactor[0][2];
    for (int i = 0; i < 3; ++i)
      for (int l = 0; l < 3; ++l) inverse[l][i] = cofactor[i][l] / oriented;
    determinant = math::magnitude(oriented);
  }
  static KOKKOS_INLINE_FUNCTION void entry(const int component, int &i, int &j)
  {
    i = component < 3 ? component : (component == 3 ? 1 : 0);
    j = component < 3 ? component : (component == 5 ? 1 : 2);
  }
  /// The matrix that makes a stress from its image in the reference cell.
  KOKKOS_INLINE_FUNCTION void stress_map(double (&T)[6][6]) const
  {
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) {
        int i, j, k, l;
        entry(r, i, j);
        entry(c, k, l);
        T[r][c] = (F[i][k] * F[j][l] + (k == l ? 0 : F[i][l] * F[j][k])) / determinant;
      }
  }
  /// The image of a stress.
  KOKKOS_INLINE_FUNCTION void image(const double (&sigma)[3][3], double (&s)[6]) const
  {
    for (int c = 0; c < 6; ++c) {
      int k, l;
      entry(c, k, l);
      s[c] = 0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) s[c] += determinant * inverse[k][i] * sigma[i][j] * inverse[l][j];
    }
  }
};

/// s : C^-1 t in space, as compliance() in the plane.                                                     doc/bounds.md (13.2)
KOKKOS_INLINE_FUNCTION void compliance(const double lambda, const double mu, double (&S)[6][6])
{
  const double a = lambda / (3 * lambda + 2 * mu);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) S[i][j] = i < 3 && j < 3 ? ((i == j ? 1 : 0) - a) / (2 * mu) : (i == j ? 1 / mu : 0);
}

/// The compliance of images, by volume of the reference cell.
KOKKOS_INLINE_FUNCTION void compliance_of_images(const SpaceInput &in, const AffineTetrahedron &cell, const LO c,
                                                 double (&S)[6][6])
{
  double C[6][6], T[6][6], CT[6][6];
  compliance(in.lame(in.block(c), 0), in.lame(in.block(c), 1), C);
  cell.stress_map(T);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      CT[i][j] = 0;
      for (int k = 0; k < 6; ++k) CT[i][j] += C[i][k] * T[k][j];
    }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      S[i][j] = 0;
      for (int k = 0; k < 6; ++k) S[i][j] += T[k][i] * CT[k][j] * cell.determinant;
    }
}

using ReadDisplacement = decltype(device_read(std::declval<const Vector &>()));

/// du_i / dX_l from gradients of the shape functions.
template <class Gradient>
KOKKOS_INLINE_FUNCTION void gradient_in_space(const SpaceInput &in, const AffineTetrahedron &cell, const LO c,
                                              const ReadDisplacement &u, const Gradient &gradient, double (&D)[3][3])
{
  double H[3][3] = {};
  for (int a = 0; a < static_cast<int>(in.cells.extent(1)); ++a)
    for (int i = 0; i < 3; ++i)
      for (int l = 0; l < 3; ++l) H[i][l] += u(dof(3, in.cells(c, a), i)) * gradient(a, l);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      D[i][j] = 0;
      for (int l = 0; l < 3; ++l) D[i][j] += H[i][l] * cell.inverse[l][j];
    }
}

/// C eps of a displacement gradient.
KOKKOS_INLINE_FUNCTION void stress_of_gradient(const double lambda, const double mu, const double (&D)[3][3],
                                               double (&s)[3][3])
{
  const double trace = D[0][0] + D[1][1] + D[2][2];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) s[i][j] = mu * (D[i][j] + D[j][i]) + (i == j ? lambda * trace : 0);
}

/// What spans the linear tractions of a facet: the first moments of its place with the two polynomials of degree 1, and the normal as long as
/// the parallelogram of these, not outward.
struct FacetFrame {
  double centre[3], along[2][3], normal[3];

  KOKKOS_INLINE_FUNCTION FacetFrame(const SpaceInput &in, const LO f)
  {
    for (int i = 0; i < 3; ++i) {
      centre[i] = along[0][i] = along[1][i] = 0;
      for (int v = 0; v < 3; ++v) {
        const double x = in.coords(in.facets.node(f, v), i);
        centre[i] += x / 3;
        for (int j = 0; j < 2; ++j)
          along[j][i] += in.tables.linear(1 + j, v) * (x - in.coords(in.facets.node(f, 0), i));
      }
    }
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      normal[i] = along[0][a] * along[1][b] - along[0][b] * along[1][a];
    }
  }
};

/// Coefficients of the tractions, times areas, of the stress that takes up the body force, on facet s of a cell and outward.
KOKKOS_INLINE_FUNCTION void traction_of_force(const SpaceInput &in, const AffineTetrahedron &cell, const LO c,
                                              const int s, double (&t)[3][3])
{
  double x[3][3], n[3]; // corners, outward normal as long as the area
  int k = 0;
  for (int v = 0; v < 4; ++v)
    if (v != s) {
      for (int i = 0; i < 3; ++i) x[k][i] = in.coords(in.cells(c, v), i);
      ++k;
    }
  double outward = 0;
  for (int i = 0; i < 3; ++i) {
    const int a = (i + 1) % 3, b = (i + 2) % 3;
    n[i] = ((x[1][a] - x[0][a]) * (x[2][b] - x[0][b]) - (x[1][b] - x[0][b]) * (x[2][a] - x[0][a])) / 2;
    outward += n[i] * (x[0][i] - cell.centre[i]);
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      t[j][i] = 0;
      for (int v = 0; v < 3; ++v)
        t[j][i] -= in.tables.linear(j, v) * in.force[i] * (x[v][i] - cell.centre[i]) * (outward > 0 ? n[i] : -n[i]);
    }
}

/// What the tractions on a cell's facets leave of its balance.
struct CellBalance {
  double force[3], moment[3];   ///< [N], [N m] about the cell's centre
  double largest = 0, size = 0; ///< force on a facet [N]; of the cell [m]

  /// @param T  a facet's force, then its two moments along the facet   @param arm  of the facet's centre   @param along  what the moments are by
  KOKKOS_INLINE_FUNCTION void add(const double *const T, const double (&arm)[3], const double (&along)[2][3])
  {
    for (int i = 0; i < 3; ++i) {
      force[i] += T[i];
      largest = math::fmax(largest, math::magnitude(T[i]) + math::magnitude(T[3 + i]) + math::magnitude(T[6 + i]));
      size = math::fmax(size, 3 * math::magnitude(arm[i]));
    }
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      moment[i] += arm[a] * T[b] - arm[b] * T[a];
      for (int j = 0; j < 2; ++j) moment[i] += along[j][a] * T[3 + 3 * j + b] - along[j][b] * T[3 + 3 * j + a];
    }
  }
  /// Raises what is left at most, a force or a moment by the size, and the largest force on a facet.
  KOKKOS_INLINE_FUNCTION void judge(double &imbalance, double &of_facet) const
  {
    for (int i = 0; i < 3; ++i)
      imbalance = math::fmax(imbalance, math::fmax(math::magnitude(force[i]), math::magnitude(moment[i]) / size));
    of_facet = math::fmax(of_facet, largest);
  }
};

} // namespace rpc::bound
