// SPDX-License-Identifier: BSD-3-Clause
#include "space_contact.hpp"

#include "rpc/contact/law/foundation.hpp"
#include "space_traction_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rpc::bound
{
namespace
{

double value_at(const OfTriangle &of, const Barycentric &x)
{
  return of[0] * x[0] + of[1] * x[1] + of[2] * x[2];
}

/// Parts of a triangle within which none of some linear functions changes its sign.
class PartsOfTriangle
{
public:
  void end_at_roots_of(const OfTriangle &v)
  {
    if (*std::min_element(v.begin(), v.end()) >= 0 || *std::max_element(v.begin(), v.end()) <= 0) return;
    std::vector<std::vector<Barycentric>> cut;
    for (const auto &polygon : parts_)
      for (const double sign : {1., -1.}) {
        cut.push_back(part_of_polygon(polygon, v, sign));
        if (cut.back().size() < 3) cut.pop_back();
      }
    parts_ = cut;
  }
  /// Sum of w f(x), exact where f is a polynomial of degree 2 within each part.
  template <class Function>
  void integrate(const Function &f) const
  {
    for (const auto &corners : parts_)
      for (std::size_t k = 2; k < corners.size(); ++k) {
        const Barycentric *const t[3] = {&corners[0], &corners[k - 1], &corners[k]};
        const auto side = [&](const int v, const int i) { return (*t[v])[i] - (*t[0])[i]; };
        const double size = std::abs(side(1, 1) * side(2, 2) - side(1, 2) * side(2, 1));
        for (int m = 0; m < 3; ++m) { // the middles of the sides
          Barycentric x{};
          for (int i = 0; i < 3; ++i) x[i] = ((*t[m])[i] + (*t[(m + 1) % 3])[i]) / 2;
          f(x, size / 3);
        }
      }
  }

private:
  std::vector<std::vector<Barycentric>> parts_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};

OfTriangle plus(OfTriangle x, const double a, const OfTriangle &y)
{
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += a * y[i];
  return x;
}

/// Both ends of the sides 01, 12, 02.
constexpr std::array<int, 2> ends_of(const int side)
{
  return {side == 1 ? 1 : 0, side == 0 ? 1 : 2};
}

/// Powers of the barycentric coordinates in a Bernstein polynomial.
std::array<int, 3> powers(const int order, const int i)
{
  std::array<int, 3> a{};
  if (i < 3)
    a[i] = order;
  else
    for (const int v : ends_of(i - 3)) a[v] = 1;
  return a;
}

/// The part of a triangle between three places.
using Part = std::array<Barycentric, 3>;

/// The coefficients on a part.
OfTriangle on_part(const int order, const OfTriangle &b, const Part &part)
{
  OfTriangle of{};
  if (order == 1) {
    for (int v = 0; v < 3; ++v) of[v] = value_at(b, part[v]);
    return of;
  }
  const auto blossom = [&](const Barycentric &x, const Barycentric &y) {
    double sum = x[0] * y[0] * b[0] + x[1] * y[1] * b[1] + x[2] * y[2] * b[2];
    for (int m = 0; m < 3; ++m) {
      const auto [i, j] = ends_of(m);
      sum += (x[i] * y[j] + x[j] * y[i]) * b[3 + m];
    }
    return sum;
  };
  for (int v = 0; v < 3; ++v) of[v] = blossom(part[v], part[v]);
  for (int m = 0; m < 3; ++m) of[3 + m] = blossom(part[ends_of(m)[0]], part[ends_of(m)[1]]);
  return of;
}

Barycentric between(const Barycentric &x, const Barycentric &y)
{
  return {(x[0] + y[0]) / 2, (x[1] + y[1]) / 2, (x[2] + y[2]) / 2};
}

bool changes_sign(const OfTriangle &b)
{
  return *std::min_element(b.begin(), b.end()) < 0 && *std::max_element(b.begin(), b.end()) > 0;
}

/// The integrals of order 2. Where roots cross a part it is divided; in the last ones psi, which is convex in v and grows with xi, counts as
/// the mean of its values at the coefficients of v with the largest xi, and psi* likewise with the least one.
class Quadratic
{
public:
  Quadratic(const OfTriangle &v, const OfTriangle &p, const TriangleLaw &law)
      : v_(v), p_(p), law_(law), rigid_(contact::is_rigid(*std::max_element(law.limit.begin(), law.limit.end())))
  {
  }
  ContactIntegrals integrated()
  {
    add({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 1, 0);
    return sum_;
  }

private:
  void add(const Part &part, const double size, const int depth)
  {
    constexpr int deepest = 5; // what is left of an error of parts of 1 is (1/4)^5
    const OfTriangle v = on_part(2, v_, part), p = on_part(2, p_, part),
                     limit = rigid_ ? law_.limit : on_part(2, law_.limit, part);
    const bool changes = changes_sign(v) ||
                         (!rigid_ && (changes_sign(plus(v, -law_.spring, limit)) || changes_sign(plus(p, -1, limit))));
    if (!changes) {
      static const FacetRule rule = facet_rule(3, 3); // polynomials of degree 4
      for (int q = 0; q < rule.size(); ++q)
        sum_.add(size * rule.weight[q], value_of(2, v, rule.point[q]), std::max(0., value_of(2, p, rule.point[q])),
                 {rigid_ ? limit[0] : value_of(2, limit, rule.point[q]), law_.rise, law_.spring},
                 rigid_ && law_.spring == 0);
      return;
    }
    if (depth < deepest) {
      const Barycentric middle[3] = {between(part[0], part[1]), between(part[1], part[2]), between(part[0], part[2])};
      for (const Part &quarter : {Part{part[0], middle[0], middle[2]}, Part{middle[0], part[1], middle[1]},
                                  Part{middle[2], middle[1], part[2]}, Part{middle[0], middle[1], middle[2]}})
        add(quarter, size / 4, depth + 1);
      return;
    }
    const double most = *std::max_element(limit.begin(), limit.end()),
                 least = *std::min_element(limit.begin(), limit.end());
    double energy = 0, conjugate = 0, work = 0;
    for (int i = 0; i < 6; ++i) {
      energy += contact::foundation_energy(v[i], {most, law_.rise, law_.spring}) / 6;
      conjugate += contact::conjugate_energy(std::max(0., p[i]), {least, law_.rise, law_.spring}) / 6;
      for (int j = 0; j < 6; ++j) work += mean_product(2, i, j) * p[i] * v[j];
    }
    sum_.energy += size * energy;
    sum_.gap += size * std::max(0., energy + conjugate - work);
  }

  OfTriangle v_, p_;
  TriangleLaw law_;
  bool rigid_;
  ContactIntegrals sum_;
};

} // namespace

std::vector<Barycentric> part_of_polygon(const std::vector<Barycentric> &polygon, const OfTriangle &v,
                                         const double sign)
{
  std::vector<Barycentric> corners;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Barycentric &here = polygon[k], &next = polygon[(k + 1) % polygon.size()];
    const double a = sign * value_at(v, here), b = sign * value_at(v, next);
    if (a >= 0) corners.push_back(here);
    if ((a < 0) == (b < 0) || a == 0 || b == 0) continue;
    const double s = a / (a - b);
    Barycentric x{};
    for (int i = 0; i < 3; ++i) x[i] = (1 - s) * here[i] + s * next[i];
    corners.push_back(x);
  }
  return corners;
}

OfTriangle bernstein_of(const int order, const OfTriangle &at_nodes)
{
  OfTriangle b = at_nodes;
  for (int m = 0; order == 2 && m < 3; ++m)
    b[3 + m] = 2 * at_nodes[3 + m] - (at_nodes[ends_of(m)[0]] + at_nodes[ends_of(m)[1]]) / 2;
  return b;
}

double value_of(const int order, const OfTriangle &bernstein, const std::array<double, 3> &at)
{
  if (order == 1) return value_at(bernstein, at);
  double sum = 0;
  for (int v = 0; v < 3; ++v) sum += bernstein[v] * at[v] * at[v];
  for (int m = 0; m < 3; ++m) sum += bernstein[3 + m] * 2 * at[ends_of(m)[0]] * at[ends_of(m)[1]];
  return sum;
}

double mean_product(const int order, const int i, const int j)
{
  constexpr int choose[5][3] = {{1, 0, 0}, {1, 1, 0}, {1, 2, 1}, {1, 3, 3}, {1, 4, 6}};
  const std::array<int, 3> a = powers(order, i), b = powers(order, j);
  double product = 1;
  for (int v = 0; v < 3; ++v) product *= choose[a[v] + b[v]][std::min(a[v], b[v])];
  return product / (order == 1 ? 12 : 90);
}

OfTriangle through_middles(const OfTriangle &at_nodes)
{
  OfTriangle of = at_nodes;
  const double sum = at_nodes[3] + at_nodes[4] + at_nodes[5];
  for (int v = 0; v < 3; ++v) of[v] = sum - 2 * at_nodes[v == 0 ? 4 : (v == 1 ? 5 : 3)];
  return of;
}

std::vector<OfTriangle> fitted_pressure(const SpaceContact &c, const std::vector<OfTriangle> &v)
{
  WantedInSpace wanted;
  wanted.force[0] = c.force;
  wanted.free = c.free;
  wanted.depth[0] = v;
  wanted.high[0] = c.limit_of;
  wanted.spring = c.spring;
  wanted.rise = c.rise;
  for (std::size_t e = 0; e < c.facet.size(); ++e) {
    OfTriangle near = c.pressure[e];
    for (int i = 0; i < nodes_of_triangle(c.order); ++i)
      near[i] = std::clamp(near[i], 0., c.rise > 0 ? std::numeric_limits<double>::infinity() : c.limit_of[e][i]);
    wanted.near[0].push_back(near);
    wanted.low[0].push_back({});
  }
  return fitted_in_space(c, wanted)[0];
}

AlongSide fitted_friction(const SpaceContact &c, const AlongSide &slip)
{
  const SpaceFriction &f = c.friction;
  WantedInSpace wanted;
  wanted.components = 2;
  wanted.force = f.force;
  wanted.free = f.free;
  wanted.depth = slip;
  for (std::size_t e = 0; e < c.facet.size(); ++e) {
    wanted.toward.emplace_back();
    for (auto *const side : {&wanted.near, &wanted.low, &wanted.high})
      for (auto &component : *side) component.push_back({});
    std::array<OfTriangle, 2> traction{};
    for (int k = 0; k < 2; ++k) {
      for (int a = 0; a < nodes_of_triangle(c.order); ++a) traction[k][a] = f.traction[c.point[e][a]][k];
      if (c.order == 2) traction[k] = through_middles(traction[k]);
    }
    for (int a = 0; a < nodes_of_triangle(c.order); ++a) {
      // Limits are discs. Of one the box has the traction of the node in it and touches the circle with its corners: along a traction that has
      // reached the limit it is a line.
      const double s = f.limit_of[e][a];
      std::array<double, 2> q = {traction[0][a], traction[1][a]}, toward{1, 0};
      const double size = std::hypot(q[0], q[1]), slipped = std::hypot(slip[0][e][a], slip[1][e][a]);
      if (size > 0)
        toward = {q[0] / size, q[1] / size};
      else if (slipped > 0)
        toward = {slip[0][e][a] / slipped, slip[1][e][a] / slipped};
      // What rounding leaves to the limit is none: a root would make much of it, and ranks would differ.
      constexpr double rounding = 1e-9;
      const double along = size >= (1 - rounding) * s ? s : std::max(size, s * std::sqrt(0.5)),
                   across = std::sqrt((s - along) * (s + along));
      for (int k = 0; k < 2; ++k) {
        wanted.near[k][e][a] = size > s ? s * toward[k] : q[k];
        wanted.high[k][e][a] = k == 0 ? along : across;
        wanted.low[k][e][a] = -wanted.high[k][e][a];
      }
      wanted.toward[e][a] = toward;
    }
  }
  return fitted_in_space(c, wanted);
}

ContactIntegrals contact_integrals(const int order, const OfTriangle &v, const OfTriangle &p, const TriangleLaw &law)
{
  if (order == 2) return Quadratic(v, p, law).integrated();
  const bool rigid = contact::is_rigid(*std::max_element(law.limit.begin(), law.limit.end()));
  PartsOfTriangle parts; // within which the integrands are polynomials of degree 2
  parts.end_at_roots_of(v);
  if (!rigid) {
    parts.end_at_roots_of(plus(v, -law.spring, law.limit));
    parts.end_at_roots_of(plus(p, -1, law.limit));
  }
  ContactIntegrals sum;
  parts.integrate([&](const Barycentric &x, const double w) {
    const contact::Foundation f{rigid ? law.limit[0] : value_at(law.limit, x), law.rise, law.spring};
    const double deep = value_at(v, x), pressure = std::max(0., value_at(p, x));
    sum.add(w, deep, pressure, f, rigid && law.spring == 0);
  });
  return sum;
}

ContactIntegrals friction_integrals(const int order, const std::array<OfTriangle, 2> &slip,
                                    const std::array<OfTriangle, 2> &traction, const OfTriangle &limit)
{
  constexpr int parts = 8; // along each side
  const int n = nodes_of_triangle(order);
  const auto product = [&](const OfTriangle &x, const OfTriangle &y) { // the mean
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) sum += mean_product(order, i, j) * x[i] * y[j];
    return sum;
  };
  ContactIntegrals sum;
  for (int i = 0; i < parts; ++i)
    for (int j = 0; i + j < parts; ++j)
      for (int flipped = 0; flipped < 2 && i + j + flipped < parts; ++flipped) {
        const int at[3][2] = {{i + flipped, j + flipped}, {i + 1, j}, {i, j + 1}};
        Part part{};
        for (int v = 0; v < 3; ++v)
          part[v] = {1 - double(at[v][0] + at[v][1]) / parts, double(at[v][0]) / parts, double(at[v][1]) / parts};
        const OfTriangle x = on_part(order, slip[0], part), y = on_part(order, slip[1], part);
        OfTriangle size{};
        for (int v = 0; v < n; ++v) size[v] = std::hypot(x[v], y[v]);
        sum.energy += product(size, on_part(order, limit, part)) / (parts * parts);
      }
  sum.gap = std::max(0., sum.energy - product(slip[0], traction[0]) - product(slip[1], traction[1]));
  return sum;
}

} // namespace rpc::bound
