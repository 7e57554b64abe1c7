// SPDX-License-Identifier: BSD-3-Clause
#include "space_contact.hpp"

#include "facet_polynomials.hpp"
#include "rpc/contact/law/foundation.hpp"
#include "space_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

namespace space_contact_test
{
namespace
{

using namespace rpc;
using namespace rpc::bound;

constexpr double inf = std::numeric_limits<double>::infinity();

/// A square of 2 n^2 triangles whose nodes bear the forces of a pressure, a third of a triangle each.
template <class Pressure>
SpaceContact square(const int n, const double limit, const Pressure &pressure)
{
  SpaceContact c;
  c.modulus = 1000;
  c.normal = {0, 0, -1};
  c.force.assign((n + 1) * (n + 1), 0.);
  c.free.assign((n + 1) * (n + 1), 1);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) c.place.push_back({double(i), double(j)});
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int upper = 0; upper < 2; ++upper) {
        const int a = i * (n + 1) + j, b = a + n + 1;
        c.point.push_back(upper ? std::array<int, 6>{a, a + 1, b + 1} : std::array<int, 6>{a, b, b + 1});
        c.facet.push_back(static_cast<LO>(c.facet.size()));
        c.area.push_back(0.5);
        c.limit_of.push_back({limit, limit, limit});
        c.pressure.push_back({});
        for (int v = 0; v < 3; ++v) {
          const auto &x = c.place[c.point.back()[v]];
          c.pressure.back()[v] = pressure(x[0], x[1]);
          c.force[c.point.back()[v]] += c.pressure.back()[v] / 6;
        }
      }
  return c;
}

TEST(TriangleIntegrals, AreThoseOfHandAlgebra)
{
  // v = 1 - 2 (y + z) in barycentric x, y, z: positive where x > 1/2, a quarter of the area, with the mean 1/3 there.
  const ContactIntegrals even = contact_integrals(1, OfTriangle{1, -1, -1}, {2, 2, 2}, {{6, 6, 6}});
  EXPECT_NEAR(even.energy, 6. / 12, 1e-14);
  // (xi - p) v+ + p v-: 4/12, and 2 (v+ - v) with the mean of v -1/3.
  EXPECT_NEAR(even.gap, 4. / 12 + 2 * (1. / 12 + 1. / 3), 1e-14);
  const ContactIntegrals off = contact_integrals(1, OfTriangle{-1, -1, -2}, {2, 2, 2}, {{inf, inf, inf}});
  EXPECT_EQ(off.energy, 0);
  EXPECT_NEAR(off.gap, 8. / 3, 1e-14);
  EXPECT_EQ(contact_integrals(1, OfTriangle{0, 0, 0}, {2, 1, 2}, {{inf, inf, inf}}).gap, 0);
}

TEST(TriangleIntegrals, AreThoseOfManyPoints)
{
  const FacetRule rule = refined(3, facet_rule(3, 2), 200);
  EXPECT_NEAR(std::accumulate(rule.weight.begin(), rule.weight.end(), 0.), 1, 1e-12);
  for (const auto &[v, p] :
       {std::pair<OfTriangle, OfTriangle>{{0.3, -0.7, 0.2}, {1, 2, 0.5}}, {{-0.3, -0.2, 0.9}, {0, 3, 1}}}) {
    double yielding = 0, gap = 0;
    for (int q = 0; q < rule.size(); ++q) {
      double depth = 0, pressure = 0;
      for (int k = 0; k < 3; ++k) {
        depth += v[k] * rule.point[q][k];
        pressure += p[k] * rule.point[q][k];
      }
      yielding += rule.weight[q] * 4 * std::max(depth, 0.);
      gap += rule.weight[q] * ((4 - pressure) * std::max(depth, 0.) + pressure * std::max(-depth, 0.));
    }
    const ContactIntegrals exact = contact_integrals(1, v, p, {{4, 4, 4}});
    EXPECT_NEAR(exact.energy, yielding, 1e-5);
    EXPECT_NEAR(exact.gap, gap, 1e-5);
  }
}

TEST(TriangleIntegrals, OfLawsAreThoseOfManyPoints)
{
  // Open, elastic, yielding and hardening parts, and a yield limit that varies with dents.
  const FacetRule rule = refined(3, facet_rule(3, 2), 200);
  const OfTriangle v = {0.3, -0.4, 0.1}, p = {6, 0, 3};
  for (const TriangleLaw &law : {TriangleLaw{{4, 4, 4}, 0, 0.03}, TriangleLaw{{4, 5, 4.5}, 8, 0},
                                 TriangleLaw{{4, 5, 4.5}, 8, 0.03}, TriangleLaw{{inf, inf, inf}, 0, 0.03}}) {
    OfTriangle admissible = p;
    for (int k = 0; k < 3 && law.rise == 0; ++k) admissible[k] = std::min(p[k], law.limit[k]);
    double energy = 0, gap = 0;
    for (int q = 0; q < rule.size(); ++q) {
      double deep = 0, pressure = 0, limit = std::isinf(law.limit[0]) ? inf : 0;
      for (int k = 0; k < 3; ++k) {
        deep += v[k] * rule.point[q][k];
        pressure += admissible[k] * rule.point[q][k];
        if (!std::isinf(limit)) limit += law.limit[k] * rule.point[q][k];
      }
      // The foundation's springs give way by c times what they bear, dents take the rest.
      double bears = std::max(deep, 0.) / std::max(law.spring, 1e-300), stored = 0;
      if (bears > limit) {
        const double dent = (deep - law.spring * limit) / (1 + law.spring * law.rise);
        bears = limit + law.rise * dent;
        stored = limit * dent + law.rise * dent * dent / 2;
      }
      stored += law.spring * bears * bears / 2;
      const double beyond = law.rise > 0 ? std::max(0., pressure - limit) : 0;
      energy += rule.weight[q] * stored;
      gap += rule.weight[q] * (stored + law.spring * pressure * pressure / 2 - pressure * deep +
                               (beyond > 0 ? beyond * beyond / (2 * law.rise) : 0));
    }
    const ContactIntegrals exact = contact_integrals(1, v, admissible, law);
    EXPECT_NEAR(exact.energy, energy, 1e-4 * energy);
    EXPECT_NEAR(exact.gap, gap, 1e-4 * gap);
  }
}

TEST(TriangleIntegrals, OfFrictionAreNoSmallerThanThoseOfManyPointsAndNear)
{
  const FacetRule rule = refined(3, facet_rule(3, 2), 100);
  const std::array<OfTriangle, 2> e = {{{0.3, -0.4, 0.1}, {0.1, 0.2, -0.3}}}, q = {{{0.5, -1, 0}, {0, 0.4, -0.7}}};
  const OfTriangle s = {1, 2, 1.5};
  double energy = 0, work = 0;
  for (int at = 0; at < rule.size(); ++at) {
    double slip[2] = {0, 0}, limit = 0, along = 0;
    for (int k = 0; k < 2; ++k) {
      double traction = 0;
      for (int v = 0; v < 3; ++v) {
        slip[k] += e[k][v] * rule.point[at][v];
        traction += q[k][v] * rule.point[at][v];
      }
      along += slip[k] * traction;
    }
    for (int v = 0; v < 3; ++v) limit += s[v] * rule.point[at][v];
    energy += rule.weight[at] * limit * std::hypot(slip[0], slip[1]);
    work += rule.weight[at] * along;
  }
  const ContactIntegrals found = friction_integrals(1, e, q, s);
  EXPECT_GE(found.energy, energy * (1 - 1e-6));
  EXPECT_LT(found.energy, 1.02 * energy);
  EXPECT_NEAR(found.gap, found.energy - work, 1e-6 * energy);
}

TEST(FittedFriction, KeepsWithinItsLimitsAndToTheTractionThatSlips)
{
  SpaceContact c = square(6, inf, [](const double, const double) { return 7.; });
  c.friction.acts = true;
  c.friction.free = c.free;
  c.friction.limit_of.assign(c.facet.size(), {2, 2, 2});
  for (std::size_t i = 0; i < c.place.size(); ++i) { // slips on the left side, in directions that turn
    const double size = c.place[i][0] < 3 ? 2 : 1, angle = 0.1 * c.place[i][1];
    c.friction.traction.push_back({size * std::cos(angle), size * std::sin(angle)});
    for (int k = 0; k < 2; ++k) c.friction.force[k].push_back(c.force[i] / 7 * c.friction.traction[i][k]);
  }
  const std::vector<OfTriangle> none(c.facet.size(), OfTriangle{});
  const AlongSide q = fitted_friction(c, {none, none});
  double force = 0, wanted = 0;
  for (std::size_t e = 0; e < c.facet.size(); ++e)
    for (int v = 0; v < 3; ++v) {
      EXPECT_LE(std::hypot(q[0][e][v], q[1][e][v]), 2 * (1 + 1e-12));
      force += c.area[e] * q[0][e][v] / 3;
    }
  for (const double f : c.friction.force[0]) wanted += f;
  EXPECT_NEAR(force, wanted, 1e-2 * wanted);
  EXPECT_NEAR(std::hypot(q[0][0][0], q[1][0][0]), 2, 0.2);
}

TEST(FittedPressureInSpace, IsTheOneThatTheForcesComeFromWhereThatIsLinear)
{
  const SpaceContact c = square(6, inf, [](const double, const double) { return 7.; });
  for (const OfTriangle &p : fitted_pressure(c, std::vector<OfTriangle>(c.facet.size(), OfTriangle{})))
    for (int v = 0; v < 3; ++v) EXPECT_NEAR(p[v], 7, 1e-3);
}

/// The derivative of (13.4) by the coefficients of a pressure on square(), from sums over all hats and all points.
std::vector<OfTriangle> derivative_of_fit(const SpaceContact &c, const std::vector<OfTriangle> &p,
                                          const std::vector<OfTriangle> &v)
{
  const auto mean = [](const int i, const int j) { return i == j ? 1. / 6 : 1. / 12; };
  const std::size_t points = c.place.size();
  std::vector<double> off(points);
  for (std::size_t i = 0; i < points; ++i) off[i] = -c.force[i];
  for (std::size_t e = 0; e < p.size(); ++e)
    for (int a = 0; a < 3; ++a)
      for (int j = 0; j < 3; ++j) off[c.point[e][a]] += c.area[e] * mean(a, j) * p[e][j];
  const double side = c.place.back()[0];
  std::vector<double> weighted(off);
  for (int n = static_cast<int>(std::sqrt(points)) / 2; n >= 1; n /= 2)
    for (int k = 0; k <= n; ++k)
      for (int l = 0; l <= n; ++l) {
        const auto hat = [&](const std::array<double, 2> &x) {
          return std::max(0., 1 - std::abs(n * x[0] / side - k)) * std::max(0., 1 - std::abs(n * x[1] / side - l));
        };
        double sum = 0;
        for (std::size_t i = 0; i < points; ++i) sum += hat(c.place[i]) * off[i];
        for (std::size_t i = 0; i < points; ++i) weighted[i] += (n == 1 ? 100 : 1) * hat(c.place[i]) * sum;
      }
  std::vector<OfTriangle> g(p.size());
  for (std::size_t e = 0; e < p.size(); ++e)
    for (int j = 0; j < 3; ++j)
      for (int a = 0; a < 3; ++a)
        g[e][j] += c.area[e] * mean(a, j) *
                   ((weighted[c.point[e][a]] + 0.1 * c.area[e] * (p[e][a] - c.pressure[e][a])) / c.modulus - v[e][a]);
  return g;
}

TEST(FittedPressureInSpace, IsTheLeastOfItsFunctionBetweenItsBounds)
{
  for (const int n : {8, 10}) { // hats of 4, 2, 1 intervals, each of them those of the level before; of 5, 2, 1
    const double limit = 2;
    const SpaceContact c = square(n, limit, [&](const double x, const double y) {
      return std::clamp(3 * std::sin(9 * x / n) * std::cos(4 * y / n) + 1, 0., limit);
    });
    std::vector<OfTriangle> v;
    for (const auto &point : c.point) {
      v.emplace_back();
      for (int a = 0; a < 3; ++a) v.back()[a] = 1e-3 * std::sin(7 * c.place[point[a]][0] + 5 * c.place[point[a]][1]);
    }
    const std::vector<OfTriangle> p = fitted_pressure(c, v), g = derivative_of_fit(c, p, v),
                                  first = derivative_of_fit(c, c.pressure, v);
    double most = 0;
    for (const OfTriangle &of : first)
      for (const double x : of) most = std::max(most, std::abs(x));
    int low = 0, high = 0, between = 0;
    for (std::size_t e = 0; e < p.size(); ++e)
      for (int j = 0; j < 3; ++j) {
        (p[e][j] <= 0 ? low : (p[e][j] >= limit ? high : between)) += 1;
        EXPECT_GE(g[e][j], p[e][j] < limit ? -1e-10 * most : -inf);
        EXPECT_LE(g[e][j], p[e][j] > 0 ? 1e-10 * most : inf);
      }
    EXPECT_GT(std::min({low, high, between}), n);
  }
}

TEST(FittedPressureInSpace, KeepsToTheYieldStressAndNearToTheForces)
{
  const SpaceContact c =
      square(8, 5, [](const double x, const double y) { return std::clamp(9 - 1.1 * x - 0.6 * y, 0., 5.); });
  double force = 0, moment = 0;
  const auto p = fitted_pressure(c, std::vector<OfTriangle>(c.facet.size(), OfTriangle{}));
  for (std::size_t e = 0; e < p.size(); ++e)
    for (int i = 0; i < 3; ++i) {
      EXPECT_GE(p[e][i], 0);
      EXPECT_LE(p[e][i], 5);
      force += c.area[e] * p[e][i] / 3;
      for (int j = 0; j < 3; ++j) moment += c.area[e] * (i == j ? 2 : 1) / 12. * p[e][i] * c.place[c.point[e][j]][0];
    }
  const double wanted = std::accumulate(c.force.begin(), c.force.end(), 0.);
  double wanted_moment = 0;
  for (std::size_t i = 0; i < c.force.size(); ++i) wanted_moment += c.force[i] * c.place[i][0];
  EXPECT_NEAR(force, wanted, 2e-3 * wanted);
  EXPECT_NEAR(moment, wanted_moment, 5e-3 * wanted_moment);
}

/// The same square with a third of a triangle in the middle of each side, and nothing at the vertices.
template <class Pressure>
SpaceContact quadratic_square(const int n, const double limit, const Pressure &pressure)
{
  const int all = 2 * n + 1;
  SpaceContact c;
  c.order = 2;
  c.modulus = 1000;
  c.normal = {0, 0, -1};
  c.force.assign(all * all, 0.);
  c.free.assign(all * all, 1);
  for (int i = 0; i < all; ++i)
    for (int j = 0; j < all; ++j) c.place.push_back({i / 2., j / 2.});
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int upper = 0; upper < 2; ++upper) {
        const auto at = [&](const int x, const int y) { return (2 * i + x) * all + 2 * j + y; };
        c.point.push_back(upper ? std::array<int, 6>{at(0, 0), at(0, 2), at(2, 2), at(0, 1), at(1, 2), at(1, 1)}
                                : std::array<int, 6>{at(0, 0), at(2, 0), at(2, 2), at(1, 0), at(2, 1), at(1, 1)});
        c.facet.push_back(static_cast<LO>(c.facet.size()));
        c.area.push_back(0.5);
        c.limit_of.push_back({limit, limit, limit, limit, limit, limit});
        OfTriangle p{};
        for (int a = 3; a < 6; ++a) {
          const int point = c.point.back()[a];
          p[a] = pressure(c.place[point][0], c.place[point][1]);
          c.force[point] += p[a] / 6;
        }
        c.pressure.push_back(through_middles(p));
      }
  return c;
}

TEST(QuadraticTriangle, HasCoefficientsOfItsNodesAndMeansOfProducts)
{
  const FacetRule rule = facet_rule(3, 3);
  const OfTriangle at_nodes = {1, -2, 3, 0.5, 4, -1};
  const std::array<Barycentric, 6> nodes{
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}}};
  for (int a = 0; a < 6; ++a) EXPECT_NEAR(value_of(2, bernstein_of(2, at_nodes), nodes[a]), at_nodes[a], 1e-14);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      OfTriangle x{}, y{};
      x[i] = y[j] = 1;
      double mean = 0;
      for (int q = 0; q < rule.size(); ++q)
        mean += rule.weight[q] * value_of(2, x, rule.point[q]) * value_of(2, y, rule.point[q]);
      EXPECT_NEAR(mean_product(2, i, j), mean, 1e-14);
    }
  const OfTriangle linear = through_middles({0, 0, 0, 1.5, 2.5, 2}); // 1 + y + 2 z
  EXPECT_NEAR(linear[0], 1, 1e-14);
  EXPECT_NEAR(linear[1], 2, 1e-14);
  EXPECT_NEAR(linear[2], 3, 1e-14);
}

TEST(QuadraticTriangle, HasIntegralsNoSmallerThanThoseOfManyPointsAndNear)
{
  // Open, elastic, yielding and hardening parts that curves divide, and a yield limit that varies with dents.
  const FacetRule rule = refined(3, facet_rule(3, 3), 100);
  const OfTriangle v = {0.3, -0.4, 0.1, 0.2, -0.3, 0.25}, p = {6, 0, 3, 5, 1, 4}, even = {4, 4, 4, 4, 4, 4},
                   dented = {4, 5, 4.5, 4.2, 5, 4.1};
  for (const TriangleLaw &law : {TriangleLaw{even, 0, 0}, TriangleLaw{even, 0, 0.03}, TriangleLaw{dented, 8, 0},
                                 TriangleLaw{dented, 8, 0.03}, TriangleLaw{{inf, inf, inf, inf, inf, inf}, 0, 0.03}}) {
    const bool rigid = std::isinf(law.limit[0]);
    OfTriangle admissible = p;
    for (int k = 0; k < 6 && law.rise == 0; ++k) admissible[k] = std::min(p[k], law.limit[k]);
    double energy = 0, gap = 0;
    for (int q = 0; q < rule.size(); ++q) {
      const contact::Foundation f{rigid ? inf : value_of(2, law.limit, rule.point[q]), law.rise, law.spring};
      const double deep = value_of(2, v, rule.point[q]), pressure = value_of(2, admissible, rule.point[q]);
      energy += rule.weight[q] * contact::foundation_energy(deep, f);
      gap += rule.weight[q] *
             (contact::foundation_energy(deep, f) + contact::conjugate_energy(pressure, f) - pressure * deep);
    }
    const ContactIntegrals found = contact_integrals(2, v, admissible, law);
    EXPECT_GE(found.energy, energy * (1 - 1e-6));
    EXPECT_GE(found.gap, gap * (1 - 1e-6));
    EXPECT_LT(found.energy, energy * 1.003);
    EXPECT_LT(found.gap, gap + 0.003 * energy);
  }
  // v = 1 - 2 (y + z): what a plane of order 1 has.
  const OfTriangle flat = bernstein_of(2, {1, -1, -1, 0, -1, 0}), two = {2, 2, 2, 2, 2, 2}, six = {6, 6, 6, 6, 6, 6};
  EXPECT_NEAR(contact_integrals(2, flat, two, {six}).gap, 4. / 12 + 2 * (1. / 12 + 1. / 3), 2e-3);
  const OfTriangle off = {-1, -1, -2, -1, -1, 0};
  const ContactIntegrals rigid = contact_integrals(2, off, two, {{inf, inf, inf, inf, inf, inf}});
  EXPECT_EQ(rigid.energy, 0);
  EXPECT_NEAR(rigid.gap, 2 * 6. / 6, 1e-14);
}

TEST(QuadraticTriangle, CountsTheLargestLimitInEnergiesAndTheLeastInConjugates)
{
  // v = 0.3 all over, so that psi is a polynomial, and p - xi has a root where xi varies much.
  const OfTriangle v = {0.3, 0.3, 0.3, 0.3, 0.3, 0.3}, p = {9, 0, 3, 8, 1, 2}, limit = {1, 9, 5, 2, 7, 4};
  const TriangleLaw law{limit, 0.5, 0};
  const double mean = (1 + 9 + 5 + 2 + 7 + 4) / 6., psi = 0.3 * mean + 0.5 * 0.3 * 0.3 / 2;
  const FacetRule rule = refined(3, facet_rule(3, 3), 100);
  double rest = 0;
  for (int q = 0; q < rule.size(); ++q) {
    const double here = value_of(2, p, rule.point[q]);
    rest += rule.weight[q] *
            (contact::conjugate_energy(here, {value_of(2, limit, rule.point[q]), law.rise, law.spring}) - 0.3 * here);
  }
  const ContactIntegrals found = contact_integrals(2, v, p, law);
  EXPECT_GT(found.energy, psi * (1 + 1e-6));
  EXPECT_LT(found.energy, psi * 1.03);
  EXPECT_GT(found.gap - found.energy, rest * (1 + 1e-6));
  EXPECT_LT(found.gap - found.energy, rest * 1.03);
}

TEST(QuadraticTriangle, HandsThePressureAndTheFrictionOfItsDegreeToTheBody)
{
  SpaceInput in;
  in.reference.degree = 2;
  in.tables = facet_tables(2);
  SpaceBoundary boundary;
  SpaceContact c = quadratic_square(1, inf, [](const double, const double) { return 0.; });
  c.friction.acts = true;
  c.axis = {{{1, 0, 0}, {0, -1, 0}}};
  boundary.tractions.load = DeviceView<double ***>("load", 2, FacetPolynomials::count(3, 3), 3);
  boundary.sides.push_back(c);
  const OfTriangle p = {1, 4, 2, 7, 3, 5}, q = {0.3, -1, 0.5, 2, 0.1, -0.7}, r = {1, 0.2, 0.4, -0.3, 1.5, 2};
  const BoundaryTractions all = with_contact(in, boundary, {{{p, p}, {{{q, q}, {r, r}}}}});
  const FacetPolynomials polynomials(3, 3);
  for (const Barycentric &at : facet_rule(3, 3).point) {
    const double wanted[3] = {-value_of(2, q, at), value_of(2, r, at), value_of(2, p, at)};
    for (int i = 0; i < 3; ++i) {
      double traction = 0;
      for (int j = 0; j < polynomials.size(); ++j) traction += all.load(1, j, i) * polynomials(j, at) / c.area[1];
      EXPECT_NEAR(traction, wanted[i], 1e-12);
    }
  }
}

TEST(QuadraticTriangle, HasFrictionNoSmallerThanThatOfManyPointsAndNear)
{
  const FacetRule rule = refined(3, facet_rule(3, 3), 60);
  const std::array<OfTriangle, 2> e = {{{0.3, -0.4, 0.1, 0.2, -0.1, 0.5}, {0.1, 0.2, -0.3, 0, 0.4, -0.2}}},
                                  q = {{{0.5, -1, 0, 0.2, 0.3, -0.4}, {0, 0.4, -0.7, 1, 0, 0.5}}};
  const OfTriangle s = {1, 2, 1.5, 1.2, 1.3, 2};
  double energy = 0, work = 0;
  for (int at = 0; at < rule.size(); ++at) {
    const auto here = [&](const OfTriangle &of) { return value_of(2, of, rule.point[at]); };
    energy += rule.weight[at] * here(s) * std::hypot(here(e[0]), here(e[1]));
    work += rule.weight[at] * (here(e[0]) * here(q[0]) + here(e[1]) * here(q[1]));
  }
  const ContactIntegrals found = friction_integrals(2, e, q, s);
  EXPECT_GE(found.energy, energy * (1 - 1e-6));
  EXPECT_LT(found.energy, 1.03 * energy);
  EXPECT_NEAR(found.gap, found.energy - work, 1e-6 * energy);
}

TEST(FittedPressureInSpace, OfOrder2KeepsToTheYieldStressAndToForcesThatVerticesHaveNoPartOf)
{
  const std::vector<OfTriangle> none(2 * 36, OfTriangle{});
  for (const OfTriangle &p :
       fitted_pressure(quadratic_square(6, inf, [](const double, const double) { return 7.; }), none))
    for (const double x : p) EXPECT_NEAR(x, 7, 1e-3);
  const SpaceContact c =
      quadratic_square(6, 5, [](const double x, const double y) { return std::clamp(9 - 1.1 * x - 0.6 * y, 0., 5.); });
  double force = 0;
  const auto p = fitted_pressure(c, none);
  for (std::size_t e = 0; e < p.size(); ++e)
    for (const double x : p[e]) {
      EXPECT_GE(x, 0);
      EXPECT_LE(x, 5);
      force += c.area[e] * x / 6;
    }
  const double wanted = std::accumulate(c.force.begin(), c.force.end(), 0.);
  EXPECT_NEAR(force, wanted, 2e-3 * wanted);
}

TEST(FacetPolynomials, AreOrthogonalAndExpandLinearFunctions)
{
  const FacetPolynomials polynomials(3, 3);
  ASSERT_EQ(polynomials.size(), 10);
  const FacetRule rule = facet_rule(3, 5);
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) {
      double mean = 0;
      for (int q = 0; q < rule.size(); ++q)
        mean += rule.weight[q] * polynomials(i, rule.point[q]) * polynomials(j, rule.point[q]);
      EXPECT_NEAR(mean, i == j ? 1 : 0, 1e-12);
    }
}

} // namespace
} // namespace space_contact_test
