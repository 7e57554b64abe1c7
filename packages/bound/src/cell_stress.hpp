// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "facets.hpp"
#include "reference_stress.hpp"
#include "revolution_tables.hpp"
#include "rpc/core/math.hpp"

namespace rpc::bound
{

/// What kernels over cells read.
struct CellInput {
  static constexpr int dim = 2;
  DeviceView<double **> coords; ///< (nodes, 2) [m]
  DeviceView<LO **> cells;      ///< (cells, nodes)
  DeviceView<int *> block;      ///< (cells)
  DeviceView<double **> lame;   ///< (blocks; lambda, mu) [Pa]
  double force[2] = {0, 0};     ///< body force [N/m^3]
  Facets facets;
  ReferenceStress reference;
  RevolutionTables revolution; ///< of bodies of revolution
  double on_axis = 0;          ///< of these: places with r up to this lie on the axis [m]

  DeviceView<int *> kind;   ///< (cells) kinds of congruent cells of one material; of bodies of revolution each is one
  DeviceView<LO *> example; ///< (kinds) a cell of each
  LO num_owned_cells = 0;   ///< the first ones

  LO num_cells() const { return static_cast<LO>(cells.extent(0)); }
  KOKKOS_INLINE_FUNCTION bool of_revolution() const { return revolution.columns > 0; }
};

/// The affine map of a cell, x = F X + centre, with what follows from it.
struct AffineCell {
  double F[2][2], inverse[2][2], determinant, centre[2];

  KOKKOS_INLINE_FUNCTION AffineCell(const CellInput &in, const LO cell)
  {
    const int sides = in.reference.sides, last = sides - 1;
    const double half = sides == 3 ? 1 : 0.5; // the reference square has sides of 2
    for (int i = 0; i < 2; ++i) {
      F[i][0] = half * (in.coords(in.cells(cell, 1), i) - in.coords(in.cells(cell, 0), i));
      F[i][1] = half * (in.coords(in.cells(cell, last), i) - in.coords(in.cells(cell, 0), i));
      centre[i] = 0;
      for (int v = 0; v < sides; ++v) centre[i] += in.coords(in.cells(cell, v), i) / sides;
    }
    determinant = F[0][0] * F[1][1] - F[0][1] * F[1][0];
    inverse[0][0] = F[1][1] / determinant;
    inverse[1][1] = F[0][0] / determinant;
    inverse[0][1] = -F[0][1] / determinant;
    inverse[1][0] = -F[1][0] / determinant;
  }
  /// The 3 x 3 matrix that makes xx, yy, xy of a stress from those of its image in the reference cell.
  KOKKOS_INLINE_FUNCTION void stress_map(double (&T)[3][3]) const
  {
    for (int r = 0; r < 3; ++r) {
      const int i = r == 1 ? 1 : 0, j = r == 0 ? 0 : 1;
      T[r][0] = F[i][0] * F[j][0] / determinant;
      T[r][1] = F[i][1] * F[j][1] / determinant;
      T[r][2] = (F[i][0] * F[j][1] + F[i][1] * F[j][0]) / determinant;
    }
  }
};

/// s : C^-1 t for components xx, yy, xy.                                                                  doc/bounds.md (13.2)
KOKKOS_INLINE_FUNCTION void compliance(const double lambda, const double mu, double (&S)[3][3])
{
  const double a = lambda / (2 * (lambda + mu));
  for (auto &row : S)
    for (double &entry : row) entry = 0;
  S[0][0] = S[1][1] = (1 - a) / (2 * mu);
  S[0][1] = S[1][0] = -a / (2 * mu);
  S[2][2] = 1 / mu;
}

/// The complementary energy of a cell as a function of its tractions, inner stresses and the stress that takes up the body force:
/// its second derivatives in reference tractions and inner stresses, and the first ones of the body force.
struct CellEnergy {
  static constexpr int most = ReferenceStress::most_columns;
  double A[most][most], of_force[most];
  double S[3][3];            ///< compliance of images, by reference area
  double force_stress[2][3]; ///< image of the stress that takes up the body force: coefficients of X_l

  /// @param first  rows of A before it are left out
  KOKKOS_INLINE_FUNCTION CellEnergy(const CellInput &in, const AffineCell &cell, const LO c, const int first)
  {
    double C[3][3], T[3][3];
    compliance(in.lame(in.block(c), 0), in.lame(in.block(c), 1), C);
    cell.stress_map(T);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        S[i][j] = 0;
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l) S[i][j] += T[k][i] * C[k][l] * T[l][j] * cell.determinant;
      }
    const double s[6] = {S[0][0], S[1][1], S[2][2], S[0][1], S[0][2], S[1][2]};
    const int n = in.reference.columns();
    for (int i = first; i < n; ++i)
      for (int j = 0; j < n; ++j) A[i][j] = 0;
    for (int p = 0; p < 6; ++p)
      for (int i = first; i < n; ++i)
        for (int j = 0; j < n; ++j) A[i][j] += s[p] * in.reference.energy(p, i, j);
    const auto &G = cell.inverse;
    for (int l = 0; l < 2; ++l) {
      const double a = -in.force[0] * cell.F[0][l], b = -in.force[1] * cell.F[1][l], d = cell.determinant;
      force_stress[l][0] = d * (G[0][0] * G[0][0] * a + G[0][1] * G[0][1] * b);
      force_stress[l][1] = d * (G[1][0] * G[1][0] * a + G[1][1] * G[1][1] * b);
      force_stress[l][2] = d * (G[0][0] * G[1][0] * a + G[0][1] * G[1][1] * b);
    }
    const bool no_force = in.force[0] == 0 && in.force[1] == 0;
    for (int i = 0; i < n; ++i) {
      of_force[i] = 0;
      if (no_force || i < first) continue;
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 2; ++l)
          for (int m = 0; m < 3; ++m) of_force[i] += in.reference.moment(k, l, i) * S[k][m] * force_stress[l][m];
    }
  }

  /// Solves for the inner stresses in place: x <- A_zz^-1 x, with the Cholesky factor that factor_inner() has left in A.
  KOKKOS_INLINE_FUNCTION void factor_inner(const int first, const int n)
  {
    for (int j = first; j < n; ++j) {
      for (int k = first; k < j; ++k)
        for (int i = j; i < n; ++i) A[i][j] -= A[i][k] * A[j][k];
      const double pivot = math::sqrt(A[j][j]);
      for (int i = j; i < n; ++i) A[i][j] /= pivot;
    }
  }
  KOKKOS_INLINE_FUNCTION void solve_inner(const int first, const int n, double *x) const
  {
    for (int i = first; i < n; ++i) {
      for (int k = first; k < i; ++k) x[i] -= A[i][k] * x[k];
      x[i] /= A[i][i];
    }
    for (int i = n - 1; i >= first; --i) {
      for (int k = i + 1; k < n; ++k) x[i] -= A[k][i] * x[k];
      x[i] /= A[i][i];
    }
  }
};

/// Traction coefficients (side, degree, component) of the stress that takes up the body force, counterclockwise, outward.
KOKKOS_INLINE_FUNCTION void tractions_of_force(const CellInput &in, const AffineCell &cell, const LO c, double *t)
{
  const int k = in.reference.degree, sides = in.reference.sides;
  for (int s = 0; s < sides; ++s) {
    double x[2][2]; // both ends
    for (int e = 0; e < 2; ++e)
      for (int i = 0; i < 2; ++i) x[e][i] = in.coords(in.cells(c, (s + e) % sides), i);
    const double n[2] = {x[1][1] - x[0][1], x[0][0] - x[1][0]};
    for (int i = 0; i < 2; ++i) {
      const double at0 = -in.force[i] * (x[0][i] - cell.centre[i]) * n[i],
                   at1 = -in.force[i] * (x[1][i] - cell.centre[i]) * n[i];
      for (int j = 0; j <= k; ++j)
        t[(s * (k + 1) + j) * 2 + i] = j == 0 ? (at0 + at1) / 2 : (j == 1 ? (at1 - at0) / 2 : 0);
    }
  }
}

/// Factor of a facet's coefficient of a degree that makes it that of the traction on a cell, counterclockwise.
KOKKOS_INLINE_FUNCTION double side_factor(const signed char sign, const int degree)
{
  return sign > 0 || degree % 2 == 1
             ? 1
             : -1; // the traction changes its sign, and a polynomial of odd degree with the direction too
}

/// int P_j u over a side for a displacement u of the element, by its values at both ends and in the middle.
KOKKOS_INLINE_FUNCTION double legendre_moment(const int order, const int j, const double a, const double b,
                                              const double m)
{
  if (j == 0) return order == 1 ? (a + b) / 2 : (a + b + 4 * m) / 6;
  if (j == 1) return (b - a) / 6;
  return (a + b - 2 * m) / 15;
}

} // namespace rpc::bound
