// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

/// Small dense matrices on the host.
namespace rpc::bound
{

/// A dense matrix, row by row.
struct Dense {
  int rows = 0, cols = 0;
  std::vector<double> a;

  Dense(const int r, const int c) : rows(r), cols(c), a(static_cast<std::size_t>(r) * c, 0.) {}
  double &operator()(const int r, const int c) { return a[static_cast<std::size_t>(r) * cols + c]; }
  double operator()(const int r, const int c) const { return a[static_cast<std::size_t>(r) * cols + c]; }
};

Dense product(const Dense &x, const Dense &y);
Dense transposed(const Dense &x);
/// The rows of x, then those of y.
Dense stacked(const Dense &x, const Dense &y);

/// A basis of what x maps to 0, in columns, and the inverse of x on the rest.
struct Kernel {
  Dense basis, inverse;
};
Kernel kernel_of(const Dense &x);

/// Solves x z = y for a symmetric positive definite x.
Dense solved_spd(Dense x, Dense y);

} // namespace rpc::bound
