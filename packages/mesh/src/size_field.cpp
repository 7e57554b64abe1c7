// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/size_field.hpp"

#include "rpc/core/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rpc::mesh
{
namespace
{

/// Mean of 1 / h^2 over a triangle where h is linear: -2 ln[a, b, c], a divided difference at the values h of its
/// vertices (Hermite-Genocchi).
double mean_inverse_square(double a, double b, double c)
{
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  const double mean = (a + b + c) / 3;
  if (c - a <= 1e-3 * c) return 1 / (mean * mean);
  const auto slope = [](const double low, const double high) {
    return high > low ? std::log1p((high - low) / low) / (high - low) : 1 / low;
  };
  return 2 * (slope(a, b) - slope(b, c)) / (c - a);
}

/// Mean of 1 / h^3 over a tetrahedron where h is linear: 3 ln[a, b, c, d], by the same rule.
double mean_inverse_cube(std::array<double, 4> h)
{
  std::sort(h.begin(), h.end());
  const double mean = (h[0] + h[1] + h[2] + h[3]) / 4;
  if (h[3] - h[0] <= 1e-2 * h[3]) return 1 / (mean * mean * mean);
  return 3. / 2 * (mean_inverse_square(h[0], h[1], h[2]) - mean_inverse_square(h[1], h[2], h[3])) / (h[3] - h[0]);
}

double area(const SimplexVertices<2> &x)
{
  return std::abs((x[1][0] - x[0][0]) * (x[2][1] - x[0][1]) - (x[2][0] - x[0][0]) * (x[1][1] - x[0][1])) / 2;
}

double volume(const SimplexVertices<3> &x)
{
  double six_volumes = 0;
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    six_volumes +=
        (x[1][d] - x[0][d]) * ((x[2][e] - x[0][e]) * (x[3][f] - x[0][f]) - (x[2][f] - x[0][f]) * (x[3][e] - x[0][e]));
  }
  return std::abs(six_volumes) / 6;
}

template <int dim>
SimplexVertices<dim> vertices_of(const SizeField &field, const int *const nodes)
{
  SimplexVertices<dim> x;
  for (int v = 0; v <= dim; ++v) std::copy_n(&field.coords[std::size_t(dim) * nodes[v]], dim, x[v].begin());
  return x;
}

double cells_in_triangle(const SizeField &field, const int *const nodes)
{
  const double whole = area(vertices_of<2>(field, nodes));
  if (!(whole > 0)) return 0; // with sizes of 1e-300 the mean alone would be infinite
  return whole * mean_inverse_square(field.size[nodes[0]], field.size[nodes[1]], field.size[nodes[2]]) * 4 /
         std::sqrt(3.);
}

double cells_in_tetrahedron(const SizeField &field, const int *const nodes)
{
  const double whole = volume(vertices_of<3>(field, nodes));
  if (!(whole > 0)) return 0;
  return whole * tetrahedra_per_cube *
         mean_inverse_cube({field.size[nodes[0]], field.size[nodes[1]], field.size[nodes[2]], field.size[nodes[3]]});
}

} // namespace

template <>
double cell_size<2>(const SimplexVertices<2> &vertex)
{
  return std::sqrt(area(vertex) * 4 / std::sqrt(3.));
}
template <>
double cell_size<3>(const SimplexVertices<3> &vertex)
{
  return std::cbrt(volume(vertex) * tetrahedra_per_cube);
}

double expected_cells(const SizeField &field)
{
  double cells = 0;
  const std::size_t vertices = field.dim + 1;
  for (std::size_t s = 0; s + vertices <= field.simplices.size(); s += vertices)
    cells += (field.dim == 2 ? cells_in_triangle : cells_in_tetrahedron)(field, &field.simplices[s]);
  return cells;
}

void check_sizes(const std::string &where, const SizeField &field)
{
  const std::size_t nodes = field.size.size();
  const std::size_t vertices = field.dim + 1;
  RPC_REQUIRE_CODE(field.coords.size() == field.dim * nodes && !field.simplices.empty() &&
                       field.simplices.size() % vertices == 0 &&
                       std::all_of(field.simplices.begin(), field.simplices.end(),
                                   [&](const int n) { return n >= 0 && std::size_t(n) < nodes; }),
                   ExitCode::bad_mesh,
                   where << "a size field must have one triangle or tetrahedron or more, of its nodes, got "
                         << field.simplices.size() / vertices << " of " << nodes << " nodes");
  const auto bad = std::find_if(field.size.begin(), field.size.end(),
                                [](const double size) { return !(size > 0 && std::isfinite(size)); });
  RPC_REQUIRE_CODE(bad == field.size.end(), ExitCode::bad_mesh,
                   where << "cell sizes must be > 0 and finite [m], got " << *bad);
  RPC_REQUIRE_CODE(
      std::all_of(field.coords.begin(), field.coords.end(), [](const double x) { return std::isfinite(x); }),
      ExitCode::bad_mesh, where << "the nodes of a size field must have finite coordinates");
}

} // namespace rpc::mesh
