#include "rpc/contact/law/interior.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace
{

using namespace rpc::contact;

constexpr double inf = std::numeric_limits<double>::infinity();
const std::vector<Foundation> laws = {{3, 0, 0},       {inf, 0, 0},     {3, 9, 0},
                                      {3, 0, 1. / 80}, {3, 9, 1. / 80}, {inf, 0, 1. / 80}};

/// v of a point on the path.
double penetration(const InteriorPoint &x, const Foundation &f)
{
  return f.compliance * x.pressure + x.dent - x.opening;
}

TEST(InteriorPath, JoinsThePathOnTheGivenLine)
{
  const double kappa = 20;
  for (const Foundation &f : laws) {
    for (const double mu : {1., 1e-3}) {
      for (const double z : {-30., -1., 0., 2., 50.}) {
        const InteriorPoint x = on_path(z, mu, kappa, f);
        EXPECT_GT(x.pressure, 0);
        EXPECT_NEAR(x.pressure * x.opening, mu, 1e-9 * mu);
        EXPECT_NEAR(x.pressure + kappa * penetration(x, f), z, 1e-9 * (1 + std::abs(z) + kappa * x.opening));
        if (!can_yield(f)) continue;
        EXPECT_GT(spare_strength(x, f), 0);
        EXPECT_NEAR(spare_strength(x, f) * x.dent, mu, 1e-6 * mu);
      }
    }
  }
}

TEST(InteriorPath, StepsOfOnePointOnASpringTendToTheLaw)
{
  // p = k (v0 - v), a point that a spring presses on the foundation from v0; its solution obeys the law.
  const double k = 15;
  for (const Foundation &f : laws) {
    for (const double v0 : {-0.4, 0.1, 1.}) {
      double v = v0;
      InteriorTarget target{0.1, 0.1};
      InteriorPoint x = on_path(1, mu, 10, f);
      State state = State::open;
      for (int step = 0; step < 60; ++step) {
        const double D = linear_compliance(x, f), e = linear_excess(x, v, mu, f);
        const double dv = (k * (v0 - v) - x.pressure - e / D) / (k + 1 / D);
        const InteriorPoint change = linear_change(x, (dv + e) / D, mu, f);
        const double t = std::min(1., 0.9 * longest_step(x, change, f));
        const InteriorPoint before = x;
        x = {x.pressure + t * change.pressure, x.opening + t * change.opening, x.dent + t * change.dent};
        v += t * dv;
        mu = 0.1 * complementarity(x, f);
        state = tends_to(before, x, f);
        if (complementarity(x, f) < 1e-12) break;
      }
      EXPECT_NEAR(x.pressure, k * (v0 - v), 1e-8);
      EXPECT_NEAR(x.pressure, pressure(v, x.pressure, 1, f), 1e-6);
      const State expected = v0 < 0                                      ? State::open
                             : k * v0 > f.yield * (1 + k * f.compliance) ? State::yielding
                                                                         : State::closed;
      EXPECT_EQ(state, expected) << f.yield << " " << f.hardening << " " << f.compliance << " " << v0;
    }
  }
}

TEST(InteriorPath, StepsEndAtTheNearestCorner)
{
  const Foundation plastic{3, 0, 0}, hardens{3, 9, 0};
  const InteriorPoint x{2, 0.5, 0.25};
  EXPECT_DOUBLE_EQ(longest_step(x, {-4, 1, 1}, plastic), 0.5);    // p
  EXPECT_DOUBLE_EQ(longest_step(x, {0.1, -2, 1}, plastic), 0.25); // s
  EXPECT_DOUBLE_EQ(longest_step(x, {0.1, 1, -1}, plastic), 0.25); // d
  EXPECT_DOUBLE_EQ(longest_step(x, {2, 1, 1}, plastic), 0.5);     // q = 1
  EXPECT_GT(longest_step(x, {2, 1, 1}, hardens), 1e100);          // q grows
}

} // namespace
