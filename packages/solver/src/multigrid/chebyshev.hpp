// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rpc::solver
{

/// The steps of a Chebyshev polynomial in A that damps the eigenvalues between two bounds:
///
///     d <- keep d + add (b - A x),    x <- x + d                                                  doc/theory.md (4.7c)
///
/// @param degree  number of steps   @param step  step(k, keep, add) does the k-th one
template <class Step>
void chebyshev(const double largest, const double smallest, const int degree, const Step &step)
{
  const double centre = 0.5 * (largest + smallest), radius = 0.5 * (largest - smallest), sigma = centre / radius;
  double rho = 1 / sigma;
  for (int k = 0; k < degree; ++k) {
    if (k == 0) {
      step(k, 0., 1 / centre);
      continue;
    }
    const double next = 1 / (2 * sigma - rho);
    step(k, next * rho, 2 * next / radius);
    rho = next;
  }
}

} // namespace rpc::solver
