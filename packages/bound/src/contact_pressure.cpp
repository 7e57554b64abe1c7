// SPDX-License-Identifier: BSD-3-Clause
#include "contact_pressure.hpp"

#include "gauss.hpp"
#include "least_in_box.hpp"
#include "rpc/contact/law/foundation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::bound
{
namespace
{

/// Values of Bernstein's polynomials and of the element's functions at a point of [0, 1].
OfFacet bernstein_at(const int order, const double x)
{
  if (order == 1) return {1 - x, x, 0};
  return {(1 - x) * (1 - x), 2 * x * (1 - x), x * x};
}
OfFacet shape_at(const int order, const double x)
{
  if (order == 1) return {1 - x, x, 0};
  return {(1 - x) * (1 - 2 * x), x * (2 * x - 1), 4 * x * (1 - x)};
}

using Table = std::array<OfFacet, 3>;

/// int of the products of two families of functions.
template <class First, class Second>
Table products(const int order, const First &first, const Second &second)
{
  Table t{};
  const Gauss rule = gauss(3);
  for (std::size_t q = 0; q < rule.point.size(); ++q) {
    const OfFacet a = first(order, rule.point[q]), b = second(order, rule.point[q]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) t[i][j] += rule.weight[q] * a[i] * b[j];
  }
  return t;
}

/// The quadratic function of the fit: x . H x/2 - f . x for Bernstein coefficients x, facet by facet.
class Fit
{
public:
  Fit(const ContactFacets &c, const std::vector<OfFacet> &v)
      : c_(c), per_facet_(c.order + 1), forces_(products(c.order, shape_at, bernstein_at)),
        mass_(products(c.order, bernstein_at, bernstein_at))
  {
    list_hats();
    const std::size_t n = c.facet.size() * per_facet_;
    f_.assign(n, 0.);
    scale_.assign(n, 0.);
    std::vector<double> wanted(c.force);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (!c.free[i]) wanted[i] = 0;
    add_weighted(wanted);
    add_transposed(wanted, f_);
    start_.assign(n, 0.);
    low_bound_.assign(n, 0.);
    high_bound_.assign(n, c.limit);
    for (std::size_t e = 0; e < c.facet.size(); ++e) {
      OfFacet near = bernstein(c.order, c.pressure[e]);
      for (double &b : near) b = std::clamp(b, 0., c.limit);
      for (int i = 0; i < per_facet_; ++i) {
        double own = 0;
        start_[e * per_facet_ + i] = near[i];
        for (int j = 0; j < per_facet_; ++j) {
          f_[e * per_facet_ + i] += near_weight(e) * mass_[i][j] * near[j];
          f_[e * per_facet_ + i] += c.length[e] * forces_[j][i] * v[e][j];
          own += forces_[j][i] * forces_[j][i];
        }
        scale_[e * per_facet_ + i] =
            1 / std::sqrt(c.length[e] * c.length[e] * own / c.modulus + near_weight(e) * mass_[i][i]);
      }
    }
  }

  /// y <- H x.
  void apply(const std::vector<double> &x, std::vector<double> &y) const
  {
    std::vector<double> force(c_.force.size(), 0.);
    for (std::size_t e = 0; e < c_.facet.size(); ++e)
      for (int a = 0; a < per_facet_; ++a)
        for (int j = 0; j < per_facet_; ++j)
          if (c_.free[c_.point[e][a]]) force[c_.point[e][a]] += c_.length[e] * forces_[a][j] * x[e * per_facet_ + j];
    add_weighted(force);
    y.assign(x.size(), 0.);
    add_transposed(force, y);
    for (std::size_t e = 0; e < c_.facet.size(); ++e)
      for (int i = 0; i < per_facet_; ++i)
        for (int j = 0; j < per_facet_; ++j)
          y[e * per_facet_ + i] += near_weight(e) * mass_[i][j] * x[e * per_facet_ + j];
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
    return share * c_.length[e] * c_.length[e] / c_.modulus;
  }
  /// Intervals of hats on all levels, from about two nodes for each down to one for all.
  void list_hats()
  {
    low_ = std::numeric_limits<double>::infinity();
    double high = -low_;
    int count = 0;
    for (std::size_t i = 0; i < c_.place.size(); ++i)
      if (c_.free[i]) {
        low_ = std::min(low_, c_.place[i]);
        high = std::max(high, c_.place[i]);
        ++count;
      }
    span_ = high - low_;
    for (int n = count / 2; n >= 1 && span_ > 0; n /= 2) intervals_.push_back(n);
  }
  /// force <- S force, with S the sum over all levels of the products with hats, and the nodes themselves.
  void add_weighted(std::vector<double> &force) const
  {
    constexpr double of_all = 100; // of the force and moment of the whole side, squared
    std::vector<double> sum(force);
    for (const int n : intervals_) {
      std::vector<double> hat(n + 2, 0.);
      const auto at = [&](const std::size_t i, int &k) {
        const double x = n * (c_.place[i] - low_) / span_;
        k = std::clamp(static_cast<int>(x), 0, n - 1);
        return x - k;
      };
      int k = 0;
      for (std::size_t i = 0; i < force.size(); ++i) {
        if (!c_.free[i]) continue;
        const double x = at(i, k);
        hat[k] += (1 - x) * force[i];
        hat[k + 1] += x * force[i];
      }
      for (std::size_t i = 0; i < force.size(); ++i) {
        if (!c_.free[i]) continue;
        const double x = at(i, k);
        sum[i] += (n == 1 ? of_all : 1) * ((1 - x) * hat[k] + x * hat[k + 1]);
      }
    }
    force = sum;
  }
  /// y += what the coefficients do to forces at the points, transposed.
  void add_transposed(const std::vector<double> &force, std::vector<double> &y) const
  {
    for (std::size_t e = 0; e < c_.facet.size(); ++e)
      for (int a = 0; a < per_facet_; ++a)
        for (int j = 0; j < per_facet_; ++j)
          if (c_.free[c_.point[e][a]])
            y[e * per_facet_ + j] += c_.length[e] * forces_[a][j] * force[c_.point[e][a]] / c_.modulus;
  }

  const ContactFacets &c_;
  int per_facet_;
  Table forces_, mass_; // of shape and Bernstein functions, of Bernstein functions
  double low_ = 0, span_ = 0;
  std::vector<int> intervals_;
  std::vector<double> f_, scale_, start_, low_bound_, high_bound_;
};

/// Where a polynomial of degree 2 changes its sign within [0, 1], with both ends.
std::vector<double> pieces_of(const double c0, const double c1, const double c2)
{
  std::vector<double> at{0};
  const auto add = [&](const double x) {
    if (x > 0 && x < 1) at.push_back(x);
  };
  const double discriminant = c1 * c1 - 4 * c2 * c0;
  if (discriminant > 0) {
    const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
    if (c2 != 0) add(q / c2);
    if (q != 0) add(c0 / q);
  }
  at.push_back(1);
  std::sort(at.begin(), at.end());
  return at;
}

} // namespace

OfFacet bernstein(const int order, const OfFacet &at_nodes)
{
  if (order == 1) return at_nodes;
  return {at_nodes[0], 2 * at_nodes[2] - (at_nodes[0] + at_nodes[1]) / 2, at_nodes[1]};
}

OfFacet legendre_of(const int order, const OfFacet &b)
{
  if (order == 1) return {(b[0] + b[1]) / 2, (b[1] - b[0]) / 2, 0};
  return {(b[0] + b[1] + b[2]) / 3, (b[2] - b[0]) / 2, (b[0] - 2 * b[1] + b[2]) / 6};
}

std::vector<OfFacet> fitted_pressure(const ContactFacets &c, const std::vector<OfFacet> &v)
{
  const std::vector<double> x = least_in_box(Fit(c, v), 1e-20);
  std::vector<OfFacet> p(c.facet.size());
  for (std::size_t e = 0; e < p.size(); ++e)
    for (int i = 0; i <= c.order; ++i) p[e][i] = x[e * (c.order + 1) + i];
  return p;
}

ContactIntegrals contact_integrals(const int order, const OfFacet &v, const OfFacet &p, const double limit)
{
  const double c0 = v[0], c1 = order == 1 ? v[1] - v[0] : -3 * v[0] - v[1] + 4 * v[2],
               c2 = order == 1 ? 0 : 2 * v[0] + 2 * v[1] - 4 * v[2];
  const Gauss rule = gauss(3);
  const std::vector<double> at = pieces_of(c0, c1, c2);
  ContactIntegrals sum;
  for (std::size_t k = 0; k + 1 < at.size(); ++k)
    for (std::size_t q = 0; q < rule.point.size(); ++q) {
      const double x = at[k] + rule.point[q] * (at[k + 1] - at[k]), w = rule.weight[q] * (at[k + 1] - at[k]);
      const OfFacet b = bernstein_at(order, x);
      const double depth = c0 + x * (c1 + x * c2), pressure = b[0] * p[0] + b[1] * p[1] + b[2] * p[2];
      if (!(depth > 0)) {
        sum.gap -= w * pressure * depth;
      } else if (!contact::is_rigid(limit)) {
        sum.yielding += w * limit * depth;
        sum.gap += w * (limit - pressure) * depth;
      }
    }
  return sum;
}

double lowered_middle(const OfFacet &v)
{
  return std::min(v[2], (v[0] + v[1]) / 4);
}

} // namespace rpc::bound
