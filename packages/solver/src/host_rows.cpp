#include "host_rows.hpp"

#include "rpc/core/device_values.hpp"

namespace rpc::solver
{

HostRows host_rows(const CrsMatrix &A, const std::vector<LO> &rows)
{
  const auto matrix = A.getLocalMatrixDevice();
  const auto row = device_values(rows, "rpc::solver::picked_rows");
  const LO n = static_cast<LO>(rows.size());
  const DeviceView<std::size_t *> first("rpc::solver::picked_first", n);
  const DeviceView<LO *> length("rpc::solver::picked_length", n);
  Kokkos::parallel_for(
      "rpc::solver::picked_lengths", device_range(n), KOKKOS_LAMBDA(const LO i) {
        first(i) = matrix.graph.row_map(row(i));
        length(i) = static_cast<LO>(matrix.graph.row_map(row(i) + 1) - first(i));
      });
  Kokkos::fence();
  HostRows picked;
  const auto lengths = to_host(length);
  for (LO i = 0; i < n; ++i) picked.begin.push_back(picked.begin.back() + lengths(i));
  const auto begin = device_values(picked.begin, "rpc::solver::picked_begin");
  const DeviceView<LO *> column("rpc::solver::picked_column", picked.begin.back());
  const DeviceView<double *> value("rpc::solver::picked_value", picked.begin.back());
  Kokkos::parallel_for(
      "rpc::solver::pick_rows", device_range(n), KOKKOS_LAMBDA(const LO i) {
        for (LO e = 0; e < length(i); ++e) {
          column(begin(i) + e) = matrix.graph.entries(first(i) + e);
          value(begin(i) + e) = matrix.values(first(i) + e);
        }
      });
  Kokkos::fence();
  picked.first = to_host(first);
  picked.column = to_host(column);
  picked.value = to_host(value);
  return picked;
}

} // namespace rpc::solver
