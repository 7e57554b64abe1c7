// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "beside_inverse.hpp"
#include "cell_stress.hpp"
#include "rpc/core/tpetra.hpp"

#include <utility>

namespace rpc::bound
{

/// What replaces 1/(2 pi r) in a part of a cell: where it meets the axis in a corner integrals close up there, and where it has an edge on the
/// axis they are those of polynomials.                                                                   doc/bounds.md (13.10c)
struct InverseRadius {
  int arrangement = 0;
  bool edge_on_axis = false;
  double a = 0, b = 0; ///< between which 2 pi r is, or 2 pi r over the part of the way from the corner on the axis

  KOKKOS_INLINE_FUNCTION InverseRadius(const CellInput &in, const LO c, const double centre, const int s)
  {
    double r[3] = {centre, in.coords(in.cells(c, s), 0), in.coords(in.cells(c, (s + 1) % in.reference.sides), 0)};
    const bool first = r[1] <= in.on_axis, second = r[2] <= in.on_axis;
    edge_on_axis = first && second;
    if (first != second) arrangement = first ? 1 : 2;
    for (int corner = 0, any = 0; corner < 3; ++corner) {
      if (arrangement > 0 && corner == arrangement) continue;
      a = any ? math::fmin(a, 2 * Circle::pi * r[corner]) : 2 * Circle::pi * r[corner];
      b = any++ ? math::fmax(b, 2 * Circle::pi * r[corner]) : 2 * Circle::pi * r[corner];
    }
  }
  KOKKOS_INLINE_FUNCTION double at(const CellInput &in, const int q, const double circle, const bool above) const
  {
    if (edge_on_axis) return 1 / circle;
    if (arrangement == 0) return beside_inverse(circle, a, b, above);
    const double away = in.revolution.from_end(q);
    return beside_inverse(circle / away, a, b, above) / away;
  }
};

/// The complementary energy of a cell of a body of revolution by the tractions of S and inner stresses, under the condition that S has no
/// divergence along the axis, and vanishes on it.                                                         doc/bounds.md (13.10b)
struct RevolutionEnergy {
  using ReadDisplacement = decltype(device_read(std::declval<const Vector &>()));
  static constexpr int most = RevolutionTables::most_columns, most_inner = RevolutionTables::most_inner,
                       most_conditions = RevolutionTables::most_conditions;
  const CellInput &in;
  LO c;
  AffineCell cell;
  int columns, inner, conditions = 0;
  double T[3][3], C[4][4];         ///< map of stresses; compliance of rr, zz, rz and around the axis
  double A[most][most], g[most];   ///< second and first derivatives
  double D[most_conditions][most]; ///< conditions on the columns [N]
  double Y[most_inner][most_conditions], H[most_conditions][most_conditions]; ///< of the multipliers, after factor()

  /// Without A, g, D.
  KOKKOS_FUNCTION RevolutionEnergy(const CellInput &input, const LO of_cell)
      : in(input), c(of_cell), cell(input, of_cell), columns(input.revolution.columns), inner(input.revolution.inner)
  {
    const double lambda = in.lame(in.block(c), 0), mu = in.lame(in.block(c), 1), a = lambda / (3 * lambda + 2 * mu);
    cell.stress_map(T);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) C[i][j] = (i == 2 || j == 2 ? 0 : ((i == j ? 1 : 0) - a) / (2 * mu));
    C[2][2] = 1 / mu;
  }
  KOKKOS_FUNCTION RevolutionEnergy(const CellInput &input, const ReadDisplacement &u, const LO of_cell)
      : RevolutionEnergy(input, of_cell)
  {
    for (int i = 0; i < columns; ++i) {
      g[i] = 0;
      for (int j = 0; j < columns; ++j) A[i][j] = 0;
    }
    for (int s = 0; s < in.reference.sides; ++s) add_part(u, s);
    add_conditions();
  }

  KOKKOS_FUNCTION double circle(const int e, const int s, const int q) const
  {
    const auto &X = in.revolution.place;
    return 2 * Circle::pi * (cell.centre[0] + cell.F[0][0] * X(e, s, q, 0) + cell.F[0][1] * X(e, s, q, 1));
  }
  /// 2 pi r (rr, zz, rz, around) of C eps(u) at a point, and of the stress that takes up the body force.
  KOKKOS_FUNCTION void fields_at(const ReadDisplacement &u, const int e, const int s, const int q, double (&of_u)[4],
                                 double (&of_force)[4]) const
  {
    double gradient[2][2] = {}, D_u[2][2] = {}, u_r = 0;
    for (int a = 0; a < static_cast<int>(in.cells.extent(1)); ++a) {
      u_r += u(dof(2, in.cells(c, a), 0)) * in.revolution.shape(e, s, q, a);
      for (int i = 0; i < 2; ++i)
        for (int l = 0; l < 2; ++l)
          gradient[i][l] += u(dof(2, in.cells(c, a), i)) * in.revolution.gradient(e, s, q, a, l);
    }
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        for (int l = 0; l < 2; ++l) D_u[i][j] += gradient[i][l] * cell.inverse[l][j];
    const double lambda = in.lame(in.block(c), 0), mu = in.lame(in.block(c), 1), around = circle(e, s, q),
                 hoop = 2 * Circle::pi * u_r, trace = around * (D_u[0][0] + D_u[1][1]) + hoop;
    of_u[0] = lambda * trace + 2 * mu * around * D_u[0][0];
    of_u[1] = lambda * trace + 2 * mu * around * D_u[1][1];
    of_u[2] = mu * around * (D_u[0][1] + D_u[1][0]);
    of_u[3] = lambda * trace + 2 * mu * hoop;
    const auto &X = in.revolution.place;
    const double z = cell.centre[1] + cell.F[1][0] * X(e, s, q, 0) + cell.F[1][1] * X(e, s, q, 1);
    of_force[0] = of_force[2] = 0;
    of_force[1] = -in.force[1] * around * z;
    of_force[3] = in.force[0] * around * around / (2 * Circle::pi);
  }
  /// The row of coefficients of a part that gives 2 pi r times rr, zz, rz and the stress around the axis.
  KOKKOS_FUNCTION void rows_at(const int e, const int s, const int q,
                               double (&B)[4][RevolutionTables::most_of_part]) const
  {
    const int nm = in.reference.monomials;
    const double r = circle(e, s, q) / (2 * Circle::pi), x = r * cell.F[0][0] / cell.determinant,
                 y = r * cell.F[0][1] / cell.determinant;
    for (int m = 0; m < nm; ++m) {
      const double value = in.revolution.value(e, s, q, m), d0 = in.revolution.slope(e, s, q, m, 0),
                   d1 = in.revolution.slope(e, s, q, m, 1);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) B[i][j * nm + m] = T[i][j] * value;
      B[3][m] = x * d0;
      B[3][nm + m] = y * d1;
      B[3][2 * nm + m] = x * d1 + y * d0;
    }
  }
  KOKKOS_FUNCTION void add_part(const ReadDisplacement &u, const int s)
  {
    constexpr int most_of_part = RevolutionTables::most_of_part;
    const int n = 3 * in.reference.monomials;
    double M[most_of_part][most_of_part] = {}, v[most_of_part] = {}, B[4][most_of_part], CB[4][most_of_part];
    const InverseRadius inverse(in, c, cell.centre[0], s);
    const int e = inverse.arrangement;
    for (int q = 0; q < in.revolution.points; ++q) {
      double of_u[4], of_force[4];
      fields_at(u, e, s, q, of_u, of_force);
      rows_at(e, s, q, B);
      const double w = in.revolution.weight(e, s, q) * cell.determinant * inverse.at(in, q, circle(e, s, q), true);
      for (int i = 0; i < 4; ++i)
        for (int m = 0; m < n; ++m) {
          CB[i][m] = 0;
          for (int j = 0; j < 4; ++j) CB[i][m] += w * C[i][j] * B[j][m];
        }
      for (int i = 0; i < 4; ++i)
        for (int m = 0; m < n; ++m) {
          v[m] += CB[i][m] * (of_force[i] - of_u[i]);
          for (int l = 0; l <= m; ++l) M[m][l] += B[i][m] * CB[i][l];
        }
    }
    for (int m = 0; m < n; ++m) {
      double row[most]; // of M R
      for (int j = 0; j < columns; ++j) {
        row[j] = 0;
        for (int l = 0; l < n; ++l) row[j] += M[l < m ? m : l][l < m ? l : m] * in.revolution.stress(s * n + l, j);
      }
      for (int i = 0; i < columns; ++i) {
        const double factor = in.revolution.stress(s * n + m, i);
        g[i] += factor * v[m];
        for (int j = 0; j < columns; ++j) A[i][j] += factor * row[j];
      }
    }
  }
  KOKKOS_FUNCTION void add_conditions()
  {
    const int sides = in.reference.sides, all = sides * in.revolution.divergences;
    for (int r = 0; r < all; ++r)
      for (int j = 0; j < columns; ++j)
        D[r][j] = cell.F[1][0] * in.revolution.divergence(r, 0, j) + cell.F[1][1] * in.revolution.divergence(r, 1, j);
    conditions = all;
    for (int s = 0; s < sides && in.reference.degree == 2; ++s) { // zz in the middle of an edge on the axis
      const LO a = in.cells(c, s), b = in.cells(c, (s + 1) % sides);
      if (in.coords(a, 0) > in.on_axis || in.coords(b, 0) > in.on_axis) continue;
      const double length = math::magnitude(in.coords(b, 1) - in.coords(a, 1));
      for (int j = 0; j < columns; ++j) {
        D[conditions][j] = 0;
        for (int i = 0; i < 3; ++i) D[conditions][j] += length * T[1][i] * in.revolution.at_middle(s, i, j);
      }
      ++conditions;
    }
  }

  /// Cholesky factors of the inner stresses' part of A, in place, and of the multipliers' matrix.
  KOKKOS_FUNCTION void factor()
  {
    const int first = columns - inner;
    for (int j = first; j < columns; ++j) {
      for (int k = first; k < j; ++k)
        for (int i = j; i < columns; ++i) A[i][j] -= A[i][k] * A[j][k];
      const double pivot = math::sqrt(A[j][j]);
      for (int i = j; i < columns; ++i) A[i][j] /= pivot;
    }
    for (int r = 0; r < conditions; ++r)
      for (int i = 0; i < inner; ++i) {
        double y = D[r][first + i];
        for (int k = 0; k < i; ++k) y -= A[first + i][first + k] * Y[k][r];
        Y[i][r] = y / A[first + i][first + i];
      }
    for (int r = 0; r < conditions; ++r)
      for (int l = 0; l <= r; ++l) {
        H[r][l] = 0;
        for (int i = 0; i < inner; ++i) H[r][l] += Y[i][r] * Y[i][l];
      }
    for (int j = 0; j < conditions; ++j) {
      const double own = H[j][j];
      for (int k = 0; k < j; ++k)
        for (int i = j; i < conditions; ++i) H[i][j] -= H[i][k] * H[j][k];
      if (!(H[j][j] > 1e-10 * own)) { // it follows from the others and the balance of the tractions
        for (int i = j; i < conditions; ++i) H[i][j] = 0;
        H[j][j] = math::infinity<double>;
        continue;
      }
      const double pivot = math::sqrt(H[j][j]);
      for (int i = j; i < conditions; ++i) H[i][j] /= pivot;
    }
  }
  /// The best inner stresses for reference tractions, after factor(). @param with_fields  else the quadratic part of the energy alone
  KOKKOS_FUNCTION void solve(const double *tractions, const bool with_fields, double *x, double *mu) const
  {
    const int first = columns - inner;
    for (int i = 0; i < inner; ++i) {
      double y = with_fields ? -g[first + i] : 0;
      for (int j = 0; j < first; ++j) y -= A[j][first + i] * tractions[j];
      for (int k = 0; k < i; ++k) y -= A[first + i][first + k] * x[k];
      x[i] = y / A[first + i][first + i];
    }
    for (int r = 0; r < conditions; ++r) {
      mu[r] = 0;
      for (int j = 0; j < first; ++j) mu[r] += D[r][j] * tractions[j];
      for (int i = 0; i < inner; ++i) mu[r] += Y[i][r] * x[i];
      for (int l = 0; l < r; ++l) mu[r] -= H[r][l] * mu[l];
      mu[r] /= H[r][r];
    }
    for (int r = conditions - 1; r >= 0; --r) {
      for (int l = r + 1; l < conditions; ++l) mu[r] -= H[l][r] * mu[l];
      mu[r] /= H[r][r];
    }
    for (int i = 0; i < inner; ++i)
      for (int r = 0; r < conditions; ++r) x[i] -= Y[i][r] * mu[r];
    for (int i = inner - 1; i >= 0; --i) {
      for (int k = i + 1; k < inner; ++k) x[i] -= A[first + k][first + i] * x[k];
      x[i] /= A[first + i][first + i];
    }
  }

  /// int |s - C eps(u)|^2, or without columns |C eps(u)|^2, nowhere below or nowhere above what it is.
  KOKKOS_FUNCTION double energy_of(const ReadDisplacement &u, const double *x, const bool above) const
  {
    constexpr int most_of_part = RevolutionTables::most_of_part;
    const int n = 3 * in.reference.monomials;
    double sum = 0;
    for (int s = 0; s < in.reference.sides; ++s) {
      double coefficient[most_of_part] = {};
      for (int m = 0; x != nullptr && m < n; ++m)
        for (int j = 0; j < columns; ++j) coefficient[m] += in.revolution.stress(s * n + m, j) * x[j];
      const InverseRadius inverse(in, c, cell.centre[0], s);
      const int e = inverse.arrangement;
      for (int q = 0; q < in.revolution.points; ++q) {
        double of_u[4], of_force[4], B[4][most_of_part], difference[4];
        fields_at(u, e, s, q, of_u, of_force);
        if (x != nullptr) rows_at(e, s, q, B);
        for (int i = 0; i < 4; ++i) {
          difference[i] = -of_u[i];
          if (x == nullptr) continue;
          difference[i] += of_force[i];
          for (int m = 0; m < n; ++m) difference[i] += B[i][m] * coefficient[m];
        }
        double density = 0;
        for (int i = 0; i < 4; ++i)
          for (int j = 0; j < 4; ++j) density += difference[i] * C[i][j] * difference[j];
        sum += in.revolution.weight(e, s, q) * cell.determinant * density * inverse.at(in, q, circle(e, s, q), above);
      }
    }
    return sum;
  }
};

} // namespace rpc::bound
