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
  picked.column = to_host(column);
  picked.value = to_host(value);
  return picked;
}

HostBlocks host_blocks(const RepeatedRows &rows, const std::vector<LO> &nodes)
{
  const auto blocks = rows.blocks();
  const int dim = rows.dim();
  const auto node = device_values(nodes, "rpc::solver::picked_nodes");
  const LO n = static_cast<LO>(nodes.size());
  const DeviceView<LO *> size("rpc::solver::picked_size", n);
  Kokkos::parallel_for(
      "rpc::solver::picked_sizes", device_range(n), KOKKOS_LAMBDA(const LO i) { size(i) = blocks.size(node(i)); });
  Kokkos::fence();
  HostBlocks picked;
  const auto sizes = to_host(size);
  for (LO i = 0; i < n; ++i) picked.begin.push_back(picked.begin.back() + sizes(i));
  const auto begin = device_values(picked.begin, "rpc::solver::picked_begin");
  const DeviceView<LO *> column("rpc::solver::picked_column", picked.begin.back());
  const DeviceView<double *> value("rpc::solver::picked_value", dim * dim * picked.begin.back());
  Kokkos::parallel_for(
      "rpc::solver::pick_blocks", device_range(n), KOKKOS_LAMBDA(const LO i) {
        for (LO b = 0; b < size(i); ++b) {
          const std::size_t to = begin(i) + b;
          column(to) = blocks.column(node(i), b);
          for (int k = 0; k < dim; ++k)
            for (int l = 0; l < dim; ++l) value(dim * (dim * to + k) + l) = blocks.entry(node(i), b, k, l);
        }
      });
  Kokkos::fence();
  picked.column = to_host(column);
  picked.value = to_host(value);
  return picked;
}

} // namespace rpc::solver
