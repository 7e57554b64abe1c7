// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

/// Gauss points and Legendre polynomials on [0, 1], on the host.
namespace rpc::bound
{

struct Gauss {
  std::vector<double> point, weight; ///< weights sum to 1
};
/// Exact for polynomials up to degree 2 n - 1.
Gauss gauss(int n);

/// P_j(2 x - 1): orthogonal on [0, 1], the integral of its square is 1 / (2 j + 1).
double legendre(int j, double x);

} // namespace rpc::bound
