// SPDX-License-Identifier: BSD-3-Clause
#include "dense.hpp"

#include "rpc/core/error.hpp"

#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <cmath>

namespace rpc::bound
{

Dense product(const Dense &x, const Dense &y)
{
  Dense z(x.rows, y.cols);
  for (int i = 0; i < x.rows; ++i)
    for (int k = 0; k < x.cols; ++k)
      for (int j = 0; x(i, k) != 0 && j < y.cols; ++j) z(i, j) += x(i, k) * y(k, j);
  return z;
}

Dense transposed(const Dense &x)
{
  Dense z(x.cols, x.rows);
  for (int i = 0; i < x.rows; ++i)
    for (int j = 0; j < x.cols; ++j) z(j, i) = x(i, j);
  return z;
}

Dense stacked(const Dense &x, const Dense &y)
{
  Dense z(x.rows + y.rows, x.cols);
  std::copy(x.a.begin(), x.a.end(), z.a.begin());
  std::copy(y.a.begin(), y.a.end(), z.a.begin() + static_cast<std::ptrdiff_t>(x.a.size()));
  return z;
}

Kernel kernel_of(const Dense &x)
{
  const int m = x.rows, n = x.cols;
  const Dense by_columns = transposed(x); // as LAPACK wants it
  std::vector<double> a = by_columns.a, s(std::min(m, n)), u(static_cast<std::size_t>(m) * m),
                      vt(static_cast<std::size_t>(n) * n);
  std::vector<double> work(10 * (m + n) + 5 * std::max(m, n)), rwork(1);
  int info = 0;
  Teuchos::LAPACK<int, double>().GESVD('A', 'A', m, n, a.data(), m, s.data(), u.data(), m, vt.data(), n, work.data(),
                                       static_cast<int>(work.size()), rwork.data(), &info);
  RPC_REQUIRE_CODE(info == 0, ExitCode::internal_error, "bound: singular values do not converge, info " << info);
  int rank = 0;
  while (rank < static_cast<int>(s.size()) && s[rank] > 1e-10 * s[0]) ++rank;
  Kernel k{Dense(n, n - rank), Dense(n, m)};
  for (int i = 0; i < n; ++i)
    for (int j = rank; j < n; ++j) k.basis(i, j - rank) = vt[static_cast<std::size_t>(i) * n + j];
  for (int r = 0; r < rank; ++r)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < m; ++j)
        k.inverse(i, j) += vt[static_cast<std::size_t>(i) * n + r] * u[static_cast<std::size_t>(r) * m + j] / s[r];
  return k;
}

Dense solved_spd(Dense x, Dense y)
{
  const int n = x.rows;
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < j; ++k)
      for (int i = j; i < n; ++i) x(i, j) -= x(i, k) * x(j, k);
    const double pivot = std::sqrt(x(j, j));
    for (int i = j; i < n; ++i) x(i, j) /= pivot;
  }
  for (int c = 0; c < y.cols; ++c) {
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < i; ++k) y(i, c) -= x(i, k) * y(k, c);
      y(i, c) /= x(i, i);
    }
    for (int i = n - 1; i >= 0; --i) {
      for (int k = i + 1; k < n; ++k) y(i, c) -= x(k, i) * y(k, c);
      y(i, c) /= x(i, i);
    }
  }
  return y;
}

} // namespace rpc::bound
