// SPDX-License-Identifier: BSD-3-Clause
#include "contact_pressure.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace contact_pressure_test
{
namespace
{

using namespace rpc;
using namespace rpc::bound;

constexpr double inf = std::numeric_limits<double>::infinity();

/// A side of n facets of length 1 whose nodes bear the forces of a pressure, by trapezoids or Simpson's rule.
template <class Pressure>
ContactFacets side(const int order, const int n, const double limit, const Pressure &pressure)
{
  ContactFacets c;
  c.order = order;
  c.modulus = 1000;
  const int points = order * n + 1;
  c.force.assign(points, 0.);
  for (int i = 0; i < points; ++i) {
    c.place.push_back(static_cast<double>(i) / order);
    c.free.push_back(1);
  }
  for (int e = 0; e < n; ++e) {
    c.facet.push_back(e);
    c.length.push_back(1);
    c.limit_of.push_back({limit, limit, limit});
    c.normal.push_back({0, -1});
    c.point.push_back(order == 1 ? std::array<int, 3>{e, e + 1, -1} : std::array<int, 3>{2 * e, 2 * e + 2, 2 * e + 1});
    const double weight[3] = {order == 1 ? 1. / 2 : 1. / 6, order == 1 ? 1. / 2 : 1. / 6, 4. / 6};
    c.pressure.push_back({});
    for (int a = 0; a <= order; ++a) {
      c.pressure[e][a] = pressure(c.place[c.point[e][a]]);
      c.force[c.point[e][a]] += weight[a] * c.pressure[e][a];
    }
  }
  return c;
}

TEST(ContactIntegrals, AreThoseOfHandAlgebra)
{
  // v = 2 x - 1, p = 1, xi = 3: xi v+ has 3/4, (xi - p) v+ + p v- has 2/4 + 1/4.
  const ContactIntegrals linear = contact_integrals(1, {-1, 1, 0}, {1, 1, 0}, {{3, 3, 3}});
  EXPECT_NEAR(linear.energy, 0.75, 1e-14);
  EXPECT_NEAR(linear.gap, 0.75, 1e-14);
  // v = 4 x (1 - x) - 3/4 is positive between 1/4 and 3/4, p = x (1 - x) has the Bernstein coefficients 0, 1/2, 0.
  // The integral of v+ is 1/12 and that of p v+ 19/960 ... by exact integration of polynomials.
  const auto power = [](const double a, const double b, const int n) {
    return (std::pow(b, n + 1) - std::pow(a, n + 1)) / (n + 1);
  };
  const auto v = [&](const double a, const double b) {
    return 4 * power(a, b, 1) - 4 * power(a, b, 2) - 0.75 * power(a, b, 0);
  };
  const auto pv = [&](const double a, const double b) {
    return -0.75 * power(a, b, 1) + 4.75 * power(a, b, 2) - 8 * power(a, b, 3) + 4 * power(a, b, 4);
  };
  const ContactIntegrals quadratic = contact_integrals(2, {-0.75, -0.75, 0.25}, {0, 0.5, 0}, {{3, 3, 3}});
  EXPECT_NEAR(quadratic.energy, 3 * v(0.25, 0.75), 1e-14);
  EXPECT_NEAR(quadratic.gap, 3 * v(0.25, 0.75) - pv(0, 1), 1e-14);
  // Rigid: p v- alone.
  const ContactIntegrals rigid = contact_integrals(2, {-1, -1, -1}, {2, 2, 2}, {{inf, inf, inf}});
  EXPECT_EQ(rigid.energy, 0);
  EXPECT_NEAR(rigid.gap, 2, 1e-14);
}

/// The midpoint rule with many points.
template <class Function>
double midpoints(const Function &f)
{
  constexpr int n = 200000;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += f((i + 0.5) / n) / n;
  return sum;
}

TEST(ContactIntegrals, AreThoseOfTheLawWithSpringsAndHardening)
{
  // v from -0.3 to 0.9, p from 1 to 4, xi from 1.5 to 2.5, H = 4, c = 0.1: open, elastic and yielding, p below and above xi.
  const double H = 4, c = 0.1;
  const auto v = [](const double x) { return -0.3 + 1.2 * x; };
  const auto p = [](const double x) { return 1 + 3 * x; };
  const auto xi = [](const double x) { return 1.5 + x; };
  const auto psi = [&](const double x) {
    const double beyond = v(x) - c * xi(x);
    if (v(x) < 0) return 0.;
    return beyond < 0 ? v(x) * v(x) / (2 * c)
                      : xi(x) * (v(x) - c * xi(x) / 2) + H * beyond * beyond / (2 * (1 + c * H));
  };
  const auto conjugate = [&](const double x) {
    const double beyond = std::max(0., p(x) - xi(x));
    return c * p(x) * p(x) / 2 + beyond * beyond / (2 * H);
  };
  const NormalLaw law{{1.5, 2.5, 0}, H, c};
  const ContactIntegrals linear = contact_integrals(1, {-0.3, 0.9, 0}, {1, 4, 0}, law);
  EXPECT_NEAR(linear.energy, midpoints(psi), 1e-9);
  EXPECT_NEAR(linear.gap, midpoints([&](const double x) { return psi(x) + conjugate(x) - p(x) * v(x); }), 1e-9);
  const NormalLaw quadratic_law{{1.5, 2, 2.5}, H, c};
  const ContactIntegrals quadratic = contact_integrals(2, {-0.3, 0.9, 0.3}, {1, 2.5, 4}, quadratic_law);
  EXPECT_NEAR(quadratic.energy, linear.energy, 1e-14);
  EXPECT_NEAR(quadratic.gap, linear.gap, 1e-14);
}

TEST(ContactIntegrals, OfRevolutionAreNoSmallerThanThoseOfManyPointsAndNear)
{
  // v from -0.3 to 0.9, xi = 2, H = 4, c = 0.1, all with 2 pi r, from the axis on or off it: open, elastic and yielding.
  const double H = 4, c = 0.1, xi = 2;
  for (const auto &[first, last] : {std::array<double, 2>{0, 6}, {6, 0}, {1.5, 6}, {2, 1}})
    for (const int order : {1, 2})
      for (const double rise : {0., H}) {
        SCOPED_TRACE(testing::Message() << first << " to " << last << ", order " << order << ", H " << rise);
        const double middle = (first + last) / 2, most = rise > 0 ? 3.5 : xi;
        const OfFacet circle = order == 1 ? OfFacet{first, last, 0} : OfFacet{first, middle, last},
                      traction = order == 1 ? OfFacet{0.3 * first, most * last, 0}
                                            : OfFacet{0.3 * first, 0.5 * most * middle, most * last};
        const auto between = [&](const OfFacet &b, const double x) {
          return order == 1 ? b[0] + x * (b[1] - b[0])
                            : b[0] * (1 - x) * (1 - x) + 2 * b[1] * x * (1 - x) + b[2] * x * x;
        };
        const auto at = [&](const double x, const bool energy) {
          const double around = between(circle, x), v = -0.3 + 1.2 * x, p = between(traction, x) / around,
                       beyond = v - c * xi, above = std::max(0., p - xi);
          const double psi = v < 0        ? 0
                             : beyond < 0 ? v * v / (2 * c)
                                          : xi * (v - c * xi / 2) + rise * beyond * beyond / (2 * (1 + c * rise));
          const double conjugate = c * p * p / 2 + (rise > 0 ? above * above / (2 * rise) : 0);
          return around * (energy ? psi : psi + conjugate - p * v);
        };
        const ContactIntegrals found =
            contact_integrals(order, {-0.3, 0.9, 0.3}, traction, {{xi, xi, xi}, rise, c, circle});
        EXPECT_NEAR(found.energy, midpoints([&](const double x) { return at(x, true); }), 1e-8);
        const double gap = midpoints([&](const double x) { return at(x, false); });
        const bool exact = first == 0 || last == 0;
        EXPECT_GT(found.gap, gap + (exact ? -1e-8 : 1e-7));
        EXPECT_LT(found.gap, gap + (exact ? 1e-8 : 0.05 * gap));
      }
}

TEST(FrictionIntegrals, AreThoseOfHandAlgebra)
{
  // e = 2 x - 1, q = 1, s = 2: s |e| has 1, q e has 0.
  const ContactIntegrals sum = friction_integrals(1, {-1, 1, 0}, {1, 1, 0}, {2, 2, 0});
  EXPECT_NEAR(sum.energy, 1, 1e-14);
  EXPECT_NEAR(sum.gap, 1, 1e-14);
  // q = s along the slip: nothing is left.
  EXPECT_NEAR(friction_integrals(2, {0, 1, 0.5}, {2, 2, 2}, {2, 2, 2}).gap, 0, 1e-15);
}

TEST(FittedPressure, ExceedsTheYieldLimitWhereTheFoundationHardens)
{
  for (const int order : {1, 2}) {
    ContactFacets c = side(order, 12, 5, [](const double) { return 7.; });
    c.rise = 400;
    const double depth = (7. - 5) / c.rise; // that the law has the pressure at
    const auto p = fitted_pressure(c, std::vector<OfFacet>(12, OfFacet{depth, depth, depth}));
    for (const OfFacet &facet : p)
      for (int i = 0; i <= order; ++i) EXPECT_NEAR(facet[i], 7, 1e-6);
  }
}

TEST(FittedFriction, KeepsToItsLimitsOnBothSides)
{
  for (const int order : {1, 2}) {
    ContactFacets c = side(order, 12, 5, [](const double) { return 0.; });
    c.friction.acts = true;
    c.friction.free = c.free;
    const double q[] = {3, -3};
    for (int e = 0; e < 12; ++e) {
      const double here = q[e < 6 ? 0 : 1];
      c.friction.limit_of.push_back({2, 2, 2});
      c.friction.traction.push_back({here, here, here});
    }
    c.friction.force.assign(c.force.size(), 0.);
    for (std::size_t i = 0; i < c.force.size(); ++i) c.friction.force[i] = (c.place[i] < 6 ? 3. : -3.) / order;
    const auto fitted = fitted_friction(c, std::vector<OfFacet>(12, OfFacet{}));
    for (int e = 0; e < 12; ++e)
      for (int i = 0; i <= order; ++i) EXPECT_LE(std::abs(fitted[e][i]), 2);
    EXPECT_GT(fitted[1][0], 1.5);
    EXPECT_LT(fitted[10][0], -1.5);
  }
}

TEST(FittedPressure, IsTheOneThatTheForcesComeFromWhereThatIsAPolynomial)
{
  for (const int order : {1, 2}) {
    const ContactFacets c = side(order, 12, inf, [](const double) { return 7.; });
    const auto p = fitted_pressure(c, std::vector<OfFacet>(12, OfFacet{}));
    for (const OfFacet &facet : p)
      for (int i = 0; i <= order; ++i) EXPECT_NEAR(facet[i], 7, 1e-6);
  }
}

TEST(FittedPressure, KeepsToTheYieldStressAndNearToTheForces)
{
  for (const int order : {1, 2}) {
    const auto clamped = [](const double x) { return std::min(5., std::max(0., 9 - 1.7 * x)); };
    const ContactFacets c = side(order, 12, 5, clamped);
    const auto p = fitted_pressure(c, std::vector<OfFacet>(12, OfFacet{}));
    double force = 0, wanted = 0;
    for (const double f : c.force) wanted += f;
    for (const OfFacet &facet : p)
      for (int i = 0; i <= order; ++i) {
        EXPECT_GE(facet[i], 0);
        EXPECT_LE(facet[i], 5);
        force += facet[i] / (order + 1);
      }
    EXPECT_NEAR(force, wanted, 2e-3 * wanted);
  }
}

TEST(FittedPressure, DoesNotPressWhereTheBodyIsOffTheFoundation)
{
  const ContactFacets c = side(1, 8, inf, [](const double x) { return x < 4 ? 1. : 0.; });
  std::vector<OfFacet> v(8, OfFacet{});
  for (int e = 4; e < 8; ++e) v[e] = {-0.1 * (e - 4), -0.1 * (e - 3), 0};
  const auto p = fitted_pressure(c, v);
  for (int e = 5; e < 8; ++e)
    for (int i = 0; i < 2; ++i) EXPECT_EQ(p[e][i], 0);
}

TEST(LoweredMiddle, LeavesNoPenetrationBetweenTheNodes)
{
  const OfFacet v = {-0.1, 0, 0};
  const OfFacet lowered = {v[0], v[1], lowered_middle(v)};
  for (const double coefficient : bernstein(2, lowered)) EXPECT_LE(coefficient, 1e-16);
  EXPECT_EQ(lowered_middle({-1, -1, -2}), -2);
}

} // namespace
} // namespace contact_pressure_test
