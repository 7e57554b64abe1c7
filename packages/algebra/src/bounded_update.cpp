// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/algebra/bounded_update.hpp"

#include "rpc/algebra/jacobi.hpp"

#include <cmath>

namespace rpc
{
namespace
{

template <int Dim>
struct BoundUpdate {
  static constexpr double rounding = 1e-12; // of eigenvalues that are 0, beside the largest one

  DeviceView<double ***> update, base; // (nodes, Dim, Dim)  in
  double most;                         //                    in
  DeviceView<double ***> bounded;      // (nodes, Dim, Dim)  out

  KOKKOS_FUNCTION void operator()(const LO n) const
  {
    double part[Dim][Dim];
    for (int k = 0; k < Dim; ++k)
      for (int l = 0; l < Dim; ++l) bounded(n, k, l) = part[k][l] = 0.5 * (update(n, k, l) + update(n, l, k));
    EigenPairs<Dim> pairs = eigen_pairs(part);
    double largest = 0;
    for (int k = 0; k < Dim; ++k)
      if (pairs.value[k] > largest) largest = pairs.value[k];
    bool changed = false;
    for (int k = 0; k < Dim; ++k) {
      const double(&e)[Dim] = pairs.vector[k];
      double own = 0;
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) own += e[i] * base(n, i, j) * e[j];
      const bool above = pairs.value[k] > most * own;
      changed = changed || above || pairs.value[k] < -rounding * largest;
      if (above) pairs.value[k] = most * own;
      if (pairs.value[k] < 0) pairs.value[k] = 0;
    }
    if (!changed) return; // exactly as it was
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        double sum = 0;
        for (int k = 0; k < Dim; ++k) sum += pairs.value[k] * (pairs.vector[k][i] * pairs.vector[k][j]);
        bounded(n, i, j) = sum;
      }
  }
};

DeviceView<double ***> symmetric_part(const DeviceView<double ***> &block)
{
  const int dim = static_cast<int>(block.extent(1));
  const DeviceView<double ***> part("rpc::algebra::symmetric_part", block.extent(0), dim, dim);
  Kokkos::parallel_for(
      "rpc::algebra::symmetric_part", device_range(static_cast<LO>(block.extent(0))), KOKKOS_LAMBDA(const LO n) {
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l) part(n, k, l) = 0.5 * (block(n, k, l) + block(n, l, k));
      });
  Kokkos::fence();
  return part;
}

} // namespace

DeviceView<double ***> bounded_update(const UpdatedOperator &H, const double most)
{
  if (std::isinf(most)) return symmetric_part(H.update());
  const int dim = H.dofs_per_node();
  const LO n = static_cast<LO>(H.nodes().extent(0));
  const DeviceView<double ***> bounded("rpc::algebra::bounded_update", n, dim, dim);
  const auto launch = [&](const auto &kernel) {
    Kokkos::parallel_for("rpc::algebra::bound_update", device_range(n), kernel);
  };
  if (dim == 1)
    launch(BoundUpdate<1>{H.update(), H.base_blocks(), most, bounded});
  else if (dim == 2)
    launch(BoundUpdate<2>{H.update(), H.base_blocks(), most, bounded});
  else
    launch(BoundUpdate<3>{H.update(), H.base_blocks(), most, bounded});
  Kokkos::fence();
  return bounded;
}

void write_update(CrsMatrix &A, const UpdatedOperator &H, const DeviceView<double ***> &update)
{
  const int dim = H.dofs_per_node();
  const auto nodes = H.nodes();
  const auto base = H.base_blocks();
  const auto matrix = A.getLocalMatrixDevice();
  Kokkos::parallel_for(
      "rpc::algebra::write_update", device_range(static_cast<LO>(nodes.extent(0))), KOKKOS_LAMBDA(const LO n) {
        const LO first = dof(dim, nodes(n), 0);
        for (int k = 0; k < dim; ++k) {
          std::size_t at = matrix.graph.row_map(first + k);
          while (matrix.graph.entries(at) != first) ++at; // an owned node's first column has its first row's lid
          for (int l = 0; l < dim; ++l) matrix.values(at + l) = base(n, k, l) + update(n, k, l);
        }
      });
  Kokkos::fence();
}

} // namespace rpc
