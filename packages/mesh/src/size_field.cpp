#include "rpc/mesh/size_field.hpp"

#include <algorithm>
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

} // namespace

double expected_cells(const SizeField &field)
{
  double integral = 0;
  for (std::size_t t = 0; t + 2 < field.triangles.size(); t += 3) {
    const int *const nodes = &field.triangles[t];
    const auto x = [&](const int vertex, const int d) { return field.coords[2 * std::size_t(nodes[vertex]) + d]; };
    const double area =
        std::abs((x(1, 0) - x(0, 0)) * (x(2, 1) - x(0, 1)) - (x(2, 0) - x(0, 0)) * (x(1, 1) - x(0, 1))) / 2;
    if (area > 0) // with sizes of 1e-300 the mean alone would be infinite
      integral += area * mean_inverse_square(field.size[nodes[0]], field.size[nodes[1]], field.size[nodes[2]]);
  }
  return integral * 4 / std::sqrt(3.);
}

} // namespace rpc::mesh
