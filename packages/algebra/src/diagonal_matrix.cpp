// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/diagonal_matrix.hpp"

namespace rpc
{

RCP<CrsMatrix> diagonal_matrix(const Vector &diagonal)
{
  using LocalMatrix = CrsMatrix::local_matrix_device_type;
  const auto map = diagonal.getMap();
  const LO n = num_local(*map);
  const auto from = device_read(diagonal);
  const LocalMatrix::row_map_type::non_const_type begin("rpc::diagonal_matrix::begin", n + 1);
  const LocalMatrix::index_type::non_const_type column("rpc::diagonal_matrix::column", n);
  const LocalMatrix::values_type::non_const_type value("rpc::diagonal_matrix::value", n);
  Kokkos::parallel_for(
      "rpc::diagonal_matrix", device_range(n), KOKKOS_LAMBDA(const LO i) {
        begin(i + 1) = i + 1;
        column(i) = i;
        value(i) = from(i);
      });
  Kokkos::fence();
  return rcp(new CrsMatrix(LocalMatrix("rpc::diagonal_matrix", n, n, n, value, begin, column), map, map, map, map));
}

} // namespace rpc
