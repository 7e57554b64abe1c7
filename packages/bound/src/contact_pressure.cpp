// SPDX-License-Identifier: BSD-3-Clause
#include "contact_pressure.hpp"

#include "beside_inverse.hpp"
#include "gauss.hpp"
#include "rpc/contact/law/foundation.hpp"
#include "traction_fit.hpp"

#include <algorithm>
#include <cmath>

namespace rpc::bound
{
namespace
{

/// A polynomial of degree 2 on [0, 1] by its Bernstein coefficients.
struct Polynomial {
  double c0, c1, c2;

  Polynomial(const int order, const OfFacet &b)
      : c0(b[0]), c1(order == 1 ? b[1] - b[0] : 2 * (b[1] - b[0])), c2(order == 1 ? 0 : b[0] - 2 * b[1] + b[2])
  {
  }
  Polynomial(const double a, const double b, const double c) : c0(a), c1(b), c2(c) {}
  double operator()(const double x) const { return c0 + x * (c1 + x * c2); }
  /// This + a other.
  Polynomial plus(const double a, const Polynomial &other) const
  {
    return {c0 + a * other.c0, c1 + a * other.c1, c2 + a * other.c2};
  }
};

/// Parts of [0, 1] within which none of some polynomials changes its sign.
class Parts
{
public:
  void end_at_roots_of(const Polynomial &p)
  {
    const double discriminant = p.c1 * p.c1 - 4 * p.c2 * p.c0;
    if (!(discriminant > 0)) return;
    const double q = -0.5 * (p.c1 + std::copysign(std::sqrt(discriminant), p.c1));
    if (p.c2 != 0) add(q / p.c2);
    if (q != 0) add(p.c0 / q);
  }
  /// Sum of w f(x), exact where f is a polynomial of degree 2 n - 1 within each part.
  template <class Function>
  void integrate(const int n, const Function &f)
  {
    std::sort(at_.begin(), at_.end());
    const Gauss rule = gauss(n);
    for (std::size_t k = 0; k + 1 < at_.size(); ++k)
      for (std::size_t q = 0; q < rule.point.size(); ++q)
        f(at_[k] + rule.point[q] * (at_[k + 1] - at_[k]), rule.weight[q] * (at_[k + 1] - at_[k]));
  }

private:
  void add(const double x)
  {
    if (x > 0 && x < 1) at_.push_back(x);
  }
  std::vector<double> at_{0, 1};
};

/// Bernstein coefficients between bounds.
OfFacet clamped(OfFacet b, const OfFacet &low, const OfFacet &high)
{
  for (int i = 0; i < 3; ++i) b[i] = std::clamp(b[i], low[i], high[i]);
  return b;
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
  WantedTraction wanted{c.force, c.free, {}, v, {}, {}, c.spring, c.rise};
  for (std::size_t e = 0; e < c.facet.size(); ++e) {
    wanted.near.push_back(bernstein(c.order, c.pressure[e]));
    wanted.low.push_back({});
    wanted.high.push_back(c.limit_of[e]);
    if (c.circle.empty()) continue;
    wanted.none.push_back({});
    for (int a = 0; a <= c.order; ++a) {
      wanted.none[e][a] = c.circle[e][a] == 0;
      wanted.high[e][a] = wanted.none[e][a] ? 0 : wanted.high[e][a] * c.circle[e][a];
      if (wanted.none[e][a]) wanted.near[e][a] = 0;
    }
  }
  return fitted_traction(c, wanted);
}

std::vector<OfFacet> fitted_friction(const ContactFacets &c, const std::vector<OfFacet> &slip)
{
  const FrictionFacets &f = c.friction;
  WantedTraction wanted{f.force, f.free, {}, slip, {}, f.limit_of, 0, 0};
  for (std::size_t e = 0; e < c.facet.size(); ++e) {
    const OfFacet &s = f.limit_of[e];
    wanted.low.push_back({-s[0], -s[1], -s[2]});
    wanted.near.push_back(clamped(bernstein(c.order, f.traction[e]), wanted.low[e], s));
  }
  return fitted_traction(c, wanted);
}

ContactIntegrals contact_integrals(const int order, const OfFacet &v, const OfFacet &p, const NormalLaw &law)
{
  const Polynomial depth(order, bernstein(order, v)), pressure(order, p);
  const bool rigid = contact::is_rigid(*std::max_element(law.limit.begin(), law.limit.end()));
  Parts parts; // within which the integrands are polynomials of degree 4
  parts.end_at_roots_of(depth);
  const Polynomial limit(order, rigid ? OfFacet{} : law.limit);
  if (!rigid) {
    parts.end_at_roots_of(limit);
    parts.end_at_roots_of(depth.plus(-law.spring, limit));
    OfFacet most = law.limit;
    for (int a = 0; a <= order && law.circle; ++a) most[a] *= (*law.circle)[a]; // the limit is even there
    parts.end_at_roots_of(pressure.plus(-1, Polynomial(order, most)));
  }
  const Polynomial circle(order, law.circle.value_or(OfFacet{}));
  const double nearest = std::min(circle(0), circle(1)), farthest = std::max(circle(0), circle(1));
  ContactIntegrals sum;
  parts.integrate(law.circle ? 6 : 3, [&](const double x, const double w) {
    const double deep = depth(x), p_here = std::max(0., pressure(x)), here = law.circle ? circle(x) : 1;
    if (!(here > 0)) return; // at a root on the axis, off it by rounding
    const double yield = rigid ? law.limit[0] : here * std::max(0., limit(x));
    const contact::Foundation f{yield, law.rise * here, law.spring / here}; // (13.10d)
    const double of_conjugate = law.circle && nearest > 0 ? here * beside_inverse(here, nearest, farthest, true) : 1;
    sum.add(w, deep, p_here, f, rigid && law.spring == 0, of_conjugate);
  });
  return sum;
}

ContactIntegrals friction_integrals(const int order, const OfFacet &slip, const OfFacet &traction, const OfFacet &limit)
{
  const Polynomial e(order, bernstein(order, slip)), q(order, traction), s(order, limit);
  Parts parts;
  parts.end_at_roots_of(e);
  ContactIntegrals sum;
  parts.integrate(3, [&](const double x, const double w) {
    sum.energy += w * s(x) * std::abs(e(x));
    sum.gap += w * std::max(0., s(x) * std::abs(e(x)) - q(x) * e(x));
  });
  return sum;
}

double lowered_middle(const OfFacet &v)
{
  return std::min(v[2], (v[0] + v[1]) / 4);
}

} // namespace rpc::bound
