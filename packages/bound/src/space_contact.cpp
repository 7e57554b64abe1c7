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

using Corner = std::array<double, 3>; // barycentric

double value_at(const OfTriangle &of, const Corner &x)
{
  return of[0] * x[0] + of[1] * x[1] + of[2] * x[2];
}

/// The part of a convex polygon in a triangle where sign * v >= 0.
std::vector<Corner> part_of(const std::vector<Corner> &polygon, const OfTriangle &v, const double sign)
{
  std::vector<Corner> corners;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Corner &here = polygon[k], &next = polygon[(k + 1) % polygon.size()];
    const double a = sign * value_at(v, here), b = sign * value_at(v, next);
    if (a >= 0) corners.push_back(here);
    if ((a < 0) == (b < 0) || a == 0 || b == 0) continue;
    const double s = a / (a - b);
    Corner x{};
    for (int i = 0; i < 3; ++i) x[i] = (1 - s) * here[i] + s * next[i];
    corners.push_back(x);
  }
  return corners;
}

/// Parts of a triangle within which none of some linear functions changes its sign.
class PartsOfTriangle
{
public:
  void end_at_roots_of(const OfTriangle &v)
  {
    if (*std::min_element(v.begin(), v.end()) >= 0 || *std::max_element(v.begin(), v.end()) <= 0) return;
    std::vector<std::vector<Corner>> cut;
    for (const auto &polygon : parts_)
      for (const double sign : {1., -1.}) {
        cut.push_back(part_of(polygon, v, sign));
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
        const Corner *const t[3] = {&corners[0], &corners[k - 1], &corners[k]};
        const auto side = [&](const int v, const int i) { return (*t[v])[i] - (*t[0])[i]; };
        const double size = std::abs(side(1, 1) * side(2, 2) - side(1, 2) * side(2, 1));
        for (int m = 0; m < 3; ++m) { // the middles of the sides
          Corner x{};
          for (int i = 0; i < 3; ++i) x[i] = ((*t[m])[i] + (*t[(m + 1) % 3])[i]) / 2;
          f(x, size / 3);
        }
      }
  }

private:
  std::vector<std::vector<Corner>> parts_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};

OfTriangle plus(const OfTriangle &x, const double a, const OfTriangle &y)
{
  return {x[0] + a * y[0], x[1] + a * y[1], x[2] + a * y[2]};
}

} // namespace

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
    for (int i = 0; i < 3; ++i)
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
    for (int a = 0; a < 3; ++a) {
      // Limits are discs. Of one the box has the traction of the node in it and touches the circle with its corners: along a traction that has
      // reached the limit it is a line.
      const double s = f.limit_of[e][a];
      std::array<double, 2> q = f.traction[c.point[e][a]], toward{1, 0};
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

ContactIntegrals contact_integrals(const OfTriangle &v, const OfTriangle &p, const TriangleLaw &law)
{
  const bool rigid = contact::is_rigid(*std::max_element(law.limit.begin(), law.limit.end()));
  PartsOfTriangle parts; // within which the integrands are polynomials of degree 2
  parts.end_at_roots_of(v);
  if (!rigid) {
    parts.end_at_roots_of(plus(v, -law.spring, law.limit));
    parts.end_at_roots_of(plus(p, -1, law.limit));
  }
  ContactIntegrals sum;
  parts.integrate([&](const Corner &x, const double w) {
    const contact::Foundation f{rigid ? law.limit[0] : value_at(law.limit, x), law.rise, law.spring};
    const double deep = value_at(v, x), pressure = std::max(0., value_at(p, x));
    sum.add(w, deep, pressure, f, rigid && law.spring == 0);
  });
  return sum;
}

ContactIntegrals friction_integrals(const std::array<OfTriangle, 2> &slip, const std::array<OfTriangle, 2> &traction,
                                    const OfTriangle &limit)
{
  constexpr int parts = 8; // along each side
  const auto length_at = [&](const Corner &x) { return std::hypot(value_at(slip[0], x), value_at(slip[1], x)); };
  ContactIntegrals sum;
  const auto product = [](const OfTriangle &x, const OfTriangle &y) { // the mean
    return ((x[0] + x[1] + x[2]) * (y[0] + y[1] + y[2]) + x[0] * y[0] + x[1] * y[1] + x[2] * y[2]) / 12;
  };
  for (int i = 0; i < parts; ++i)
    for (int j = 0; i + j < parts; ++j)
      for (int flipped = 0; flipped < 2 && i + j + flipped < parts; ++flipped) {
        const int at[3][2] = {{i + flipped, j + flipped}, {i + 1, j}, {i, j + 1}};
        OfTriangle size{}, s{};
        for (int v = 0; v < 3; ++v) {
          const Corner x{1 - double(at[v][0] + at[v][1]) / parts, double(at[v][0]) / parts, double(at[v][1]) / parts};
          size[v] = length_at(x);
          s[v] = value_at(limit, x);
        }
        sum.energy += product(size, s) / (parts * parts);
      }
  sum.gap = std::max(0., sum.energy - product(slip[0], traction[0]) - product(slip[1], traction[1]));
  return sum;
}

} // namespace rpc::bound
