// SPDX-License-Identifier: BSD-3-Clause
#include "rpc/contact/nearest_point.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace nearest_point_test
{
namespace
{

using namespace rpc;
using Numbers = std::vector<double>;

constexpr double inf = std::numeric_limits<double>::infinity();

double dot(const Numbers &a, const Numbers &b)
{
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// All sums of lambda_i a_i with 0 <= lambda_i <= limit_i.
struct Zonotope {
  std::vector<Numbers> a;
  Numbers limit;

  contact::Furthest operator()(const Numbers &q) const
  {
    contact::Furthest furthest{Numbers(q.size(), 0.)};
    double most = 1e-13 * std::sqrt(dot(q, q));
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double size = std::sqrt(dot(a[i], a[i]));
      if (limit[i] < inf || !(dot(a[i], q) > most * size)) continue;
      most = dot(a[i], q) / size;
      furthest.endless = true;
      for (std::size_t k = 0; k < q.size(); ++k) furthest.at[k] = a[i][k] / size;
    }
    for (std::size_t i = 0; i < a.size() && !furthest.endless; ++i)
      for (std::size_t k = 0; k < q.size() && limit[i] < inf && dot(a[i], q) > 0; ++k)
        furthest.at[k] += limit[i] * a[i][k];
    return furthest;
  }
  /// By descent in one lambda after the other.
  Numbers away_by_descent(const Numbers &b) const
  {
    Numbers lambda(a.size(), 0.), away = b;
    for (int sweep = 0; sweep < 20000; ++sweep)
      for (std::size_t i = 0; i < a.size(); ++i) {
        const double next = std::min(limit[i], std::max(0., lambda[i] + dot(a[i], away) / dot(a[i], a[i])));
        for (std::size_t k = 0; k < b.size(); ++k) away[k] -= (next - lambda[i]) * a[i][k];
        lambda[i] = next;
      }
    return away;
  }
};

void expect_away(const Zonotope &set, const Numbers &b, const Numbers &expected, const double tolerance = 1e-12)
{
  const auto nearest = contact::nearest_point(set, b, 1e-12);
  EXPECT_NEAR(nearest.distance, std::sqrt(dot(expected, expected)), tolerance) << testing::PrintToString(b);
  for (std::size_t k = 0; k < b.size(); ++k)
    EXPECT_NEAR(nearest.away[k], expected[k], tolerance) << testing::PrintToString(b);
}

TEST(NearestPoint, OfAnInterval)
{
  const Zonotope interval{{{2}, {-1}}, {1.5, 0.5}}; // [-0.5, 3]
  expect_away(interval, {4}, {1});
  expect_away(interval, {3}, {0});
  expect_away(interval, {0}, {0});
  expect_away(interval, {-0.75}, {-0.25});
  const Zonotope ray{{{2}, {-1}}, {inf, 0.5}}; // [-0.5, inf)
  expect_away(ray, {1e6}, {0});
  expect_away(ray, {-2}, {-1.5});
}

TEST(NearestPoint, OfTheOriginAlone)
{
  expect_away(Zonotope{}, {3, 4}, {3, 4});
  expect_away(Zonotope{}, {0, 0}, {0, 0});
}

TEST(NearestPoint, OfAnOctagon)
{
  const Zonotope octagon{{{1, 0}, {1, 1}, {0, 1}, {-1, 1}}, {1, 1, 1, 1}};
  // Its corners: (0,0) (1,0) (2,1) (2,2) (1,3) (0,3) (-1,2) (-1,1).
  expect_away(octagon, {0.5, 1.5}, {0, 0});
  expect_away(octagon, {3, 1.5}, {1, 0});
  expect_away(octagon, {2, 0}, {0.5, -0.5});
  expect_away(octagon, {3, 4}, {1.5, 1.5});
  expect_away(octagon, {2.5, 3.5}, {1, 1});
  expect_away(octagon, {-1, -2}, {-1, -2});
  expect_away(octagon, {-1, 1}, {0, 0});
}

TEST(NearestPoint, OfAConeWithABox)
{
  const Zonotope set{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {2, inf, 1}};
  expect_away(set, {1, 100, 0.5}, {0, 0, 0});
  expect_away(set, {3, 100, -1}, {1, 0, -1});
  expect_away(set, {-3, -4, 5}, {-3, -4, 4});
  const Zonotope wedge{{{1, 1}, {1, -1}}, {inf, inf}};
  expect_away(wedge, {1e-3, 0}, {0, 0});
  expect_away(wedge, {0, 2}, {-1, 1});
  expect_away(wedge, {-1, 0.5}, {-1, 0.5});
}

TEST(NearestPoint, SeesASmallLoadInAHugeSet)
{
  const Zonotope strong{{{1, 0}, {0, 1}, {-1, 2}}, {1e12, 1e12, 3}};
  expect_away(strong, {1, 1}, {0, 0});
  expect_away(strong, {1, -1e-6}, {0, -1e-6});
  const Zonotope beside_a_wall{{{1, 0}, {0, 1}}, {1e14, 10}}; // the floor is weak
  expect_away(beside_a_wall, {3, 9.9}, {0, 0});
  expect_away(beside_a_wall, {3, 10.5}, {0, 0.5}, 1e-10);
}

TEST(NearestPoint, OfRandomSetsIsThatOfPlainDescent)
{
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int k = 1; k <= 6; ++k) {
    for (int scene = 0; scene < 40; ++scene) {
      Zonotope set;
      const int n = 1 + scene % 12;
      for (int i = 0; i < n; ++i) {
        Numbers a(k);
        for (double &entry : a) entry = normal(random);
        a[0] = std::abs(a[0]) + 0.3; // one half space: nothing cancels, and descent converges
        set.a.push_back(a);
        set.limit.push_back(i % 4 == 3 ? inf : std::abs(normal(random)));
      }
      Numbers b(k);
      for (double &entry : b) entry = 2 * normal(random);
      const auto nearest = contact::nearest_point(set, b, 1e-9);
      const Numbers away = set.away_by_descent(b);
      EXPECT_NEAR(nearest.distance, std::sqrt(dot(away, away)), 1e-6) << k << " " << scene;
      EXPECT_LT(nearest.steps, 100);
      if (nearest.distance == 0) continue;
      const auto furthest = set(nearest.away); // the plane through the nearest point separates
      EXPECT_FALSE(furthest.endless);
      EXPECT_LE(dot(nearest.away, furthest.at), dot(nearest.away, b) - nearest.distance * nearest.distance + 1e-9);
    }
  }
}

TEST(NearestPoint, OfManyGeneratorsTakesFewSteps)
{
  Zonotope disc; // radius 2, nearly
  const int n = 4000;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * M_PI * i / n;
    disc.a.push_back({std::cos(angle), std::sin(angle)});
    disc.limit.push_back(2 * M_PI / n);
  }
  for (const double r : {1.99, 2.01, 5.}) {
    const auto nearest = contact::nearest_point(disc, {r * std::cos(0.3), r * std::sin(0.3)}, 1e-9);
    EXPECT_NEAR(nearest.distance, r > 2 ? r - 2 : 0, 1e-5);
    EXPECT_LT(nearest.steps, 60);
  }
}

} // namespace
} // namespace nearest_point_test
