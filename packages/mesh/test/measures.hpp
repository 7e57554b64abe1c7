// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "rpc/mesh/mesh_data.hpp"
#include "rpc/mesh/quadrature.hpp"
#include "rpc/mesh/shape_functions.hpp"

#include <array>
#include <cstddef>
#include <vector>

/// Sizes of meshes in space, by quadrature that is exact on curved cells of order 2.
namespace rpc::test
{

constexpr int high_degree = 5; ///< of det J in each coordinate of a hexahedron of order 2; x . n has no more in all

inline double volume(const mesh::MeshData &mesh)
{
  double sum = 0;
  mesh::with_static_extents(mesh.element, [&](const auto dim, const auto nodes) {
    if constexpr (dim == 3) {
      const mesh::ShapeFunctions<3, nodes> functions;
      const auto rule = mesh::quadrature(3, mesh.element.shape, high_degree);
      for (int c = 0; c < mesh.num_cells(); ++c)
        for (int q = 0; q < rule.num_points(); ++q) {
          const double X[3] = {rule.point[q][0], rule.point[q][1], rule.point[q][2]};
          double N[nodes], dN[nodes][3], J[3][3] = {};
          functions.evaluate(X, N, dN);
          for (int a = 0; a < nodes; ++a)
            for (int i = 0; i < 3; ++i)
              for (int j = 0; j < 3; ++j)
                J[i][j] += mesh.coords[3 * std::size_t(mesh.cells[std::size_t(nodes) * c + a]) + i] * dN[a][j];
          sum += rule.weight[q] * (J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) +
                                   J[0][1] * (J[1][2] * J[2][0] - J[1][0] * J[2][2]) +
                                   J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]));
        }
    }
  });
  return sum;
}

/// int n dA over a side, and int x . n dA / 3, which is the volume where all sides together close the body.
struct SideIntegrals {
  std::array<double, 3> normal{};
  double volume = 0;
};

inline SideIntegrals integrals(const mesh::MeshData &mesh, const mesh::SideData &side)
{
  SideIntegrals result;
  const mesh::Element facet = mesh.element.facet();
  mesh::with_static_extents(facet, [&](const auto dim, const auto nodes) {
    if constexpr (dim == 2) {
      const mesh::ShapeFunctions<2, nodes> functions;
      const auto rule = mesh::quadrature(2, facet.shape, high_degree);
      for (std::size_t f = 0; f < side.cell.size(); ++f)
        for (int q = 0; q < rule.num_points(); ++q) {
          const double X[2] = {rule.point[q][0], rule.point[q][1]};
          double N[nodes], dN[nodes][2], x[3] = {}, t[2][3] = {};
          functions.evaluate(X, N, dN);
          for (int a = 0; a < nodes; ++a) {
            const int local = mesh.element.facets()[side.ordinal[f]][a];
            const std::size_t node = mesh.cells[std::size_t(mesh.element.num_nodes()) * side.cell[f] + local];
            for (int i = 0; i < 3; ++i) {
              x[i] += mesh.coords[3 * node + i] * N[a];
              for (int j = 0; j < 2; ++j) t[j][i] += mesh.coords[3 * node + i] * dN[a][j];
            }
          }
          for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const double n = rule.weight[q] * (t[0][j] * t[1][k] - t[0][k] * t[1][j]);
            result.normal[i] += n;
            result.volume += x[i] * n / 3;
          }
        }
    }
  });
  return result;
}

/// What sides that close the body say of its volume: only facets with outward normals give it.
inline double volume_within_sides(const mesh::MeshData &mesh)
{
  double sum = 0;
  for (const auto &side : mesh.sides) sum += integrals(mesh, side).volume;
  return sum;
}

} // namespace rpc::test
