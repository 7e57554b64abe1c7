// SPDX-License-Identifier: BSD-3-Clause
#include "space_contact.hpp"

#include "least_in_box.hpp"
#include "rpc/contact/law/foundation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::bound
{
namespace
{

/// Means over a triangle of the products of two of its barycentric coordinates.
constexpr double barycentric_mass(const int i, const int j)
{
  return i == j ? 1. / 6 : 1. / 12;
}

/// The quadratic function of the fit: x . H x/2 - f . x for the pressures x at the corners of facets.
class FitInSpace
{
public:
  FitInSpace(const SpaceContact &c, const std::vector<OfTriangle> &v) : c_(c)
  {
    double area = 0;
    for (const double a : c.area) area += a;
    size_ = std::sqrt(2 * area / static_cast<double>(c.area.size()));
    list_hats();
    const std::size_t n = c.facet.size() * 3;
    f_.assign(n, 0.);
    scale_.assign(n, 0.);
    start_.assign(n, 0.);
    low_bound_.assign(n, 0.);
    high_bound_.assign(n, c.limit);
    std::vector<double> wanted(c.force);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (!c.free[i]) wanted[i] = 0;
    add_weighted(wanted);
    add_transposed(wanted, f_);
    for (std::size_t e = 0; e < c.facet.size(); ++e)
      for (int i = 0; i < 3; ++i) {
        double own = 0;
        start_[e * 3 + i] = std::clamp(c.pressure[e][i], 0., c.limit);
        for (int j = 0; j < 3; ++j) {
          const double m = barycentric_mass(i, j);
          f_[e * 3 + i] += near_weight(e) * m * std::clamp(c.pressure[e][j], 0., c.limit) + c.area[e] * m * v[e][j];
          own += m * m;
        }
        scale_[e * 3 + i] =
            1 / std::sqrt(c.area[e] * c.area[e] * own / (c.modulus * size_) + near_weight(e) * barycentric_mass(i, i));
      }
  }

  /// y <- H x.
  void apply(const std::vector<double> &x, std::vector<double> &y) const
  {
    std::vector<double> force(c_.force.size(), 0.);
    for (std::size_t e = 0; e < c_.facet.size(); ++e)
      for (int a = 0; a < 3; ++a)
        for (int j = 0; j < 3; ++j)
          if (c_.free[c_.point[e][a]]) force[c_.point[e][a]] += c_.area[e] * barycentric_mass(a, j) * x[e * 3 + j];
    add_weighted(force);
    y.assign(x.size(), 0.);
    add_transposed(force, y);
    for (std::size_t e = 0; e < c_.facet.size(); ++e)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) y[e * 3 + i] += near_weight(e) * barycentric_mass(i, j) * x[e * 3 + j];
  }
  const std::vector<double> &right_side() const { return f_; }
  const std::vector<double> &scale() const { return scale_; } ///< that makes about 1 of the diagonal
  const std::vector<double> &start() const { return start_; }
  const std::vector<double> &low() const { return low_bound_; }
  const std::vector<double> &high() const { return high_bound_; }

private:
  double near_weight(const std::size_t e) const
  {
    constexpr double share = 0.1; // how much the pressure at the nodes counts beside their forces
    return share * c_.area[e] * c_.area[e] / (c_.modulus * size_);
  }
  /// Squares of intervals of hats on all levels, from about four nodes for each down to one for all.
  void list_hats()
  {
    std::array<double, 2> high{};
    int count = 0;
    for (int d = 0; d < 2; ++d) {
      low_[d] = std::numeric_limits<double>::infinity();
      high[d] = -low_[d];
    }
    for (std::size_t i = 0; i < c_.place.size(); ++i) {
      if (!c_.free[i]) continue;
      ++count;
      for (int d = 0; d < 2; ++d) {
        low_[d] = std::min(low_[d], c_.place[i][d]);
        high[d] = std::max(high[d], c_.place[i][d]);
      }
    }
    for (int d = 0; d < 2; ++d) span_[d] = high[d] - low_[d];
    if (!(span_[0] > 0 && span_[1] > 0)) return;
    for (int n = static_cast<int>(std::sqrt(count)) / 2; n >= 1; n /= 2) intervals_.push_back(n);
  }
  /// force <- S force, with S the sum over all levels of the products with hats, and the nodes themselves.
  void add_weighted(std::vector<double> &force) const
  {
    constexpr double of_all = 100; // of the force and moments of the whole side, squared
    std::vector<double> sum(force), hat;
    for (const int n : intervals_) {
      hat.assign(static_cast<std::size_t>(n + 1) * (n + 1), 0.);
      const auto at = [&](const std::size_t i, std::array<double, 4> &weight) { // of four hats from the first one on
        int k[2];
        double x[2];
        for (int d = 0; d < 2; ++d) {
          x[d] = n * (c_.place[i][d] - low_[d]) / span_[d];
          k[d] = std::clamp(static_cast<int>(x[d]), 0, n - 1);
          x[d] -= k[d];
        }
        weight = {(1 - x[0]) * (1 - x[1]), (1 - x[0]) * x[1], x[0] * (1 - x[1]), x[0] * x[1]};
        return static_cast<std::size_t>(k[0]) * (n + 1) + k[1];
      };
      const std::size_t step[4] = {0, 1, static_cast<std::size_t>(n) + 1, static_cast<std::size_t>(n) + 2};
      std::array<double, 4> weight{};
      for (std::size_t i = 0; i < force.size(); ++i) {
        if (!c_.free[i]) continue;
        const std::size_t first = at(i, weight);
        for (int k = 0; k < 4; ++k) hat[first + step[k]] += weight[k] * force[i];
      }
      for (std::size_t i = 0; i < force.size(); ++i) {
        if (!c_.free[i]) continue;
        const std::size_t first = at(i, weight);
        for (int k = 0; k < 4; ++k) sum[i] += (n == 1 ? of_all : 1) * weight[k] * hat[first + step[k]];
      }
    }
    force = sum;
  }
  /// y += what the pressures do to forces at the points, transposed.
  void add_transposed(const std::vector<double> &force, std::vector<double> &y) const
  {
    for (std::size_t e = 0; e < c_.facet.size(); ++e)
      for (int a = 0; a < 3; ++a)
        for (int j = 0; j < 3; ++j)
          if (c_.free[c_.point[e][a]])
            y[e * 3 + j] += c_.area[e] * barycentric_mass(a, j) * force[c_.point[e][a]] / (c_.modulus * size_);
  }

  const SpaceContact &c_;
  double size_ = 0; // of facets [m]
  std::array<double, 2> low_{}, span_{};
  std::vector<int> intervals_;
  std::vector<double> f_, scale_, start_, low_bound_, high_bound_;
};

using Corner = std::array<double, 3>; // barycentric

double value_at(const OfTriangle &of, const Corner &x)
{
  return of[0] * x[0] + of[1] * x[1] + of[2] * x[2];
}

/// The part of a triangle where sign * v >= 0.
std::vector<Corner> part_of(const OfTriangle &v, const double sign)
{
  std::vector<Corner> corners;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const double a = sign * v[k], b = sign * v[next];
    Corner x{};
    if (a >= 0) {
      x[k] = 1;
      corners.push_back(x);
    }
    if ((a < 0) != (b < 0) && a != 0 && b != 0) {
      x = {};
      x[next] = a / (a - b);
      x[k] = 1 - x[next];
      corners.push_back(x);
    }
  }
  return corners;
}

/// Integrals of v and of p v over a part.
std::array<double, 2> over(const std::vector<Corner> &corners, const OfTriangle &v, const OfTriangle &p)
{
  std::array<double, 2> sum{};
  for (std::size_t k = 2; k < corners.size(); ++k) {
    const Corner t[3] = {corners[0], corners[k - 1], corners[k]};
    const double size = std::abs((t[1][1] - t[0][1]) * (t[2][2] - t[0][2]) - (t[1][2] - t[0][2]) * (t[2][1] - t[0][1]));
    for (int i = 0; i < 3; ++i) {
      sum[0] += size * value_at(v, t[i]) / 3;
      for (int j = 0; j < 3; ++j) sum[1] += size * barycentric_mass(i, j) * value_at(v, t[i]) * value_at(p, t[j]);
    }
  }
  return sum;
}

} // namespace

std::vector<OfTriangle> fitted_pressure(const SpaceContact &c, const std::vector<OfTriangle> &v)
{
  const std::vector<double> x = least_in_box(FitInSpace(c, v));
  std::vector<OfTriangle> p(c.facet.size());
  for (std::size_t e = 0; e < p.size(); ++e)
    for (int i = 0; i < 3; ++i) p[e][i] = x[e * 3 + i];
  return p;
}

TriangleIntegrals contact_integrals(const OfTriangle &v, const OfTriangle &p, const double limit)
{
  TriangleIntegrals sum;
  sum.gap -= over(part_of(v, -1), v, p)[1];
  if (contact::is_rigid(limit)) return sum;
  const auto pressed = over(part_of(v, 1), v, p);
  sum.yielding = limit * pressed[0];
  sum.gap += limit * pressed[0] - pressed[1];
  return sum;
}

} // namespace rpc::bound
