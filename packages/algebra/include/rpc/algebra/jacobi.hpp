// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/kokkos.hpp"
#include "rpc/core/math.hpp"

namespace rpc
{

/// Eigenvalues and eigenvectors of a small symmetric matrix, for kernels: A = sum_k value[k] vector[k] vector[k]^T. The vectors are
/// orthonormal; of a diagonal matrix they are the axes, and the values its diagonal.
template <int Dim>
struct EigenPairs {
  double value[Dim];
  double vector[Dim][Dim]; ///< [k] belongs to value[k]
};

/// By Jacobi's rotations: eigenvalues of very different size keep the digits that the matrix gives them.
template <int Dim>
KOKKOS_INLINE_FUNCTION EigenPairs<Dim> eigen_pairs(const double (&matrix)[Dim][Dim])
{
  constexpr int most_sweeps = 20; // five or six will do
  constexpr double negligible = 1e-17;
  double a[Dim][Dim];
  EigenPairs<Dim> pairs;
  for (int k = 0; k < Dim; ++k)
    for (int l = 0; l < Dim; ++l) {
      a[k][l] = matrix[k][l];
      pairs.vector[k][l] = k == l;
    }
  const auto size = [](const double x) { return x < 0 ? -x : x; };
  bool done = false;
  for (int sweep = 0; sweep < most_sweeps && !done; ++sweep) {
    done = true;
    for (int p = 0; p < Dim; ++p)
      for (int q = p + 1; q < Dim; ++q) {
        if (size(a[p][q]) <= negligible * (size(a[p][p]) + size(a[q][q]))) continue;
        done = false;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double tangent = (theta < 0 ? -1 : 1) / (size(theta) + math::sqrt(theta * theta + 1));
        const double c = 1 / math::sqrt(tangent * tangent + 1), s = tangent * c;
        for (int k = 0; k < Dim; ++k) { // columns, then rows
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y;
          a[k][q] = s * x + c * y;
        }
        for (int k = 0; k < Dim; ++k) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y;
          a[q][k] = s * x + c * y;
        }
        a[p][q] = a[q][p] = 0;
        for (int k = 0; k < Dim; ++k) {
          const double x = pairs.vector[p][k], y = pairs.vector[q][k];
          pairs.vector[p][k] = c * x - s * y;
          pairs.vector[q][k] = s * x + c * y;
        }
      }
  }
  for (int k = 0; k < Dim; ++k) pairs.value[k] = a[k][k];
  return pairs;
}

} // namespace rpc
