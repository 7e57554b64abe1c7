// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/several_vectors.hpp"

#include "rpc/core/error.hpp"
#include "rpc/core/sums.hpp"

#include <algorithm>
#include <utility>

namespace rpc
{
namespace
{

constexpr int most_at_once = 8; // as many sums fit into the registers of a thread

// Rows for which a thread of a host keeps its sums in registers; threads of a GPU take one row each, so that they read side by side.
constexpr LO rows_at_once = on_gpu ? 1 : 1024;

template <int Count>
using Columns = Kokkos::Array<const double *, Count>;

/// x_j . y for Count vectors.
template <int Count>
struct SumProducts : NumberSums {
  Columns<Count> x;
  const double *y;
  LO num_rows;

  SumProducts(const Columns<Count> &columns, const double *const with, const LO rows)
      : NumberSums(Count), x(columns), y(with), num_rows(rows)
  {
  }
  KOKKOS_INLINE_FUNCTION void operator()(const LO part, double sum[]) const
  {
    const LO first = part * rows_at_once, last = first + rows_at_once < num_rows ? first + rows_at_once : num_rows;
    double mine[Count];
    for (int j = 0; j < Count; ++j) mine[j] = 0;
    for (LO row = first; row < last; ++row) {
      const double value = y[row];
      for (int j = 0; j < Count; ++j) mine[j] += x[j][row] * value;
    }
    for (int j = 0; j < Count; ++j) sum[j] += mine[j];
  }
};

/// y <- beta y + sum_j a_j x_j for Count vectors.
template <int Count>
struct AddProducts {
  Kokkos::Array<double, Count> a;
  Columns<Count> x;
  double beta; // 0: y is not read
  double *y;

  KOKKOS_INLINE_FUNCTION void operator()(const LO row) const
  {
    double sum = beta == 0 ? 0 : beta * y[row];
    for (int j = 0; j < Count; ++j) sum += a[j] * x[j][row];
    y[row] = sum;
  }
};

template <int Count>
Columns<Count> columns_from(const std::vector<RCP<const Vector>> &x, const std::size_t first)
{
  Columns<Count> columns;
  for (int j = 0; j < Count; ++j) columns[j] = device_read(*x[first + j]).data();
  return columns;
}

/// Hands `x` to `kernel` in groups, as large ones as there are: `kernel(first, of)` with `of` an integral constant.
template <int Count = most_at_once, class Kernel>
void in_groups(const std::size_t size, const Kernel &kernel, std::size_t first = 0)
{
  for (; first + Count <= size; first += Count) kernel(first, std::integral_constant<int, Count>());
  if constexpr (Count > 1) in_groups<Count / 2>(size, kernel, first);
}

} // namespace

std::vector<double> dots(const std::vector<RCP<const Vector>> &x, const Vector &y)
{
  if (x.empty()) return {};
  const DeviceView<double *> sums("rpc::dots", x.size());
  const LO num_rows = num_local(*y.getMap()), parts = (num_rows + rows_at_once - 1) / rows_at_once;
  const double *const with = device_read(y).data();
  in_groups(x.size(), [&](const std::size_t first, const auto of) {
    constexpr int count = decltype(of)::value;
    const auto result = Kokkos::subview(sums, std::make_pair(first, first + count));
    Kokkos::parallel_reduce("rpc::dots", device_range(parts),
                            SumProducts<count>(columns_from<count>(x, first), with, num_rows), result);
  });
  const auto mine = to_host(sums);
  std::vector<double> all(x.size());
  Teuchos::reduceAll(*y.getMap()->getComm(), Teuchos::REDUCE_SUM, static_cast<int>(x.size()), mine.data(), all.data());
  return all;
}

void add_combination(const std::vector<double> &a, const std::vector<RCP<const Vector>> &x, const double beta,
                     Vector &y)
{
  RPC_REQUIRE(a.size() == x.size(), "add_combination: " << a.size() << " factors for " << x.size() << " vectors");
  if (x.empty()) {
    beta == 0 ? y.putScalar(0) : y.scale(beta);
    return;
  }
  const auto range = device_range(num_local(*y.getMap()));
  double *const to = device_write(y).data();
  in_groups(x.size(), [&](const std::size_t first, const auto of) {
    constexpr int count = decltype(of)::value;
    Kokkos::Array<double, count> factors;
    for (int j = 0; j < count; ++j) factors[j] = a[first + j];
    Kokkos::parallel_for("rpc::add_combination", range,
                         AddProducts<count>{factors, columns_from<count>(x, first), first == 0 ? beta : 1, to});
  });
  Kokkos::fence();
}

} // namespace rpc
