// SPDX-License-Identifier: BSD-3-Clause
#include "traction_fit.hpp"

#include "gauss.hpp"
#include "least_in_box.hpp"

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

/// The quadratic function of the fit: x . H x/2 - f . x. The unknowns are Bernstein coefficients, facet by facet, and with hardening
/// once more as many, by which these exceed the yield limit.
class Fit
{
public:
  Fit(const ContactFacets &c, const WantedTraction &w)
      : c_(c), w_(w), per_facet_(c.order + 1), coefficients_(c.facet.size() * per_facet_),
        forces_(products(c.order, shape_at, bernstein_at)), mass_(products(c.order, bernstein_at, bernstein_at))
  {
    list_hats();
    divide_by_circles();
    const std::size_t n = w.rise > 0 ? 2 * coefficients_ : coefficients_;
    for (auto *const of_unknowns : {&f_, &scale_, &start_, &low_bound_, &high_bound_}) of_unknowns->assign(n, 0.);
    std::vector<double> wanted(w.force);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (!w.free[i]) wanted[i] = 0;
    add_weighted(wanted);
    for (std::size_t e = 0; e < c.facet.size(); ++e)
      for (int i = 0; i < per_facet_; ++i) add_facet(e, i);
    beside_forces_ = f_;
    add_transposed(wanted, f_);
    for (std::size_t k = coefficients_; k < n; ++k) f_[k] = f_[k - coefficients_];
  }

  /// y <- H x.
  void apply(const std::vector<double> &x, std::vector<double> &y) const
  {
    apply_to(x, std::vector<double>(c_.force.size(), 0.), y);
  }
  /// y <- H x - f. Forces of the whole side weigh much: their difference is taken before.
  void gradient(const std::vector<double> &x, std::vector<double> &y) const
  {
    std::vector<double> without(c_.force.size(), 0.);
    for (std::size_t i = 0; i < without.size(); ++i)
      if (w_.free[i]) without[i] = -w_.force[i];
    apply_to(x, without, y);
    for (std::size_t k = 0; k < y.size(); ++k) y[k] -= beside_forces_[k % coefficients_];
  }
  /// The traction's coefficient.
  double whole(const std::vector<double> &x, const std::size_t e, const int j) const
  {
    const std::size_t k = e * per_facet_ + j;
    return x.size() > coefficients_ ? x[k] + x[k + coefficients_] : x[k];
  }
  const std::vector<double> &right_side() const { return f_; }
  const std::vector<double> &scale() const { return scale_; } ///< that makes about 1 of the diagonal
  const std::vector<double> &start() const { return start_; }
  const std::vector<double> &low() const { return low_bound_; }
  const std::vector<double> &high() const { return high_bound_; }

private:
  /// y <- H x with more forces at the points.
  void apply_to(const std::vector<double> &x, std::vector<double> force, std::vector<double> &y) const
  {
    for (std::size_t e = 0; e < c_.facet.size(); ++e)
      for (int a = 0; a < per_facet_; ++a)
        for (int j = 0; j < per_facet_; ++j)
          if (w_.free[c_.point[e][a]]) force[c_.point[e][a]] += c_.length[e] * forces_[a][j] * whole(x, e, j);
    add_weighted(force);
    y.assign(x.size(), 0.);
    add_transposed(force, y);
    for (std::size_t e = 0; e < c_.facet.size(); ++e)
      for (int i = 0; i < per_facet_; ++i)
        for (int j = 0; j < per_facet_; ++j) y[e * per_facet_ + i] += mass(e, i, j) * whole(x, e, j);
    for (std::size_t k = coefficients_; k < x.size(); ++k)
      y[k] = y[k - coefficients_] + beyond_weight((k - coefficients_) / per_facet_, k % per_facet_) * x[k];
  }
  void add_facet(const std::size_t e, const int i)
  {
    const std::size_t k = e * per_facet_ + i;
    const bool hardens = w_.rise > 0;
    double own = 0;
    low_bound_[k] = w_.low[e][i];
    high_bound_[k] = w_.high[e][i];
    start_[k] = std::clamp(w_.near[e][i], w_.low[e][i], w_.high[e][i]);
    for (int j = 0; j < per_facet_; ++j) {
      const double near = std::clamp(w_.near[e][j], w_.low[e][j], hardens ? infinite : w_.high[e][j]);
      f_[k] += near_weight(e) * mass_[i][j] * near;
      f_[k] += c_.length[e] * forces_[j][i] * w_.depth[e][j];
      own += forces_[j][i] * forces_[j][i];
    }
    const double diagonal = c_.length[e] * c_.length[e] * own / c_.modulus + mass(e, i, i);
    scale_[k] = 1 / std::sqrt(diagonal);
    if (!hardens) return;
    start_[k + coefficients_] = std::max(0., w_.near[e][i] - w_.high[e][i]);
    const bool none = !w_.none.empty() && w_.none[e][i];
    if (none) start_[k + coefficients_] = 0;
    high_bound_[k + coefficients_] = none || std::isinf(w_.high[e][i]) ? 0 : infinite;
    scale_[k + coefficients_] = 1 / std::sqrt(diagonal + beyond_weight(e, i));
  }
  double near_weight(const std::size_t e) const
  {
    constexpr double share = 0.1; // how much the pressure at the nodes counts beside their forces
    return share * c_.length[e] * c_.length[e] / c_.modulus;
  }
  /// With the energy c p^2/2 of the foundation's springs.
  double mass(const std::size_t e, const int i, const int j) const
  {
    const double of_springs = c_.circle.empty() ? mass_[i][j] : over_circle_[e][i][j];
    return near_weight(e) * mass_[i][j] + w_.spring * c_.length[e] * of_springs;
  }
  /// Of the squares of what coefficients exceed the yield limit by: (p - xi)^2/(2 H) is convex, so that its integral is no larger.
  double beyond_weight(const std::size_t e, const int i) const
  {
    const double circle = c_.circle.empty() || c_.circle[e][i] == 0 ? 1 : c_.circle[e][i];
    return c_.length[e] / (per_facet_ * w_.rise * circle);
  }
  /// Of bodies of revolution int B_i B_j/(2 pi r) of the coefficients that are not 0 at the axis.
  void divide_by_circles()
  {
    const Gauss rule = gauss(6);
    for (const OfFacet &circle : c_.circle) {
      over_circle_.push_back({});
      for (std::size_t q = 0; q < rule.point.size(); ++q) {
        const OfFacet b = bernstein_at(c_.order, rule.point[q]);
        double here = 0;
        for (int i = 0; i < per_facet_; ++i) here += b[i] * circle[i];
        for (int i = 0; i < per_facet_; ++i)
          for (int j = 0; j < per_facet_; ++j)
            if (circle[i] > 0 && circle[j] > 0) over_circle_.back()[i][j] += rule.weight[q] * b[i] * b[j] / here;
      }
    }
  }
  /// Intervals of hats on all levels, from about two nodes for each down to one for all.
  void list_hats()
  {
    low_ = std::numeric_limits<double>::infinity();
    double high = -low_;
    int count = 0;
    for (std::size_t i = 0; i < c_.place.size(); ++i)
      if (w_.free[i]) {
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
        if (!w_.free[i]) continue;
        const double x = at(i, k);
        hat[k] += (1 - x) * force[i];
        hat[k + 1] += x * force[i];
      }
      for (std::size_t i = 0; i < force.size(); ++i) {
        if (!w_.free[i]) continue;
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
          if (w_.free[c_.point[e][a]])
            y[e * per_facet_ + j] += c_.length[e] * forces_[a][j] * force[c_.point[e][a]] / c_.modulus;
  }

  static constexpr double infinite = std::numeric_limits<double>::infinity();
  const ContactFacets &c_;
  const WantedTraction &w_;
  int per_facet_;
  std::size_t coefficients_;
  Table forces_, mass_; // of shape and Bernstein functions, of Bernstein functions
  std::vector<Table> over_circle_;
  double low_ = 0, span_ = 0;
  std::vector<int> intervals_;
  std::vector<double> beside_forces_; // f without what the forces make of it
  std::vector<double> f_, scale_, start_, low_bound_, high_bound_;
};

} // namespace

std::vector<OfFacet> fitted_traction(const ContactFacets &c, const WantedTraction &wanted)
{
  Fit fit(c, wanted);
  const std::vector<double> x = least_in_box(fit);
  std::vector<OfFacet> p(c.facet.size());
  for (std::size_t e = 0; e < p.size(); ++e)
    for (int i = 0; i <= c.order; ++i) p[e][i] = fit.whole(x, e, i);
  return p;
}

} // namespace rpc::bound
