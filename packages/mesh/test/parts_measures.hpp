// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/tpetra.hpp"
#include "rpc/mesh/canonical_order.hpp"
#include "rpc/mesh/mesh.hpp"
#include "rpc/mesh/quadrature.hpp"
#include "rpc/mesh/shape_functions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

/// Sizes of meshes that are dealt out to ranks.
namespace rpc::test
{

/// (nodes, dim) Coordinates of a facet's or a cell's nodes.
inline std::vector<std::vector<double>> places(const mesh::Mesh &mesh, const LO cell, const std::vector<int> &local)
{
  const auto coords = to_host(mesh.coords);
  const auto cells = to_host(mesh.cells);
  std::vector<std::vector<double>> x;
  for (const int a : local) {
    x.emplace_back();
    for (int d = 0; d < mesh.dim(); ++d) x.back().push_back(coords(cells(cell, a), d));
  }
  return x;
}

/// Area or volume of a cell, or length or area of a facet: the integral of sqrt(det J^T J).
inline double measure(const mesh::Element &element, const std::vector<std::vector<double>> &x, const int degree)
{
  const int space = static_cast<int>(x[0].size());
  double sum = 0;
  mesh::with_shape_functions(element, [&](const auto &shape) {
    constexpr int dim = std::decay_t<decltype(shape)>::dim, nodes = std::decay_t<decltype(shape)>::nodes;
    const auto rule = mesh::quadrature(dim, element.shape, degree);
    for (int q = 0; q < rule.num_points(); ++q) {
      double X[dim], N[nodes], dN[nodes][dim], G[3][3] = {}, J[3][3] = {};
      std::copy_n(rule.point[q].begin(), dim, X);
      shape.evaluate(X, N, dN);
      for (int a = 0; a < nodes; ++a)
        for (int i = 0; i < space; ++i)
          for (int j = 0; j < dim; ++j) J[i][j] += x[a][i] * dN[a][j];
      for (int j = 0; j < dim; ++j)
        for (int k = 0; k < dim; ++k)
          for (int i = 0; i < space; ++i) G[j][k] += J[i][j] * J[i][k];
      const double squared = dim == 1   ? G[0][0]
                             : dim == 2 ? G[0][0] * G[1][1] - G[0][1] * G[0][1]
                                        : G[0][0] * (G[1][1] * G[2][2] - G[1][2] * G[2][1]) -
                                              G[0][1] * (G[1][0] * G[2][2] - G[1][2] * G[2][0]) +
                                              G[0][2] * (G[1][0] * G[2][1] - G[1][1] * G[2][0]);
      sum += rule.weight[q] * std::sqrt(squared);
    }
  });
  return sum;
}

/// Of the whole body; collective.
inline double body_measure(const mesh::Mesh &mesh, const int degree = 5)
{
  std::vector<int> all(mesh.element.num_nodes());
  for (std::size_t a = 0; a < all.size(); ++a) all[a] = static_cast<int>(a);
  double sum = 0;
  for (LO c = 0; c < mesh.num_owned_cells; ++c) sum += measure(mesh.element, places(mesh, c, all), degree);
  return sum_all(mesh.comm(), sum);
}

/// Of a whole side; collective.
inline double side_measure(const mesh::Mesh &mesh, const std::string &name, const int degree = 5)
{
  const mesh::Side &side = mesh.side(name, "test");
  const auto cell = to_host(side.cell);
  const auto ordinal = to_host(side.ordinal);
  double sum = 0;
  for (std::size_t f = 0; f < cell.extent(0); ++f)
    if (cell(f) < mesh.num_owned_cells)
      sum += measure(mesh.element.facet(), places(mesh, cell(f), mesh.element.facets()[ordinal(f)]), degree);
  return sum_all(mesh.comm(), sum);
}

} // namespace rpc::test
