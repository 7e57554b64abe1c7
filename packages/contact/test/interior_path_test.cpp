// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/law/interior.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace interior_path_test
{
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

/// A point that a spring presses on the foundation: p = k (v0 - v).
struct PointOnASpring {
  double k, v0, v;
  Foundation law;
  InteriorPoint at;

  InteriorPoint change(const InteriorTarget &target, double &dv) const
  {
    const double D = linear_compliance(at, law), e = linear_excess(at, v, target, law);
    dv = (k * (v0 - v) - at.pressure - e / D) / (k + 1 / D);
    return linear_change(at, (dv + e) / D, target, law);
  }
  double step_to(const InteriorTarget &target)
  {
    double dv;
    const InteriorPoint by = change(target, dv);
    const double t = std::min(1., 0.9 * longest_step(at, by, law));
    at = {at.pressure + t * by.pressure, at.opening + t * by.opening, at.dent + t * by.dent};
    v += t * dv;
    return t;
  }
  /// For mu = 0 and then for what that leaves out, as InteriorPath does.
  double corrected_step()
  {
    double dv;
    const InteriorPoint by = change({0, 0}, dv);
    const double t = std::min(1., 0.9 * longest_step(at, by, law));
    return step_to(corrected_target(by, (1 - t) * (1 - t) * mean_product(), t, law));
  }
  double mean_product() const { return complementarity(at, law) / (can_yield(law) ? 2 : 1); }
};

TEST(InteriorPath, StepsOfOnePointOnASpringTendToTheLaw)
{
  int plain = 0, corrected = 0; // steps of all cases
  for (const bool corrects : {false, true}) {
    for (const Foundation &f : laws) {
      for (const double v0 : {-0.4, 0.1, 1.}) {
        PointOnASpring x{15, v0, v0, f, on_path(1, 0.1, 10, f)};
        State state = State::open;
        for (int step = 0; step < 60 && complementarity(x.at, f) > 1e-12; ++step) {
          const InteriorPoint before = x.at;
          const double mu = (step == 0 ? 1 : 0.1) * complementarity(x.at, f);
          corrects ? x.corrected_step() : x.step_to({mu, mu});
          state = tends_to(before, x.at, f);
          ++(corrects ? corrected : plain);
        }
        EXPECT_NEAR(x.at.pressure, x.k * (v0 - x.v), 1e-8);
        EXPECT_NEAR(x.at.pressure, pressure(x.v, x.at.pressure, 1, f), 1e-6);
        const State expected = v0 < 0                                          ? State::open
                               : x.k * v0 > f.yield * (1 + x.k * f.compliance) ? State::yielding
                                                                               : State::closed;
        EXPECT_EQ(state, expected) << f.yield << " " << f.hardening << " " << f.compliance << " " << v0;
      }
    }
  }
  EXPECT_LT(corrected, 0.8 * plain);
}

TEST(InteriorPath, TargetsTakeOffTheProductsThatLinearStepsLeaveOut)
{
  const double mu = 0.2;
  const InteriorPoint x{2, 0.5, 0.25};
  for (const Foundation &f : laws) {
    const InteriorPoint predicted = linear_change(x, -0.3, {0, 0}, f);
    const InteriorTarget target = corrected_target(predicted, mu, 1, f);
    const InteriorPoint y = linear_change(x, -0.3, target, f);
    const double ps = x.pressure * x.opening + x.opening * y.pressure + x.pressure * y.opening;
    EXPECT_NEAR(ps + predicted.pressure * predicted.opening, mu, 1e-14);
    if (!can_yield(f)) continue;
    const double q = spare_strength(x, f), dq = f.hardening * y.dent - y.pressure;
    const double predicted_dq = f.hardening * predicted.dent - predicted.pressure;
    EXPECT_NEAR(q * x.dent + x.dent * dq + q * y.dent + predicted_dq * predicted.dent, mu, 1e-14);
  }
}

TEST(InteriorPath, ExcessIsLinearInTheTarget)
{
  const InteriorPoint x{2, 0.5, 0.25};
  const InteriorTarget target{0.7, 0.6}, next{0.9, -0.1}, more{0.2, -0.7};
  for (const Foundation &f : laws)
    EXPECT_NEAR(linear_excess(x, 0.3, next, f), linear_excess(x, 0.3, target, f) + excess_of(more, x, f), 1e-14);
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
} // namespace interior_path_test
