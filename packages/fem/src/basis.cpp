// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/fem/basis.hpp"

#include "rpc/mesh/shape_functions.hpp"

#include <type_traits>

namespace rpc::fem
{

BasisTable tabulate(const mesh::Element &element, const mesh::QuadratureRule &rule)
{
  const int points = rule.num_points(), num_nodes = element.num_nodes();
  BasisTable table;
  table.value = DeviceView<double **>("rpc::fem::basis_value", points, num_nodes);
  table.gradient = DeviceView<double ***>("rpc::fem::basis_gradient", points, num_nodes, element.dim);
  table.weight = DeviceView<double *>("rpc::fem::quadrature_weight", points);
  const auto value = Kokkos::create_mirror_view(table.value);
  const auto gradient = Kokkos::create_mirror_view(table.gradient);
  const auto weight = Kokkos::create_mirror_view(table.weight);
  mesh::with_shape_functions(element, [&](const auto &functions) {
    using Functions = std::decay_t<decltype(functions)>;
    constexpr int dim = Functions::dim, nodes = Functions::nodes;
    for (int q = 0; q < points; ++q) {
      double X[dim], N[nodes], dN[nodes][dim];
      for (int g = 0; g < dim; ++g) X[g] = rule.point[q][g];
      functions.evaluate(X, N, dN);
      weight(q) = rule.weight[q];
      for (int a = 0; a < nodes; ++a) {
        value(q, a) = N[a];
        for (int g = 0; g < dim; ++g) gradient(q, a, g) = dN[a][g];
      }
    }
  });
  Kokkos::deep_copy(table.value, value);
  Kokkos::deep_copy(table.gradient, gradient);
  Kokkos::deep_copy(table.weight, weight);
  return table;
}

} // namespace rpc::fem
