// SPDX-License-Identifier: BSD-3-Clause
#include "facet_polynomials.hpp"

#include "gauss.hpp"

#include <cmath>

namespace rpc::bound
{
namespace
{

double power_of(const double x, const int n)
{
  double y = 1;
  for (int k = 0; k < n; ++k) y *= x;
  return y;
}

} // namespace

FacetRule facet_rule(const int dim, const int n)
{
  const Gauss line = gauss(n);
  FacetRule rule;
  for (int i = 0; i < n; ++i) {
    const double r = line.point[i];
    if (dim == 2) {
      rule.point.push_back({1 - r, r, 0});
      rule.weight.push_back(line.weight[i]);
      continue;
    }
    for (int j = 0; j < n; ++j) { // the square with one side drawn together in the first vertex
      const double s = line.point[j];
      rule.point.push_back({1 - r, r * (1 - s), r * s});
      rule.weight.push_back(2 * r * line.weight[i] * line.weight[j]);
    }
  }
  return rule;
}

FacetRule refined(const int dim, const FacetRule &rule, const int parts)
{
  FacetRule fine;
  const double size = 1. / parts;
  const int rows = dim == 2 ? 1 : parts;
  for (int i = 0; i < parts; ++i)
    for (int j = 0; j < rows; ++j)
      for (int flipped = 0; flipped < (dim == 2 ? 1 : 2); ++flipped) {
        if (dim == 3 && i + j + flipped >= parts) continue;
        for (int q = 0; q < rule.size(); ++q) {
          const double s = rule.point[q][1], t = rule.point[q][2];
          const double a = flipped ? i + 1 - s : i + s, b = flipped ? j + 1 - t : j + t;
          fine.point.push_back({1 - size * (a + (dim == 3 ? b : 0)), size * a, dim == 3 ? size * b : 0});
          fine.weight.push_back(rule.weight[q] * size * (dim == 3 ? size : 1));
        }
      }
  return fine;
}

int FacetPolynomials::count(const int dim, const int degree)
{
  return dim == 2 ? degree + 1 : (degree + 1) * (degree + 2) / 2;
}

FacetPolynomials::FacetPolynomials(const int dim, const int degree) : dim_(dim), size_(count(dim, degree))
{
  if (dim == 2) return;
  for (int n = 0; n <= degree; ++n)
    for (int j = 0; j <= n; ++j) power_.push_back({n - j, j});
  const FacetRule rule = facet_rule(dim, degree + 1);
  for (int i = 0; i < size_; ++i) {
    std::vector<double> c(size_, 0.);
    c[i] = 1;
    by_power_.push_back(c);
    for (int pass = 0; pass < 2; ++pass) // the second one takes away what rounding leaves
      for (int j = 0; j < i; ++j) {
        double mean = 0;
        for (int q = 0; q < rule.size(); ++q)
          mean += rule.weight[q] * (*this)(i, rule.point[q]) * (*this)(j, rule.point[q]);
        for (int k = 0; k < size_; ++k) by_power_[i][k] -= mean * by_power_[j][k];
      }
    double mean = 0;
    for (int q = 0; q < rule.size(); ++q) mean += rule.weight[q] * std::pow((*this)(i, rule.point[q]), 2);
    for (double &x : by_power_[i]) x /= std::sqrt(mean);
  }
}

double FacetPolynomials::operator()(const int j, const Barycentric &at) const
{
  if (dim_ == 2) return legendre(j, at[1]);
  double sum = 0;
  for (int k = 0; k < size_; ++k)
    if (by_power_[j][k] != 0) sum += by_power_[j][k] * power_of(at[1], power_[k][0]) * power_of(at[2], power_[k][1]);
  return sum;
}

} // namespace rpc::bound
