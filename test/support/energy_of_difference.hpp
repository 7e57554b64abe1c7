// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/core/field.hpp"
#include "rpc/fem/elasticity.hpp"

#include <cmath>
#include <functional>

namespace rpc::test
{

/// int (s(u) - s(u_h)) : eps(u - u_h) over this rank's cells, by the element's rule for loads, with gradient[i][j] = du_i / dx_j
/// of u at a point. Zero on entry.
inline double energy_of_difference(const fem::Discretization &d, const fem::Material &material, const Vector &u_h,
                                   const std::function<void(const Point &, double (&)[3][3])> &gradient)
{
  const mesh::Mesh &mesh = *d.mesh;
  const int dim = d.dim();
  const auto u = to_host(device_read(*on_overlap(d, u_h)));
  const auto coords = to_host(mesh.coords);
  const auto cells = to_host(mesh.cells);
  const auto value = to_host(d.reference.cell_load.value);
  const auto slope_of = to_host(d.reference.cell_load.gradient);
  const auto weight = to_host(d.reference.cell_load.weight);
  double sum = 0;
  for (LO cell = 0; cell < mesh.num_owned_cells; ++cell)
    for (std::size_t q = 0; q < weight.extent(0); ++q) {
      // grad_x u = grad_X u (grad_X x)^-1, by Cramer's rule
      double J[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, U[3][3] = {}, e[3][3] = {};
      Point x{};
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) J[i][j] = 0;
      for (std::size_t a = 0; a < cells.extent(1); ++a)
        for (int i = 0; i < dim; ++i) {
          x[i] += value(q, a) * coords(cells(cell, a), i);
          for (int j = 0; j < dim; ++j) {
            J[i][j] += coords(cells(cell, a), i) * slope_of(q, a, j);
            U[i][j] += u(dim * cells(cell, a) + i) * slope_of(q, a, j);
          }
        }
      double cofactor[3][3], det = 0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          cofactor[i][j] = J[(i + 1) % 3][(j + 1) % 3] * J[(i + 2) % 3][(j + 2) % 3] -
                           J[(i + 1) % 3][(j + 2) % 3] * J[(i + 2) % 3][(j + 1) % 3];
      for (int i = 0; i < 3; ++i) det += J[0][i] * cofactor[0][i];
      gradient(x, e);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          for (int k = 0; k < dim; ++k) e[i][j] -= U[i][k] * cofactor[j][k] / det;
      double trace = 0, density = 0;
      for (int i = 0; i < 3; ++i) {
        trace += e[i][i];
        for (int j = 0; j < 3; ++j) density += material.mu() / 2 * std::pow(e[i][j] + e[j][i], 2);
      }
      sum += weight(q) * det * (density + material.lambda() * trace * trace);
    }
  return sum;
}

} // namespace rpc::test
