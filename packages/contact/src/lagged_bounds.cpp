// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/lagged_bounds.hpp"

#include "rpc/contact/rounding.hpp"
#include "rpc/contact/rules.hpp"
#include "rpc/core/math.hpp"
#include "rpc/core/parallel.hpp"

#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <utility>

namespace rpc::contact
{
namespace
{

DeviceView<double *> bound_difference(const DeviceView<double *> &a, const DeviceView<double *> &b)
{
  const DeviceView<double *> result("rpc::contact::bound_difference", a.extent(0));
  Kokkos::parallel_for(
      "rpc::contact::bound_difference", device_range(static_cast<LO>(a.extent(0))),
      KOKKOS_LAMBDA(const LO i) { result(i) = a(i) - b(i); });
  Kokkos::fence();
  return result;
}

/// This rank's part of sum_i w_i a_i b_i.
double bound_product(const DeviceView<double *> &weight, const DeviceView<double *> &a, const DeviceView<double *> &b)
{
  double sum = 0;
  Kokkos::parallel_reduce(
      "rpc::contact::bound_product", device_range(static_cast<LO>(a.extent(0))),
      KOKKOS_LAMBDA(const LO i, double &part) { part += weight(i) * a(i) * b(i); }, sum);
  return sum;
}

/// x with the least |x| among those that minimize |A x - b|. @param A  (m, m) by columns
std::vector<double> mixing_coefficients(std::vector<double> A, std::vector<double> b)
{
  const int m = static_cast<int>(b.size());
  if (m == 0) return b;
  std::vector<double> singular(m), work(10 * m + 10);
  int rank = 0, info = 0;
  Teuchos::LAPACK<int, double>().GELSS(m, m, 1, A.data(), m, b.data(), m, singular.data(), Rounding::rank, &rank,
                                       work.data(), static_cast<int>(work.size()), nullptr, &info);
  if (info != 0) std::fill(b.begin(), b.end(), 0.);
  return b;
}

} // namespace

DeviceView<double *> LaggedBounds::next(const Comm &comm, const DeviceView<double *> &used,
                                        const DeviceView<double *> &found, const DeviceView<double *> &weight)
{
  const auto residual = bound_difference(found, used);
  if (std::exchange(started_, true))
    changes_.push_back({bound_difference(residual, residual_), bound_difference(found, found_)});
  if (static_cast<int>(changes_.size()) > lag_rules.mixing_depth) changes_.erase(changes_.begin());
  residual_ = residual;
  found_ = DeviceView<double *>("rpc::contact::found_bounds", found.extent(0));
  Kokkos::deep_copy(found_, found);

  const int m = static_cast<int>(changes_.size());
  std::vector<double> sums; // the normal equations of |residual - sum_j x_j change_j| -> min
  for (int j = 0; j < m; ++j)
    for (int k = 0; k < m; ++k) sums.push_back(bound_product(weight, changes_[j].residual, changes_[k].residual));
  for (int j = 0; j < m; ++j) sums.push_back(bound_product(weight, changes_[j].residual, residual));
  sums = summed(comm, sums);
  const auto x = mixing_coefficients({sums.begin(), sums.begin() + m * m}, {sums.begin() + m * m, sums.end()});

  const DeviceView<double *> mixed("rpc::contact::mixed_bounds", found.extent(0));
  Kokkos::deep_copy(mixed, found);
  for (int j = 0; j < m; ++j) {
    const double share = x[j];
    const auto change = changes_[j].found;
    Kokkos::parallel_for(
        "rpc::contact::mix_bounds", device_range(static_cast<LO>(mixed.extent(0))),
        KOKKOS_LAMBDA(const LO i) { mixed(i) -= share * change(i); });
  }
  Kokkos::parallel_for(
      "rpc::contact::mixed_bounds", device_range(static_cast<LO>(mixed.extent(0))),
      KOKKOS_LAMBDA(const LO i) { mixed(i) = math::larger(mixed(i), 0); });
  Kokkos::fence();
  return mixed;
}

} // namespace rpc::contact
