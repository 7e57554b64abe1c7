// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"

#include <cstddef>

/// Products of small dense matrices with vectors. On the host with the widest numbers at a time that the processor has.
namespace rpc::bound
{

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

  /// y <- sign (A sign t + b) for a symmetric matrix, and t and y in four pieces with a sign each.
  /// @param b  null: 0   @return the sum of sign t . (A sign t + b)
  template <int Size>
  static KOKKOS_FORCEINLINE_FUNCTION double of_cell(const float *const A, const double *const *const t,
                                                    const float *const sign, const double *const b, float *const y)
  {
    float x[Size], sum[Size];
    for (int s = 0; s < 4; ++s)
      for (int q = 0; q < Size / 4; ++q) x[s * Size / 4 + q] = sign[s] * static_cast<float>(t[s][q]);
    for (int i = 0; i < Size; ++i) sum[i] = b ? static_cast<float>(b[i]) : 0;
    const float *column = A;
    for (int j = 0; j < Size; j += 4, column += 4 * Size) // four columns at once
      for (int i = 0; i < Size; ++i)
        sum[i] += (column[i] * x[j] + column[Size + i] * x[j + 1]) +
                  (column[2 * Size + i] * x[j + 2] + column[3 * Size + i] * x[j + 3]);
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
};

/// PlainProducts on the host, for the processor at hand. Sizes are those of tetrahedra of order 1 (36) and 2 (72).
struct HostProducts {
  static double of_ring(const float *A, const float *x, int n, float *y);
  template <int Size>
  static double of_cell(const float *A, const double *const *t, const float *sign, const double *b, float *y);
  template <int Size>
  static double square(const double *A, const double *x);
};

/// What kernels call.
using FloatProducts = std::conditional_t<on_gpu, PlainProducts, HostProducts>;

} // namespace rpc::bound
