// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/core/math.hpp"

/// Least squares fits of polynomials to scattered values, in a kernel.
namespace rpc::fem
{

/// Monomials of a complete polynomial, by ascending degree.
template <int Dim, int Degree>
struct Monomials {
  /// How many there are up to a degree.
  static KOKKOS_INLINE_FUNCTION constexpr int up_to(const int degree)
  {
    return Dim == 2 ? (degree + 1) * (degree + 2) / 2 : (degree + 1) * (degree + 2) * (degree + 3) / 6;
  }
  static constexpr int size =
      Dim == 2 ? (Degree + 1) * (Degree + 2) / 2 : (Degree + 1) * (Degree + 2) * (Degree + 3) / 6;

  static KOKKOS_INLINE_FUNCTION void evaluate(const double (&x)[Dim], double (&term)[size])
  {
    double power[3][Degree + 1];
    powers(x, power);
    products(power, term);
  }
  static KOKKOS_INLINE_FUNCTION void evaluate(const double (&x)[Dim], double (&term)[size],
                                              double (&gradient)[size][Dim])
  {
    double power[3][Degree + 1];
    powers(x, power);
    products(power, term);
    for (int degree = 0, t = 0; degree <= Degree; ++degree) {
      for (int j = 0; j <= degree; ++j) {
        for (int k = 0; k <= (Dim == 3 ? degree - j : 0); ++k, ++t) {
          const int exponent[3] = {degree - j - k, j, k};
          for (int d = 0; d < Dim; ++d) {
            gradient[t][d] = exponent[d];
            for (int e = 0; e < Dim && exponent[d] > 0; ++e) gradient[t][d] *= power[e][exponent[e] - (e == d ? 1 : 0)];
          }
        }
      }
    }
  }

private:
  static KOKKOS_INLINE_FUNCTION void products(const double (&power)[3][Degree + 1], double (&term)[size])
  {
    for (int degree = 0, t = 0; degree <= Degree; ++degree)
      for (int j = 0; j <= degree; ++j)
        for (int k = 0; k <= (Dim == 3 ? degree - j : 0); ++k, ++t)
          term[t] = power[0][degree - j - k] * power[1][j] * power[2][k];
  }
  /// x_i^k; in 2D the third are 1, 0, ..., 0.
  static KOKKOS_INLINE_FUNCTION void powers(const double (&x)[Dim], double (&power)[3][Degree + 1])
  {
    for (int i = 0; i < 3; ++i) {
      power[i][0] = 1;
      for (int k = 1; k <= Degree; ++k) power[i][k] = i < Dim ? power[i][k - 1] * x[i] : 0;
    }
  }
};

/// A = L L^T for symmetric positive semidefinite A, of which only the lower part is read; L takes its place.
///
/// Goes on for as long as a row's pivot keeps more than `threshold` of the row's diagonal entry: for normal equations
/// that is the part of a term's square which the terms before it cannot express, whatever the scale of the term.
/// @param least  a pivot at most so large is rounding: of a term that is 0 at all places threshold alone would keep it
/// @return how many leading rows of L are done
template <int Size>
KOKKOS_INLINE_FUNCTION int cholesky(double (&A)[Size][Size], const double threshold, const double least = 0)
{
  for (int i = 0; i < Size; ++i) {
    double pivot = A[i][i];
    for (int j = 0; j < i; ++j) {
      for (int k = 0; k < j; ++k) A[i][j] -= A[i][k] * A[j][k];
      A[i][j] /= A[j][j];
      pivot -= A[i][j] * A[i][j];
    }
    if (!(pivot > threshold * A[i][i] && pivot > least)) return i;
    A[i][i] = math::sqrt(pivot);
  }
  return Size;
}

/// b <- L^-1 b, or L^-T b, by the leading n rows of L.
template <int Size, int Columns>
KOKKOS_INLINE_FUNCTION void solve_lower(const double (&L)[Size][Size], const int n, double (&b)[Size][Columns])
{
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < Columns; ++c) {
      for (int k = 0; k < i; ++k) b[i][c] -= L[i][k] * b[k][c];
      b[i][c] /= L[i][i];
    }
  }
}
template <int Size, int Columns>
KOKKOS_INLINE_FUNCTION void solve_lower_transposed(const double (&L)[Size][Size], const int n,
                                                   double (&b)[Size][Columns])
{
  for (int i = n - 1; i >= 0; --i) {
    for (int c = 0; c < Columns; ++c) {
      for (int k = i + 1; k < n; ++k) b[i][c] -= L[k][i] * b[k][c];
      b[i][c] /= L[i][i];
    }
  }
}

} // namespace rpc::fem
