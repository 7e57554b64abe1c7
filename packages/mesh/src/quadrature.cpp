// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/mesh/quadrature.hpp"

#include "rpc/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::mesh
{
namespace
{

struct Rule1d {
  std::vector<double> point, weight; // on [-1, 1]
};

[[noreturn]] void refuse(const int dim, const int degree)
{
  throw Error(ExitCode::internal_error, "mesh::quadrature: no rule in " + std::to_string(dim) +
                                            "D is exact for degree " + std::to_string(degree));
}

/// Exact for degree 2 points - 1.
Rule1d gauss(const int points)
{
  switch (points) {
  case 1:
    return {{0}, {2}};
  case 2:
    return {{-1 / std::sqrt(3.), 1 / std::sqrt(3.)}, {1, 1}};
  case 3:
    return {{-std::sqrt(0.6), 0, std::sqrt(0.6)}, {5. / 9, 8. / 9, 5. / 9}};
  case 4: {
    const double a = std::sqrt(3. / 7 - 2. / 7 * std::sqrt(1.2)), b = std::sqrt(3. / 7 + 2. / 7 * std::sqrt(1.2));
    const double wa = (18 + std::sqrt(30.)) / 36, wb = (18 - std::sqrt(30.)) / 36;
    return {{-b, -a, a, b}, {wb, wa, wa, wb}};
  }
  default:
    refuse(1, 2 * points - 1);
  }
}

Rule1d lobatto(const int order)
{
  return order == 1 ? Rule1d{{-1, 1}, {1, 1}} : Rule1d{{-1, 0, 1}, {1. / 3, 4. / 3, 1. / 3}};
}

QuadratureRule tensor_product(const int dim, const Rule1d &rule)
{
  const int n = static_cast<int>(rule.weight.size());
  int points = 1;
  for (int d = 0; d < dim; ++d) points *= n;
  QuadratureRule product;
  for (int q = 0; q < points; ++q) {
    std::array<double, 3> point{};
    double weight = 1;
    for (int d = 0, rest = q; d < dim; ++d, rest /= n) {
      point[d] = rule.point[rest % n];
      weight *= rule.weight[rest % n];
    }
    product.point.push_back(point);
    product.weight.push_back(weight);
  }
  return product;
}

/// All points with these barycentric coordinates, in any order, with one weight.
/// @param which  for each barycentric coordinate the one of `values` that it takes; ascending
void add_orbit(QuadratureRule &rule, std::vector<int> which, const std::vector<double> &values, const double weight)
{
  do {
    std::array<double, 3> point{};
    for (std::size_t d = 1; d < which.size(); ++d) point[d - 1] = values[which[d]];
    rule.point.push_back(point);
    rule.weight.push_back(weight);
  } while (std::next_permutation(which.begin(), which.end()));
}

QuadratureRule triangle(const int degree)
{
  QuadratureRule rule;
  const auto orbit = [&](const double a, const double weight) { add_orbit(rule, {0, 1, 1}, {1 - 2 * a, a}, weight); };
  if (degree <= 1) {
    add_orbit(rule, {0, 0, 0}, {1. / 3}, 0.5);
  } else if (degree <= 2) {
    orbit(1. / 6, 1. / 6);
  } else if (degree <= 4) {
    const double root = std::sqrt(38 - 44 * std::sqrt(0.4)), mean = 8 - std::sqrt(10.);
    const double w = std::sqrt(213125 - 53320 * std::sqrt(10.));
    orbit((mean + root) / 18, (620 + w) / 7440);
    orbit((mean - root) / 18, (620 - w) / 7440);
  } else if (degree <= 6) { // the solution of the moment equations for these orbits
    orbit(0.0630890144915022283, 0.0254224531851034085);
    orbit(0.249286745170910421, 0.058393137863189683);
    const double a = 0.310352451033784405, b = 0.0531450498448169474;
    add_orbit(rule, {0, 1, 2}, {a, b, 1 - a - b}, 0.0414255378091867876);
  } else {
    refuse(2, degree);
  }
  return rule;
}

QuadratureRule tetrahedron(const int degree)
{
  QuadratureRule rule;
  const auto orbit = [&](const double a, const double weight) {
    add_orbit(rule, {0, 1, 1, 1}, {1 - 3 * a, a}, weight);
  };
  if (degree <= 1) {
    add_orbit(rule, {0, 0, 0, 0}, {0.25}, 1. / 6);
  } else if (degree <= 2) {
    orbit((5 - std::sqrt(5.)) / 20, 1. / 24);
  } else if (degree <=
             3) { // both orbits with the same weight; s1 + s2 solves s^3 - 3/40 s + 1/240 = 0, 1/4 - s are the points
    const double angle = (std::acos(-std::sqrt(10.) / 6) - 2 * std::acos(-1.)) / 3;
    const double sum = std::sqrt(0.1) * std::cos(angle), root = std::sqrt(0.05 - sum * sum);
    orbit(0.25 - (sum + root) / 2, 1. / 48);
    orbit(0.25 - (sum - root) / 2, 1. / 48);
  } else if (degree <= 5) { // the solution of the moment equations for these orbits
    orbit(0.31088591926330061, 0.0187813209530026418);
    orbit(0.0927352503108912264, 0.0122488405193936583);
    const double a = 0.0455037041256496495;
    add_orbit(rule, {0, 0, 1, 1}, {a, 0.5 - a}, 0.00709100346284691107);
  } else {
    refuse(3, degree);
  }
  return rule;
}

} // namespace

QuadratureRule quadrature(const int dim, const Shape shape, const int degree)
{
  if (shape == Shape::tensor) return tensor_product(dim, gauss(degree / 2 + 1));
  return dim == 2 ? triangle(degree) : tetrahedron(degree);
}

int stiffness_degree(const Element &element)
{
  return element.shape == Shape::simplex ? element.dim * (element.order - 1) : 2 * element.order;
}

QuadratureRule nodal_rule(const Element &element)
{
  RPC_REQUIRE_CODE(element.dim <= 2, ExitCode::internal_error, "mesh::nodal_rule: facets have at most 2 dimensions");
  const bool simplex = element.shape == Shape::simplex;
  const Rule1d line = lobatto(element.order);
  QuadratureRule rule;
  for (int a = 0; a < element.num_nodes(); ++a) {
    std::array<double, 3> point{};
    double weight = 1;
    for (int d = 0; d < element.dim; ++d) {
      const int step = element.lattice()[a][d];
      point[d] = simplex ? double(step) / element.order : line.point[step];
      weight *= line.weight[step];
    }
    const bool carries = element.order == 1 || a >= element.num_vertices();
    rule.point.push_back(point);
    rule.weight.push_back(simplex ? (carries ? 1. / 6 : 0.) : weight);
  }
  return rule;
}

} // namespace rpc::mesh
