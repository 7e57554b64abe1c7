// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

/// Integrals and polynomials on the facets of cells: edges in the plane, triangles in space. On the host.
namespace rpc::bound
{

/// A point of a facet by what it has of each vertex; of edges the first two.
using Barycentric = std::array<double, 3>;

struct FacetRule {
  std::vector<Barycentric> point;
  std::vector<double> weight; ///< they sum to 1

  int size() const { return static_cast<int>(weight.size()); }
};
/// n Gauss points along an edge, exact for degree 2 n - 1; n^2 in a triangle, exact for degree 2 n - 2.
FacetRule facet_rule(int dim, int n);
/// The points of a rule in parts of a facet that are alike: `parts` along an edge, parts^2 in a triangle.
FacetRule refined(int dim, const FacetRule &rule, int parts);

/// Orthogonal polynomials on a facet, by ascending degree: Legendre's along an edge, whose squares have the means 1 / (2 j + 1); in a triangle
/// those that the powers of the second and the third barycentric coordinate lead to, whose squares have the mean 1.
class FacetPolynomials
{
public:
  FacetPolynomials(int dim, int degree);
  static int count(int dim, int degree); ///< how many have at most this degree
  int size() const { return size_; }
  double operator()(int j, const Barycentric &at) const;
  double square(int j) const { return dim_ == 2 ? 1. / (2 * j + 1) : 1; } ///< mean of the square

private:
  int dim_, size_;
  std::vector<std::array<int, 2>> power_;
  std::vector<std::vector<double>> by_power_; // of those in a triangle
};

} // namespace rpc::bound
