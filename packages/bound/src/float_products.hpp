// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/core/math.hpp"

#include <cstddef>

/// Small dense matrices: products with vectors, sums, inverses. On the host with the widest numbers at a time that the processor has.
namespace rpc::bound
{

/// Where row i of a lower triangle begins whose rows lie one after another; for i = n how many entries n rows have.
KOKKOS_INLINE_FUNCTION constexpr std::size_t row_of_triangle(const std::size_t i)
{
  return i * (i + 1) / 2;
}

/// Asks for memory that will be read soon: facets of a cell or a ring lie apart, and nothing else would ask for them in time. For the host.
KOKKOS_INLINE_FUNCTION void soon(const void *const memory)
{
#if defined(__GNUC__) && !defined(__CUDACC__)
  __builtin_prefetch(memory);
#else
  (void)memory;
#endif
}

/// The formulas, for a kernel of any processor. On the host they are compiled anew for each kind of processor, below.
struct PlainProducts {
  /// y <- A x for a matrix of n columns, each of them n numbers in one piece; n is a multiple of 3. @return x . y
  static KOKKOS_FORCEINLINE_FUNCTION double of_ring(const float *A, const float *const x, const int n, float *const y)
  {
    for (int i = 0; i < n; ++i) y[i] = 0;
    for (int j = 0; j < n; j += 3, A += 3 * static_cast<std::ptrdiff_t>(n)) {
      const float a = x[j], b = x[j + 1], c = x[j + 2];
      const float *const second = A + n, *const third = second + n;
      for (int i = 0; i < n; ++i) y[i] += A[i] * a + second[i] * b + third[i] * c;
    }
    double parts[3] = {};
    for (int i = 0; i < n; i += 3)
      for (int k = 0; k < 3; ++k) parts[k] += static_cast<double>(x[i + k]) * y[i + k];
    return parts[0] + parts[1] + parts[2];
  }

  /// y <- A x for a symmetric matrix of which there are the rows of the lower triangle. @return x . y
  static KOKKOS_FORCEINLINE_FUNCTION double of_lower(const float *A, const float *__restrict__ const x, const int n,
                                                     float *__restrict__ const y)
  {
    for (int i = 0; i < n; A += ++i) {
      const float at = x[i];
      float parts[8] = {}, sum = A[i] * at; // no addition waits for another one
      int j = 0;
      for (; j + 8 <= i; j += 8)
        for (int k = 0; k < 8; ++k) {
          parts[k] += A[j + k] * x[j + k];
          y[j + k] += A[j + k] * at;
        }
      for (; j < i; ++j) {
        sum += A[j] * x[j];
        y[j] += A[j] * at;
      }
      for (const float part : parts) sum += part;
      y[i] = sum;
    }
    double product = 0;
    for (int i = 0; i < n; ++i) product += static_cast<double>(x[i]) * y[i];
    return product;
  }

  /// y <- sign (A sign t + b) for a symmetric matrix, and t and y in four pieces with a sign each.
  /// @param lower  whether there are the rows of A's lower triangle alone
  /// @param b  null: 0   @return the sum of sign t . (A sign t + b)
  template <int Size>
  static KOKKOS_FORCEINLINE_FUNCTION double of_cell(const float *const A, const bool lower,
                                                    const double *const *const t, const float *const sign,
                                                    const double *const b, float *const y)
  {
    float x[Size], sum[Size];
    for (int s = 0; s < 4; ++s)
      for (int q = 0; q < Size / 4; ++q) x[s * Size / 4 + q] = sign[s] * static_cast<float>(t[s][q]);
    if (lower) {
      of_lower(A, x, Size, sum);
      for (int i = 0; i < Size; ++i) sum[i] += b ? static_cast<float>(b[i]) : 0;
    } else {
      for (int i = 0; i < Size; ++i) sum[i] = b ? static_cast<float>(b[i]) : 0;
      const float *column = A;
      for (int j = 0; j < Size; j += 4, column += 4 * Size) // four columns at once
        for (int i = 0; i < Size; ++i)
          sum[i] += (column[i] * x[j] + column[Size + i] * x[j + 1]) +
                    (column[2 * Size + i] * x[j + 2] + column[3 * Size + i] * x[j + 3]);
    }
    double parts[4] = {}, product = 0;
    for (int i = 0; i < Size; i += 4)
      for (int k = 0; k < 4; ++k) parts[k] += static_cast<double>(x[i + k]) * sum[i + k];
    for (const double part : parts) product += part;
    for (int s = 0; s < 4; ++s)
      for (int q = 0; q < Size / 4; ++q) y[s * Size / 4 + q] = sign[s] * sum[s * Size / 4 + q];
    return product;
  }

  /// x . A x for a symmetric matrix.
  template <int Size>
  static KOKKOS_FORCEINLINE_FUNCTION double square(const double *A, const double *const x)
  {
    double y[Size] = {}, sum = 0;
    for (int j = 0; j < Size; j += 2, A += 2 * Size)
      for (int i = 0; i < Size; ++i) y[i] += A[i] * x[j] + A[Size + i] * x[j + 1];
    double parts[4] = {}; // no addition waits for another one
    for (int i = 0; i < Size; i += 4)
      for (int k = 0; k < 4; ++k) parts[k] += x[i + k] * y[i + k];
    for (const double part : parts) sum += part;
    return sum;
  }

  /// The inverse of a symmetric matrix of n columns, each of them n numbers in one piece, in place: the lower triangle of H is read, the upper one is
  /// that of the inverse then, 0 in rows of unknowns that do not count.
  static KOKKOS_FORCEINLINE_FUNCTION void invert(const int n, double *const H)
  {
    for (int j = 0; j < n; ++j) { // Cholesky's factor L in the lower triangle
      double *__restrict__ const column = H + static_cast<std::ptrdiff_t>(j) * n;
      const double own = column[j];
      int k = 0;
      for (; k + 2 < j; k += 3) {
        const double *const a = H + static_cast<std::ptrdiff_t>(k) * n, *const b = a + n, *const c = b + n;
        const double by_a = a[j], by_b = b[j], by_c = c[j];
        for (int i = j; i < n; ++i) column[i] -= a[i] * by_a + b[i] * by_b + c[i] * by_c;
      }
      for (; k < j; ++k) {
        const double *const a = H + static_cast<std::ptrdiff_t>(k) * n;
        const double by = a[j];
        for (int i = j; i < n; ++i) column[i] -= a[i] * by;
      }
      if (!(column[j] > 1e-12 * own)) {
        for (int i = j; i < n; ++i) column[i] = 0;
        for (k = 0; k < j; ++k) H[static_cast<std::ptrdiff_t>(k) * n + j] = 0;
        continue;
      }
      const double over = 1 / math::sqrt(column[j]);
      for (int i = j; i < n; ++i) column[i] *= over;
    }
    for (int i = 0; i < n; ++i) { // row i of L^-1 in the upper part of column i
      double *__restrict__ const row = H + static_cast<std::ptrdiff_t>(i) * n;
      const double own = row[i] > 0 ? 1 / row[i] : 0;
      for (int j = 0; j < i; ++j) row[j] = 0;
      for (int k = 0; k < i; ++k) {
        const double *const other = H + static_cast<std::ptrdiff_t>(k) * n;
        const double by = -own * other[i];
        for (int j = 0; j <= k; ++j) row[j] += by * other[j];
      }
      row[i] = own;
    }
    for (int j = 0; j < n; ++j) { // the sum of the squares of these rows
      double *__restrict__ const column = H + static_cast<std::ptrdiff_t>(j) * n;
      const double own = column[j];
      for (int i = 0; i <= j; ++i) column[i] *= own;
      int k = j + 1;
      for (; k + 2 < n; k += 3) {
        const double *const a = H + static_cast<std::ptrdiff_t>(k) * n, *const b = a + n, *const c = b + n;
        const double by_a = a[j], by_b = b[j], by_c = c[j];
        for (int i = 0; i <= j; ++i) column[i] += a[i] * by_a + b[i] * by_b + c[i] * by_c;
      }
      for (; k < n; ++k) {
        const double *const a = H + static_cast<std::ptrdiff_t>(k) * n;
        const double by = a[j];
        for (int i = 0; i <= j; ++i) column[i] += a[i] * by;
      }
    }
  }

  /// sum <- the tables times their factors, `size` numbers each, `apart` numbers apart. There are 21, of pairs of components.
  static KOKKOS_FORCEINLINE_FUNCTION void sum_tables(const double *table, const std::size_t apart, const int size,
                                                     const double *const factor, double *__restrict__ const sum)
  {
    for (int k = 0; k < size; ++k) sum[k] = 0;
    for (int p = 0; p < 21; p += 3, table += 3 * apart) {
      const double *const second = table + apart, *const third = second + apart;
      for (int k = 0; k < size; ++k)
        sum[k] += factor[p] * table[k] + factor[p + 1] * second[k] + factor[p + 2] * third[k];
    }
  }

  /// Of rows nt to n of the lower triangle of a symmetric matrix, W = L^-1 A_zt and Cholesky's factor L of A_zz, in place.
  static KOKKOS_FORCEINLINE_FUNCTION void factor_inner(const int nt, const int n, double *const rows)
  {
    double *__restrict__ row = rows;
    for (int i = nt; i < n; row += ++i) {
      const double *other = rows;
      for (int k = nt; k < i; other += ++k) {
        double l = row[k];
        for (int m = nt; m < k; ++m) l -= row[m] * other[m];
        l /= other[k];
        row[k] = l;
        for (int t = 0; t < nt; ++t) row[t] -= l * other[t];
      }
      double pivot = row[i];
      for (int m = nt; m < i; ++m) pivot -= row[m] * row[m];
      row[i] = math::sqrt(pivot);
      const double over = 1 / row[i];
      for (int t = 0; t < nt; ++t) row[t] *= over;
    }
  }
  /// The rows of the lower triangle of A before them: A_tt - W^T W.
  static KOKKOS_FORCEINLINE_FUNCTION void eliminate_inner(const int nt, const int n, double *const A)
  {
    for (int z = nt; z < n; ++z) {
      const double *const w = A + row_of_triangle(z);
      double *__restrict__ row = A;
      for (int r = 0; r < nt; row += ++r)
        for (int t = 0; t <= r; ++t) row[t] -= w[r] * w[t];
    }
  }
};

/// PlainProducts on the host, for the processor at hand. Sizes are those of tetrahedra of order 1 (36) and 2 (72).
struct HostProducts {
  static double of_ring(const float *A, const float *x, int n, float *y);
  static double of_lower(const float *A, const float *x, int n, float *y);
  template <int Size>
  static double of_cell(const float *A, bool lower, const double *const *t, const float *sign, const double *b,
                        float *y);
  template <int Size>
  static double square(const double *A, const double *x);
  static void invert(int n, double *H);
  static void sum_tables(const double *table, std::size_t apart, int size, const double *factor, double *sum);
  static void factor_inner(int nt, int n, double *rows);
  static void eliminate_inner(int nt, int n, double *A);
};

/// What kernels call.
using FloatProducts = std::conditional_t<on_gpu, PlainProducts, HostProducts>;

} // namespace rpc::bound
