#include "rpc/mesh/size_field.hpp"

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

double cells_in_triangle(const SizeField &field, const int *const nodes)
{
  const auto x = [&](const int vertex, const int d) { return field.coords[2 * std::size_t(nodes[vertex]) + d]; };
  const double area =
      std::abs((x(1, 0) - x(0, 0)) * (x(2, 1) - x(0, 1)) - (x(2, 0) - x(0, 0)) * (x(1, 1) - x(0, 1))) / 2;
  if (!(area > 0)) return 0; // with sizes of 1e-300 the mean alone would be infinite
  return area * mean_inverse_square(field.size[nodes[0]], field.size[nodes[1]], field.size[nodes[2]]) * 4 /
         std::sqrt(3.);
}

double cells_in_tetrahedron(const SizeField &field, const int *const nodes)
{
  double arm[3][3];
  for (int a = 0; a < 3; ++a)
    for (int d = 0; d < 3; ++d)
      arm[a][d] = field.coords[3 * std::size_t(nodes[a + 1]) + d] - field.coords[3 * std::size_t(nodes[0]) + d];
  double six_volumes = 0;
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    six_volumes += arm[0][d] * (arm[1][e] * arm[2][f] - arm[1][f] * arm[2][e]);
  }
  if (!(std::abs(six_volumes) > 0)) return 0;
  return std::abs(six_volumes) / 6 * tetrahedra_per_cube *
         mean_inverse_cube({field.size[nodes[0]], field.size[nodes[1]], field.size[nodes[2]], field.size[nodes[3]]});
}

} // namespace

double expected_cells(const SizeField &field)
{
  double cells = 0;
  const std::size_t vertices = field.dim + 1;
  for (std::size_t s = 0; s + vertices <= field.simplices.size(); s += vertices)
    cells += (field.dim == 2 ? cells_in_triangle : cells_in_tetrahedron)(field, &field.simplices[s]);
  return cells;
}

} // namespace rpc::mesh
